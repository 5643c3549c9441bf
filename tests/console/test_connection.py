"""A lost server: the page says so, its numbers are old, and nothing is ever resumed."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from playwright.sync_api import Page, expect

pytestmark = pytest.mark.browser


@pytest.fixture
def page(open_page: Callable[..., Page]) -> Page:
    return open_page()


def test_a_lost_server_is_told_and_the_numbers_are_greyed(page: Page, machine: Any) -> None:
    machine.accepts = False
    machine.cut()
    page.get_by_text("Server lost").wait_for()
    expect(page.get_by_role("status")).to_contain_text("the numbers are old")
    opacity = page.locator("#readouts td").first.evaluate("e => getComputedStyle(e).opacity")
    assert float(opacity) < 1
    for name in ("Disable", "Home"):
        assert page.get_by_role("button", name=name, exact=True).is_disabled()


def test_a_silent_server_is_told(page: Page, machine: Any) -> None:
    machine.silent = True
    expect(page.get_by_role("status")).to_contain_text("No news from the robot")
    assert page.locator("html").get_attribute("data-stale") is not None
    assert page.locator("#mode").inner_text() == "No news"  # and not what was true once


def test_a_reconnect_resumes_nothing(
    page: Page, machine: Any, wait_until: Callable[..., Any]
) -> None:
    machine.set(mode="jogging")
    page.keyboard.down("KeyD")
    wait_until(lambda: len(machine.messages("jog")) >= 2)
    machine.cut()
    machine.forget()
    expect(page.get_by_role("status")).to_contain_text("Nothing was resumed")
    expect(page.locator("html")).not_to_have_attribute("data-stale", "")
    page.keyboard.down("KeyD")  # still held: a repeat
    page.wait_for_timeout(300)
    assert machine.messages("jog_start", "jog") == []
    page.keyboard.up("KeyD")
    page.keyboard.down("KeyD")
    wait_until(lambda: machine.messages("jog_start"))


def test_it_keeps_trying(page: Page, machine: Any) -> None:
    machine.accepts = False
    machine.cut()
    page.wait_for_timeout(1500)
    machine.accepts = True
    expect(page.get_by_role("status")).to_contain_text("is back", timeout=10_000)
    assert page.locator("#mode").inner_text() == "Idle · homed"


def test_the_theme_is_told_to_the_scene_and_remembered(
    page: Page, machine: Any, wait_until: Callable[..., Any]
) -> None:
    wait_until(lambda: machine.messages("theme"))
    assert machine.messages("theme") == [{"type": "theme", "dark": False}]
    button = page.locator("#theme")
    button.click()  # light
    button.click()  # dark
    wait_until(lambda: machine.messages("theme")[-1]["dark"])
    assert page.evaluate("getComputedStyle(document.body).backgroundColor") == "rgb(36, 36, 36)"
    page.reload()
    assert page.locator("html").get_attribute("data-theme") == "dark"


def test_control_is_asked_for_and_given_up(
    page: Page, machine: Any, wait_until: Callable[..., Any]
) -> None:
    page.get_by_role("button", name="You control").click()
    wait_until(lambda: machine.posted("control") == [{"action": "release"}])
    machine.set(control={"holder": None, "you": False})
    page.get_by_role("button", name="Control free").click()
    wait_until(lambda: machine.posted("control")[1:] == [{"action": "request"}])
    machine.set(control={"holder": "another", "you": False})
    expect(page.get_by_role("status")).to_contain_text("may stop at any time")


@pytest.mark.parametrize(
    ("mode", "button", "posted"),
    [
        ("disabled", "Enable", "enable"),
        ("unhomed", "Disable", "disable"),
        ("unhomed", "Home", "home"),
        ("estop", "Reset", "reset"),
        ("fault", "Reset", "reset"),
    ],
)
def test_power(
    page: Page, machine: Any, wait_until: Callable[..., Any], mode: str, button: str, posted: str
) -> None:
    machine.set(mode=mode, homed=False)
    page.get_by_role("button", name=button, exact=True).click()
    wait_until(lambda: [path for path, _ in machine.posts] == [posted])


def test_the_next_step_is_a_button_on_the_pendant(
    open_page: Callable[..., Page], machine: Any, wait_until: Callable[..., Any]
) -> None:
    machine.set(mode="disabled", homed=False)
    page = open_page(390, 844)
    page.locator("#message-step").click()
    wait_until(lambda: [path for path, _ in machine.posts] == ["enable"])


def test_a_robot_chosen_by_the_keyboard_is_shown(
    page: Page, machine: Any, wait_until: Callable[..., Any]
) -> None:
    select = page.locator("header select")
    select.focus()
    page.keyboard.press("ArrowDown")  # it stays in focus
    wait_until(lambda: machine.posted("robot") == [{"robot": "trossen"}])
    machine.robot["name"] = "trossen"
    machine.set(robot="trossen")
    expect(select).to_have_value("trossen")


@pytest.mark.parametrize("mode", ["idle", "jogging", "moving"])
def test_it_is_told_that_the_speed_is_what_keeps_the_robot(
    page: Page, machine: Any, mode: str
) -> None:
    machine.set(mode=mode, override=0.0)
    expect(page.get_by_role("status")).to_contain_text("The speed is 0 %: raise it to move.")


def test_robot_and_link_are_chosen(
    page: Page, machine: Any, wait_until: Callable[..., Any]
) -> None:
    page.locator("header select").select_option("trossen")
    wait_until(lambda: machine.posted("robot") == [{"robot": "trossen"}])
    assert page.locator("header select").input_value() == "stm32"  # until the machine says so
    machine.robot["name"] = "trossen"
    machine.set(robot="trossen")
    expect(page.locator("header select")).to_have_value("trossen")
    page.get_by_role("button", name="Set-up").click()
    page.get_by_role("button", name="Disconnect").click()
    wait_until(lambda: [path for path, _ in machine.posts] == ["robot", "disconnect"])
    machine.set_link(phase="closed")
    page.get_by_role("button", name="Connect", exact=True).click()
    wait_until(lambda: machine.posted("connect") == [{"link": "sim"}])


def test_what_holds_the_robot_back_is_told_with_the_way_out(page: Page, machine: Any) -> None:
    limit = "Arm 2 at its upper limit (90.0°)"
    machine.set(held_by=[{"limit": limit, "arm": 1, "way_out": ["-X", "-Z"]}])
    expect(page.get_by_role("status")).to_have_text(f"{limit}. −X and −Z lead out.")


def test_unknown_numbers_are_dashes(page: Page, machine: Any) -> None:
    machine.set(xyz_mm=None, command_xyz_mm=None, xyz_speed_share=None, mode="unhomed", homed=False)
    row = page.locator("#readouts tr").first
    expect(row).to_have_text("X mm–––")
