"""The view: the equals of what the scene's own panel holds, on every screen."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from playwright.sync_api import Locator, Page, expect

pytestmark = pytest.mark.browser

REACH, COLOURS, POINT = "Workspace: Reach", "Workspace: Colours", "Workspace: Point"
FOREARM, SAVE, TOLD = "Geometry: Forearm", "Geometry: Save as robot file", "Workspace: Reach told"
SIZES = [(1280, 800), (390, 844)]


def opened(page: Page) -> Locator:
    narrow = page.viewport_size is not None and page.viewport_size["width"] < 720
    page.locator(".tabs [data-view=view]" if narrow else "#view-toggle").click()
    return page.get_by_role("region", name="View")


def chosen(machine: Any) -> list[tuple[str, Any]]:
    return [(m["item"], m["value"]) for m in machine.messages("show")]


@pytest.fixture(params=SIZES, ids=str)
def view(open_page: Callable[..., Page], request: pytest.FixtureRequest) -> Locator:
    return opened(open_page(*request.param))


@pytest.fixture
def wide(open_page: Callable[..., Page]) -> Locator:
    return opened(open_page())


def test_each_input_tells_what_was_chosen(
    view: Locator, machine: Any, wait_until: Callable[..., Any]
) -> None:
    machine.show(SAVE, disabled=False)
    view.get_by_label("Reach").check()
    view.get_by_label("Colours").select_option("Resolution")
    view.get_by_label("Point").fill("0 0 -300")
    view.get_by_label("Point").press("Enter")
    view.get_by_label("Forearm").fill("350")
    view.get_by_role("button", name="Save as robot file").click()
    everything = [
        (REACH, True),
        (COLOURS, "Resolution"),
        (POINT, "0 0 -300"),
        (FOREARM, 350),
        (SAVE, True),
    ]
    wait_until(lambda: sorted(chosen(machine), key=str) == sorted(everything, key=str))
    assert machine.posted("move") == []
    assert machine.messages("jog_start") == []


def test_what_the_scene_tells_is_shown(view: Locator, machine: Any) -> None:
    told = view.locator(".told")
    expect(told).to_contain_text("Reach: 31.0 l, drawn within 0.5 mm.")
    expect(told).to_contain_text("Resolution, mm per microstep")
    gradient = told.locator(".colours").evaluate("e => getComputedStyle(e).backgroundImage")
    assert "rgb(68, 40, 120)" in gradient
    expect(view.get_by_role("button", name="Save as robot file")).to_be_disabled()
    machine.show(REACH, value=True)
    expect(view.get_by_label("Reach")).to_be_checked()
    machine.show(COLOURS, value="Conditioning")
    expect(view.get_by_label("Colours")).to_have_value("Conditioning")
    machine.show(TOLD, rows=[{"kind": "row", "text": "<b>bold</b>", "value": "", "dot": None}])
    expect(told).to_have_text("<b>bold</b>")  # text, never markup
    machine.show(FOREARM, value=400.0, high=800.0)
    expect(view.get_by_label("Forearm")).to_have_value("400")


def test_a_slider_in_a_hand_is_not_written_and_its_last_value_goes_out(
    wide: Locator, machine: Any, wait_until: Callable[..., Any]
) -> None:
    slider = wide.get_by_label("Forearm")
    slider.evaluate(
        """e => { for (const value of [340, 350, 360, 370, 380]) {
             e.value = value; e.dispatchEvent(new Event("input")); } }"""
    )
    machine.show(FOREARM, value=338.0)  # told before the choice was heard
    wait_until(lambda: (FOREARM, 380) in chosen(machine))
    assert len(chosen(machine)) < 5  # of a quick hand not every value is sent
    assert slider.input_value() == "380"
    machine.show(FOREARM, value=390.0)
    wide.page.wait_for_timeout(700)  # the hand is gone
    machine.show(FOREARM, value=391.0)
    expect(slider).to_have_value("391")


def test_what_was_told_during_a_choice_is_shown_after_it(wide: Locator, machine: Any) -> None:
    slider = wide.get_by_label("Forearm")
    slider.fill("350")
    machine.show(FOREARM, value=338.0)  # reset elsewhere; it is told this once
    assert slider.input_value() == "350"
    expect(slider).to_have_value("338")


def test_a_line_in_hand_is_not_written(wide: Locator, machine: Any) -> None:
    wide.get_by_label("Point").fill("12")
    machine.show(POINT, value="0 0 -300")
    expect(wide.get_by_label("Point")).to_have_value("12")
    wide.get_by_label("Reach").focus()
    machine.show(POINT, value="0 0 -310")
    expect(wide.get_by_label("Point")).to_have_value("0 0 -310")


def test_inputs_come_and_go_and_the_focus_stays(wide: Locator, machine: Any) -> None:
    wide.get_by_label("Colours").focus()
    (point,) = (item for item in machine.view if item["key"] == POINT)
    machine.view.remove(point)
    machine.show(REACH, value=True)
    expect(wide.get_by_label("Point")).to_have_count(0)
    expect(wide.get_by_label("Colours")).to_be_focused()


def test_without_a_scene_it_says_so(wide: Locator, machine: Any) -> None:
    machine.view = None
    machine.say({"type": "view", "items": None})
    expect(wide).to_contain_text("The scene is not open yet.")
    expect(wide.get_by_role("checkbox")).to_have_count(0)


def test_a_refusal_is_told(wide: Locator, machine: Any) -> None:
    machine.say({"type": "refused", "to": "show", "id": None, "detail": "The scene is gone."})
    expect(wide.page.locator("#message-text")).to_have_text("The scene is gone.")


def test_keys_choose_and_never_jog(wide: Locator, machine: Any) -> None:
    wide.get_by_label("Trail").focus()
    wide.page.keyboard.press("Space")
    expect(wide.get_by_label("Trail")).not_to_be_checked()
    wide.get_by_label("Forearm").focus()
    wide.page.keyboard.press("ArrowRight")
    wide.page.keyboard.press("w")
    expect(wide.get_by_label("Forearm")).to_have_value("339")
    assert machine.messages("jog_start") == []
