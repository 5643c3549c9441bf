"""From a real page to the pins: what left them against what was commanded on the wire."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Callable, Iterator, Sequence
from random import Random
from typing import Any

import pytest
from playwright.sync_api import Page, expect

from deltaviz.link.messages import BoardState
from tests.emulator import judge
from tests.emulator.hosted_board import (
    HostedBoard,
    assert_all_obeyed,
    assert_lost_edges_are_noticed,
)
from tests.emulator.wire import Flow

pytestmark = pytest.mark.browser

TRIES = 12  # of a press that a page which cannot keep up may not take
LONG = 120_000  # ms; software rendering is slow
CLOSE = 0.4  # mm: one microstep of each of the three joints
TEN_MINUTES = 600  # s of board time
KEYS = ("ArrowRight", "ArrowLeft", "ArrowUp", "ArrowDown")


def away(state: dict[str, Any], xyz: Sequence[float]) -> float:
    """How far the robot is from there (mm)."""
    assert state["xyz_mm"] is not None, (state["link"], state["stop_reason"])
    return math.dist(state["xyz_mm"], xyz)


class Person:
    """At the page, with the robot in sight."""

    def __init__(self, page: Page, served: Any, drag: Any, hold: Any) -> None:
        self._page = page
        self._served = served
        self._drag = drag
        self._hold = hold

    def enable_and_home(self) -> None:
        mode = self._page.locator("#mode")
        for button, told in (("Enable", "Not homed"), ("Home", "Idle · homed")):
            self._page.get_by_role("button", name=button, exact=True).first.click()
            expect(mode).to_have_text(told, timeout=LONG)

    def drag(self, dx: float, dy: float) -> None:
        """The effector by so many pixels, until it has followed some way; then let go."""
        before = self._served.state()["xyz_mm"]
        self._drag(dx, dy, lambda s: away(s, before) > 10, let_go=True)
        self._rest()

    def jog(self, key: str, way: float = 10.0) -> None:
        """Hold a key until the robot has come so far (mm), or no further."""
        before = self._served.state()["xyz_mm"]
        self._hold(self._page, key, lambda s: away(s, before) > way)
        self._page.keyboard.up(key)
        self._rest()

    def go(self, xyz: tuple[float, float, float]) -> None:
        for field, value in zip(("X mm", "Y mm", "Z mm"), xyz, strict=True):
            self._page.locator("#move").get_by_label(field).fill(f"{value:g}")
        for _ in range(TRIES):
            self._page.get_by_role("button", name="Go", exact=True).click()
            if self._served.soon(lambda s: s["mode"] == "idle" and away(s, xyz) < CLOSE):
                return
        raise AssertionError(f"the page does not go to {xyz}: {self._served.state()}")

    def _rest(self) -> None:
        self._served.wait(lambda s: s["mode"] == "idle", "rest")


@pytest.fixture
def person(
    console: Page, served: Any, drag: Callable[..., None], hold: Callable[..., None]
) -> Person:
    return Person(console, served, drag, hold)


@contextlib.contextmanager
def judged(board: HostedBoard, *, seed: int) -> Iterator[None]:
    """What is commanded meanwhile, from rest to rest."""
    first, offsets = len(board.motions()), board.offsets
    yield
    board.wire.flow(Flow.RUNS)
    board.wire.until(lambda: not board.wire.telemetry.moving, "rest")
    board.wire.let_pass(0.1)
    board.wire.flow(Flow.WAITS)
    pulses, motions = board.pulses(), board.motions()[first:]
    assert_all_obeyed(board, pulses, motions)
    assert board.offsets == offsets
    random = Random(seed)
    tried = sum(assert_lost_edges_are_noticed(pulses, motion, random) for motion in motions)
    assert tried >= 3


def test_enable_home_drag_jog_and_move(person: Person, served: Any, board: HostedBoard) -> None:
    wire = board.wire
    assert served.post("/api/disable") == 200
    wire.until_state(BoardState.DISABLED)
    off = wire.now
    person.enable_and_home()
    assert max(map(abs, board.offsets)) <= 1
    with judged(board, seed=1):
        person.drag(90, 0)
        person.jog("ArrowRight")
        person.go((-30.0, 20.0, -310.0))
    assert not judge.beyond_limits(
        board.pulses(), board.robot, begin=off, end=wire.now, tick_hz=board.tick_hz
    )


@pytest.mark.long
@pytest.mark.timeout(6 * 3600)
def test_ten_minutes_of_drags_jogs_and_moves(person: Person, board: HostedBoard) -> None:
    """`tests/run -m long tests/e2e/emulated/test_browser.py`"""
    random = Random(7)
    end = board.wire.now + TEN_MINUTES * board.tick_hz
    with judged(board, seed=2):
        while board.wire.now < end:
            x, y, z = (random.uniform(*span) for span in ((-50, 50), (-50, 50), (-370, -300)))
            person.go((round(x, 1), round(y, 1), round(z, 1)))
            person.drag(random.choice((-1, 1)) * random.uniform(50, 90), random.uniform(-20, 20))
            person.jog(random.choice(KEYS), way=random.uniform(2, 15))
