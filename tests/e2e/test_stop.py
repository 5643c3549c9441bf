"""Stop arrives: fifty times of fifty, at full speed, past a held jog and a flooded socket."""

from __future__ import annotations

import statistics
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from playwright.sync_api import Browser, Page

pytestmark = [pytest.mark.browser, pytest.mark.timeout(900)]

LONG = 60_000
STOPS = 50
RESTS = 0.3  # s of board time that must pass without motion after a stop

# Sends as fast as the socket takes it: well-formed heartbeats of a press that never was.
FLOOD = """() => {
    const socket = new WebSocket(`ws://${location.host}/ws`);
    let seq = 0;
    const pour = () => {
        for (let i = 0; i < 200 && socket.bufferedAmount < 1e6; i++) {
            socket.send(JSON.stringify({type: "jog", id: "flood", seq: ++seq,
                t_ms: performance.now(), v_mm_s: [300, 0, 0]}));
        }
        setTimeout(pour, 0);
    };
    socket.onopen = pour;
    window.poured = () => seq;
}"""


def small_page(browser: Browser, served: Any) -> Iterator[Page]:
    context = browser.new_context(viewport={"width": 900, "height": 700})
    page = context.new_page()
    page.goto(served.url)
    page.locator("#mode", has_text="Idle").wait_for(timeout=LONG)
    yield page
    context.close()


@pytest.fixture
def jogger(browser: Browser, served: Any) -> Iterator[Page]:
    yield from small_page(browser, served)


@pytest.fixture
def stopper(browser: Browser, served: Any) -> Iterator[Page]:
    yield from small_page(browser, served)


def test_fifty_stops_of_fifty_arrive(
    jogger: Page,
    stopper: Page,
    served: Any,
    watch: Callable[[], Any],
    hold: Callable[..., None],
    record_property: Callable[[str, object], None],
) -> None:
    jogger.evaluate(FLOOD)
    jogger.wait_for_function("() => window.poured() > 1000")
    watcher = watch()
    times = [one_stop(n, jogger, stopper, served, watcher, hold) for n in range(STOPS)]
    assert len(times) == STOPS
    for name, value in (
        ("stop to first slowing, p50 ms", 1e3 * statistics.median(times)),
        ("stop to first slowing, worst ms", 1e3 * max(times)),
        ("messages flooded", jogger.evaluate("() => window.poured()")),
    ):
        record_property(name, value)
        print(f"{name}: {value:.0f}")


def one_stop(
    number: int,
    jogger: Page,
    stopper: Page,
    served: Any,
    watcher: Any,
    hold: Callable[..., None],
) -> float:
    """Jog towards the middle, stop from the other page; wall time to the first slowing, in s."""
    key = "ArrowLeft" if served.state()["xyz_mm"][0] > 0 else "ArrowRight"
    focus_on(stopper, in_scene=number % 2 == 1)
    hold(jogger, key, lambda s: s["mode"] == "jogging")
    cruise = watcher.until_cruising()
    pressed = watcher.now()
    if number % 2:
        stopper.keyboard.press("Escape")
    else:
        stopper.locator("#stop").click()
    slowed = watcher.until_slower_than(0.9 * cruise)
    rest = served.wait(lambda s: s["mode"] == "idle" and s["stop_reason"], "rest after the stop")
    # The key is still down and the flood goes on, and yet nothing moves again by itself.
    later = served.wait(
        lambda s: s["board_time_s"] > rest["board_time_s"] + RESTS, "time passing at rest"
    )
    assert (later["mode"], later["xyz_mm"]) == ("idle", rest["xyz_mm"])
    jogger.keyboard.up(key)
    return slowed - pressed


def focus_on(page: Page, *, in_scene: bool) -> None:
    """Put the focus into the scene's frame, or into the console."""
    if in_scene:
        box = page.locator("#scene").bounding_box()
        assert box is not None
        page.mouse.click(box["x"] + box["width"] - 12, box["y"] + box["height"] - 12)
    else:
        page.locator("#stop").focus()
    inside = page.evaluate("() => document.activeElement.id === 'scene'")
    assert inside is in_scene
