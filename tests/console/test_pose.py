"""The pose's sliders: letting go moves there, and a stop in between moves nothing."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from playwright.sync_api import Locator, Page, expect

pytestmark = pytest.mark.browser

SENT_BY = 400  # ms after a choice its move has been sent, if there is one
Z = 5


@pytest.fixture
def page(open_page: Callable[..., Page]) -> Page:
    page = open_page(390, 844)
    page.locator(".tabs [data-view=pose]").click()
    return page


@pytest.fixture
def slider(page: Page) -> Locator:
    return page.locator("#sliders input").nth(Z)


def take_hold(slider: Locator, share: float) -> None:
    """Press it and move on, without letting go."""
    box = slider.bounding_box()
    assert box is not None
    mouse, y = slider.page.mouse, box["y"] + box["height"] / 2
    mouse.move(box["x"] + 0.5 * box["width"], y)
    mouse.down()
    mouse.move(box["x"] + share * box["width"], y, steps=3)


def moves_after(page: Page, machine: Any) -> list[Any]:
    page.wait_for_timeout(SENT_BY)
    return machine.posted("move")


def test_letting_go_moves_there_once(
    page: Page, slider: Locator, machine: Any, wait_until: Callable[..., Any]
) -> None:
    take_hold(slider, 0.6)
    assert machine.posted("move") == []
    page.mouse.up()
    wait_until(lambda: machine.posted("move"))
    (move,) = moves_after(page, machine)
    assert move["xyz_mm"][:2] == [12.4, -3.15]
    assert move["xyz_mm"][2] == pytest.approx(-440 + 0.6 * 215, abs=5)


def test_a_stop_takes_back_what_keys_chose(page: Page, slider: Locator, machine: Any) -> None:
    slider.focus()
    page.keyboard.press("ArrowRight")
    page.keyboard.press("Escape")
    assert moves_after(page, machine) == []


@pytest.mark.parametrize("who", ["here", "elsewhere", "silence"])
def test_what_was_held_at_a_stop_moves_nothing_until_it_is_pressed_anew(
    page: Page, slider: Locator, machine: Any, wait_until: Callable[..., Any], who: str
) -> None:
    take_hold(slider, 0.6)
    if who == "here":
        page.keyboard.press("Escape")
        wait_until(lambda: machine.posted("stop"))
    elif who == "elsewhere":
        machine.set(stop_reason="Stop was pressed")
        page.get_by_text("Stopped: Stop was pressed").wait_for()
    else:
        machine.silent = True
        page.get_by_text("No news from the robot").wait_for()
    page.mouse.up()
    machine.silent = False
    expect(slider).to_be_enabled()
    assert moves_after(page, machine) == []
    take_hold(slider, 0.7)
    page.mouse.up()
    wait_until(lambda: machine.posted("move"))
