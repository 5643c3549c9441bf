"""The scene's frame: the console hears its keys, and holds its drags alive."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from playwright.sync_api import Page

pytestmark = pytest.mark.browser

HEARD = "document.querySelector('#scene').contentWindow.heard"


@pytest.fixture
def page(open_page: Callable[..., Page]) -> Page:
    page = open_page()
    page.mouse.click(500, 500)  # into the scene
    assert page.evaluate("document.activeElement.id") == "scene"
    return page


def test_keys_in_the_frame_jog_and_are_kept_from_viser(
    page: Page, machine: Any, wait_until: Callable[..., Any]
) -> None:
    page.keyboard.down("KeyW")
    wait_until(lambda: len(machine.messages("jog")) >= 2)
    page.keyboard.up("KeyW")
    wait_until(lambda: machine.messages("jog_end"))
    assert "keydown KeyW" not in page.evaluate(HEARD)
    page.keyboard.press("KeyF")
    assert "keydown KeyF" in page.evaluate(HEARD)  # none of ours


def test_a_click_into_the_frame_does_not_end_a_jog(
    open_page: Callable[..., Page], machine: Any, wait_until: Callable[..., Any]
) -> None:
    page = open_page()
    page.keyboard.down("KeyD")
    wait_until(lambda: machine.messages("jog"))
    page.mouse.click(500, 500)
    machine.forget()
    wait_until(lambda: len(machine.messages("jog")) >= 3)
    assert machine.messages("jog_end") == []
    page.keyboard.up("KeyD")  # heard in the frame now
    wait_until(lambda: machine.messages("jog_end"))


@pytest.mark.parametrize("element", ["#box", "#slider"])
def test_fields_and_sliders_in_the_frame_keep_their_keys(
    page: Page, machine: Any, element: str
) -> None:
    page.frame_locator("#scene").locator(element).focus()
    page.keyboard.press("KeyD")
    page.keyboard.press("ArrowRight")
    page.wait_for_timeout(200)
    assert machine.messages("jog_start") == []
    assert "keydown KeyD" in page.evaluate(HEARD)


def test_listeners_are_attached_again_after_a_reload(
    page: Page, machine: Any, wait_until: Callable[..., Any]
) -> None:
    for _ in range(2):
        page.evaluate(
            """new Promise((done) => {
              const frame = document.querySelector("#scene");
              frame.addEventListener("load", done, {once: true});
              frame.contentWindow.location.reload();
            })"""
        )
    page.mouse.click(500, 500)
    machine.forget()
    page.keyboard.down("KeyD")
    wait_until(lambda: len(machine.messages("jog")) >= 2)
    page.keyboard.up("KeyD")
    page.keyboard.press("Escape")
    wait_until(lambda: machine.posted("stop"))
    page.wait_for_timeout(200)
    assert len(machine.messages("stop")) == 1  # by one listener, not three
    assert len(machine.messages("jog_start")) == 1


def test_a_drag_is_alive_while_the_pointer_is_down(
    page: Page, machine: Any, wait_until: Callable[..., Any]
) -> None:
    machine.forget()
    page.mouse.move(400, 400)
    page.mouse.down()
    wait_until(lambda: len(machine.messages("drag_alive")) >= 5)
    page.mouse.up()
    page.wait_for_timeout(1100)  # the scene's own news of the release may be that late
    count = len(machine.messages("drag_alive"))
    page.wait_for_timeout(300)
    beats = machine.messages("drag_alive")
    assert len(beats) == count
    assert all(set(beat) == {"type", "seq", "t_ms"} for beat in beats)
    assert [b["seq"] for b in beats] == sorted({b["seq"] for b in beats})


def test_after_the_release_a_drag_lives_until_the_scene_has_told(
    page: Page, machine: Any, wait_until: Callable[..., Any]
) -> None:
    page.mouse.move(400, 400)
    page.mouse.down()
    wait_until(lambda: machine.messages("drag_alive"))
    page.mouse.up()
    count = len(machine.messages("drag_alive"))
    wait_until(lambda: len(machine.messages("drag_alive")) >= count + 5)


def test_a_pointer_that_is_taken_away_is_no_release(
    page: Page, machine: Any, wait_until: Callable[..., Any]
) -> None:
    page.mouse.move(400, 400)
    page.mouse.down()
    wait_until(lambda: machine.messages("drag_alive"))
    page.evaluate(
        "document.querySelector('#scene').contentWindow.dispatchEvent("
        "new PointerEvent('pointercancel', {pointerId: 1}))"
    )
    page.wait_for_timeout(100)
    count = len(machine.messages("drag_alive"))
    page.wait_for_timeout(300)
    assert len(machine.messages("drag_alive")) == count


@pytest.mark.parametrize(
    "loss",
    [
        "document.hasFocus = () => false",
        "document.querySelector('#scene').contentWindow.location.reload()",
        "document.querySelector('#stop').click()",
    ],
)
def test_a_broken_drag_stays_dead_while_the_pointer_is_down(
    page: Page, machine: Any, wait_until: Callable[..., Any], loss: str
) -> None:
    page.mouse.move(400, 400)
    page.mouse.down()
    wait_until(lambda: len(machine.messages("drag_alive")) >= 2)
    page.evaluate(f"() => {{ {loss} }}")
    page.wait_for_timeout(200)
    count = len(machine.messages("drag_alive"))
    page.evaluate("delete document.hasFocus")
    page.mouse.move(410, 410)
    page.wait_for_timeout(300)
    assert len(machine.messages("drag_alive")) == count
