"""Stop arrives: fifty times of fifty, at full speed, past a held jog and a flooded server."""

from __future__ import annotations

import statistics
from collections.abc import Callable
from typing import Any

import pytest
from playwright.sync_api import Page

pytestmark = [pytest.mark.browser, pytest.mark.timeout(900)]

LONG = 120_000
STOPS = 50
SPEED = 400.0  # mm/s; more the ways here leave no room to reach
RESTS = 0.3  # s of board time that must pass without motion after a stop


@pytest.fixture
def stopper(page: Page, served: Any) -> Page:
    page.set_viewport_size({"width": 760, "height": 440})
    page.goto(served.url)
    page.locator("#mode", has_text="Idle").wait_for(timeout=LONG)
    return page


@pytest.mark.usefixtures("flood")
def test_fifty_stops_of_fifty_arrive(
    stopper: Page,
    served: Any,
    watch: Callable[[], Any],
    page_socket: Callable[[], Any],
    record_property: Callable[[str, object], None],
) -> None:
    """One client jogs, one floods; a third, a real page, presses Stop."""
    jogger = page_socket()
    watcher = watch()
    times: list[float] = []
    for _ in range(4 * STOPS):
        # Under the flood a jog may lose its lease by itself; then there was nothing to stop.
        took = one_stop(len(times), jogger, stopper, served, watcher)
        times += [] if took is None else [took]
        if len(times) == STOPS:
            break
    assert len(times) == STOPS
    for name, value in (
        ("stop to first slowing, p50 ms", 1e3 * statistics.median(times)),
        ("stop to first slowing, worst ms", 1e3 * max(times)),
    ):
        record_property(name, value)
        print(f"{name}: {value:.0f}")


def one_stop(number: int, jogger: Any, stopper: Page, served: Any, watcher: Any) -> float | None:
    """Jog towards the middle, stop from the page; wall time to the first slowing, in s.

    None if the robot stopped by itself before Stop arrived.
    """
    focus_on(stopper, in_scene=number % 2 == 1)
    before = served.state()
    side = -1.0 if before["xyz_mm"][0] > 0 else 1.0
    watcher.forget_until(before["board_time_s"])
    jogger.press([side * SPEED, 0.0, 0.0])
    if not watcher.until_cruising(SPEED):
        jogger.let_go()
        return None
    pressed = watcher.now()
    if number % 2:
        stopper.keyboard.press("Escape")
    else:
        stopper.locator("#stop").click()
    slowed = watcher.until_slower_than(0.9 * SPEED)
    rest = served.wait(lambda s: s["mode"] == "idle" and s["stop_reason"], "rest after the stop")
    by_itself = rest["stop_reason"].startswith("The jog broke off")
    assert by_itself or rest["stop_reason"].startswith("Stop was pressed")
    # The jog is still held and the flood goes on, and yet nothing moves again by itself.
    later = served.wait(
        lambda s: s["board_time_s"] > rest["board_time_s"] + RESTS, "time passing at rest"
    )
    assert (later["mode"], later["xyz_mm"]) == ("idle", rest["xyz_mm"]), (rest, later)
    jogger.let_go()
    return None if by_itself else slowed - pressed


def focus_on(page: Page, *, in_scene: bool) -> None:
    """Put the focus into the scene's frame, or into the console."""
    page.locator("#scene" if in_scene else "#stop").focus()
    inside = page.evaluate("() => document.activeElement.id === 'scene'")
    assert inside is in_scene
