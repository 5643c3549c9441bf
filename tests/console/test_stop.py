"""Stop and E-stop work at once, from everywhere, whatever else is held or said."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from playwright.sync_api import Page, expect

pytestmark = pytest.mark.browser


@pytest.fixture
def page(open_page: Callable[..., Page]) -> Page:
    return open_page()


def stopped(machine: Any, kind: str = "stop") -> bool:
    return bool(machine.messages(kind)) and bool(machine.posted(kind))


@pytest.mark.parametrize("kind", ["stop", "estop"])
def test_a_stop_goes_by_socket_and_by_http_on_the_press_itself(
    page: Page, machine: Any, wait_until: Callable[..., Any], kind: str
) -> None:
    page.locator(f"#{kind}").hover()
    page.mouse.down()  # and no release
    wait_until(lambda: stopped(machine, kind))


@pytest.mark.parametrize("kind", ["stop", "estop"])
def test_a_click_is_one_stop(page: Page, machine: Any, kind: str) -> None:
    page.locator(f"#{kind}").click()
    page.wait_for_timeout(200)
    assert len(machine.messages(kind)) == len(machine.posted(kind)) == 1


def test_stop_by_the_keyboard(page: Page, machine: Any, wait_until: Callable[..., Any]) -> None:
    page.locator("#stop").focus()
    page.keyboard.press("Enter")
    wait_until(lambda: stopped(machine))


def test_a_press_let_go_beside_the_button_swallows_no_later_stop(
    page: Page, machine: Any, wait_until: Callable[..., Any]
) -> None:
    page.locator("#stop").hover()
    page.mouse.down()
    page.mouse.move(1100, 500)
    page.mouse.up()
    wait_until(lambda: stopped(machine))
    machine.forget()
    page.locator("#stop").focus()
    page.keyboard.press("Enter")
    wait_until(lambda: stopped(machine))


def test_a_stop_that_nobody_answers_is_told_though_the_socket_looks_open(
    page: Page, machine: Any
) -> None:
    machine.silent = True
    page.get_by_text("No news from the robot").wait_for()
    page.route("**/api/stop", lambda route: route.abort())
    page.keyboard.press("Escape")
    expect(page.get_by_role("status")).to_contain_text("Use the hardware emergency stop.")


@pytest.mark.parametrize(
    "place",
    [
        "document.body",
        "document.querySelector('#move-y')",
        "document.querySelector('#override')",
        "document.querySelector('header select')",
        "document.querySelector('#scene').contentDocument.querySelector('#canvas')",
        "document.querySelector('#scene').contentDocument.querySelector('#box')",
    ],
)
def test_escape_is_stop_everywhere(
    page: Page, machine: Any, wait_until: Callable[..., Any], place: str
) -> None:
    page.evaluate(f"{place}.focus()")
    page.keyboard.press("Escape")
    wait_until(lambda: stopped(machine))


def test_escape_with_a_modifier_stops_too(
    page: Page, machine: Any, wait_until: Callable[..., Any]
) -> None:
    page.keyboard.press("Shift+Escape")
    wait_until(lambda: stopped(machine))


def test_stop_while_a_key_is_held_ends_the_jog_and_it_stays_ended(
    page: Page, machine: Any, wait_until: Callable[..., Any]
) -> None:
    page.keyboard.down("KeyD")
    wait_until(lambda: machine.messages("jog"))
    page.keyboard.press("Escape")
    wait_until(lambda: stopped(machine) and machine.messages("jog_end"))
    count = len(machine.messages("jog", "jog_start"))
    page.keyboard.down("KeyD")  # still held: a repeat
    page.wait_for_timeout(300)
    assert len(machine.messages("jog", "jog_start")) == count


def test_stop_goes_out_before_the_end_of_the_jog(
    page: Page, machine: Any, wait_until: Callable[..., Any]
) -> None:
    def stop_while_held() -> bool:
        machine.forget()
        page.keyboard.down("KeyD")
        wait_until(lambda: machine.messages("jog", "jog_end"))
        held = page.evaluate(
            """() => {
              const held = document.querySelector("#pad [data-held]") !== null;
              document.querySelector("#stop").dispatchEvent(new PointerEvent("pointerdown"));
              return held;
            }"""
        )
        page.keyboard.up("KeyD")
        return held  # not held if the page slept through its lease on a busy machine

    wait_until(stop_while_held)
    wait_until(lambda: machine.messages("jog_end"))
    assert [m["type"] for m in machine.messages("stop", "jog_end")] == ["stop", "jog_end"]


def test_every_press_is_sent(page: Page, machine: Any, wait_until: Callable[..., Any]) -> None:
    for _ in range(20):
        page.keyboard.press("Escape")
    wait_until(lambda: len(machine.messages("stop")) == len(machine.posted("stop")) == 20)


@pytest.mark.parametrize(
    "state",
    [
        {"mode": "offline"},
        {"mode": "estop"},
        {"mode": "homing"},
        {"control": {"holder": "another", "you": False}},
    ],
)  # fmt: skip
def test_both_stops_are_always_enabled(
    page: Page, machine: Any, wait_until: Callable[..., Any], state: dict[str, Any]
) -> None:
    machine.set_link(phase="closed" if state.get("mode") == "offline" else "ready")
    machine.set(**state)
    page.wait_for_timeout(100)
    for kind in ("stop", "estop"):
        page.locator(f"#{kind}").click()
        wait_until(lambda kind=kind: stopped(machine, kind))


def test_without_the_socket_a_stop_goes_by_http(
    page: Page, machine: Any, wait_until: Callable[..., Any]
) -> None:
    machine.accepts = False
    machine.cut()
    page.get_by_text("Server lost").wait_for()
    page.locator("#stop").click()
    wait_until(lambda: machine.posted("stop"))


def test_a_refused_http_stop_is_carried_by_the_socket(
    page: Page, machine: Any, wait_until: Callable[..., Any]
) -> None:
    page.route("**/api/stop", lambda route: route.abort())
    page.locator("#stop").click()
    wait_until(lambda: machine.messages("stop"))


def test_a_stop_that_reached_nobody_says_so(page: Page, machine: Any) -> None:
    page.route("**/api/stop", lambda route: route.abort())
    machine.accepts = False
    machine.cut()
    page.get_by_text("Server lost").wait_for()
    page.locator("#stop").click()
    page.get_by_text("Use the hardware emergency stop").wait_for()


def test_the_page_says_what_the_stops_are(page: Page) -> None:
    assert page.get_by_text("not a hardware emergency stop").filter(visible=True).count() == 1
    assert "arms may drop" in page.locator("#estop").inner_text()
