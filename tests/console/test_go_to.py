"""Typed targets."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from playwright.sync_api import Page

pytestmark = pytest.mark.browser


@pytest.fixture
def page(open_page: Callable[..., Page]) -> Page:
    return open_page()


def type_in(page: Page, x: str, y: str, z: str) -> None:
    for axis, text in zip("xyz", (x, y, z), strict=True):
        page.locator(f"#move-{axis}").fill(text)


@pytest.mark.parametrize(
    ("typed", "sent"),
    [
        (("10", "-20", "-300"), [10, -20, -300]),
        (("1,5", "−20,25", " -300.0 "), [1.5, -20.25, -300]),
        (("+.5", "0", "-300."), [0.5, 0, -300]),
    ],
)
def test_numbers_as_people_type_them(
    page: Page,
    machine: Any,
    wait_until: Callable[..., Any],
    typed: tuple[str, str, str],
    sent: list[float],
) -> None:
    type_in(page, *typed)
    page.locator("#move-z").press("Enter")
    wait_until(lambda: machine.posted("move"))
    assert machine.posted("move") == [{"xyz_mm": sent, "speed": 1}]


@pytest.mark.parametrize("bad", ["", "abc", "1.2.3", "1.234,5", "1e3", "NaN", "Infinity", "--3"])
def test_what_is_no_number_moves_nothing(page: Page, machine: Any, bad: str) -> None:
    type_in(page, "1", bad, "-300")
    page.get_by_role("button", name="Go").click()
    problem = page.get_by_role("alert")
    assert problem.inner_text().startswith("Y")
    assert page.locator("#move-y").evaluate("e => e === document.activeElement")
    assert page.locator("#move-y").get_attribute("aria-invalid") == "true"
    page.wait_for_timeout(100)
    assert machine.posted("move") == []
    page.locator("#move-y").fill("2")
    assert problem.inner_text() == ""


def test_typing_alone_moves_nothing(page: Page, machine: Any) -> None:
    type_in(page, "1", "2", "-300")
    page.locator("#move-x").blur()
    page.wait_for_timeout(100)
    assert machine.posted("move") == []


def test_a_target_out_of_reach_is_told(page: Page, machine: Any) -> None:
    machine.refusals["move"] = (422, "Out of reach: arm 1 by 12.3 mm.")
    type_in(page, "900", "0", "-300")
    page.get_by_role("button", name="Go").click()
    page.get_by_text("Out of reach: arm 1 by 12.3 mm.").wait_for()


def test_the_present_pose_fills_the_fields_once(page: Page, machine: Any) -> None:
    page.get_by_role("button", name="Use present pose").click()
    values = [page.locator(f"#move-{axis}").input_value() for axis in "xyz"]
    assert values == ["12.40", "−3.15", "−301.02"]
    machine.set(xyz_mm=[50.0, 50.0, -250.0])
    page.locator("#readouts").get_by_text("50.00").first.wait_for()
    assert page.locator("#move-x").input_value() == "12.40"


def test_before_homing_the_page_says_what_is_missing(
    page: Page, machine: Any, wait_until: Callable[..., Any]
) -> None:
    machine.set(mode="unhomed", homed=False)
    page.get_by_text("Not homed").wait_for()
    type_in(page, "1", "2", "-300")
    page.get_by_role("button", name="Go").click()
    wait_until(lambda: "Home the robot first" in page.get_by_role("status").inner_text())
    assert machine.posted("move") == []


def test_pose_sliders_move_when_let_go(
    open_page: Callable[..., Page], machine: Any, wait_until: Callable[..., Any]
) -> None:
    page = open_page(390, 844, has_touch=True, is_mobile=True)
    page.get_by_role("button", name="Pose").click()
    page.get_by_label("θ2 °").fill("30")
    (move,) = wait_until(lambda: machine.posted("move"))
    assert move == {"theta_deg": [21.44, 30, 24.9], "speed": 1}
    page.get_by_role("slider", name="Z mm").fill("-250")
    wait_until(lambda: len(machine.posted("move")) == 2)
    assert machine.posted("move")[1] == {"xyz_mm": [12.4, -3.15, -250], "speed": 1}


def test_a_held_slider_is_not_written(
    open_page: Callable[..., Page], machine: Any, wait_until: Callable[..., Any]
) -> None:
    page = open_page(390, 844)
    page.get_by_role("button", name="Pose").click()
    slider = page.get_by_role("slider", name="X mm")
    box = slider.bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + box["width"] * 0.75, box["y"] + box["height"] / 2)
    page.mouse.down()
    held = slider.input_value()
    machine.set(command_xyz_mm=[-100.0, 0.0, -300.0], xyz_mm=[-100.0, 0.0, -300.0])
    page.locator("#strip").get_by_text("−100.00").wait_for()
    assert slider.input_value() == held
    assert machine.posted("move") == []
    page.mouse.up()
    wait_until(lambda: machine.posted("move"))
