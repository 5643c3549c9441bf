"""Writes a short capture of the controller and a simulated board, by a clock of its own.

`python -m tests.link.capture.make` makes tests/data/session.capture anew: a move is stopped, a jog
is let go, another is ended by the e-stop.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path

from deltaviz.link.board import SimulatedBoard
from deltaviz.link.capture.writer import CaptureWriter
from deltaviz.link.memory import MemoryTransport
from deltaviz.link.transport import Transport
from deltaviz.machine import intent as i
from deltaviz.machine.controller import Controller
from deltaviz.machine.link_keeper import LinkKeeper
from deltaviz.machine.mode import Mode
from deltaviz.robots import Robot, load_robot
from tests.machine.conftest import steady_follower
from tests.machine.kept_bench import at_once

KEPT = Path(__file__).parents[2] / "data" / "session.capture"
ME = "me"
TURN = 0.002  # s


class CapturedRun:
    def __init__(self, path: Path) -> None:
        self.now = 50.0
        robot = load_robot("stm32")
        about = {"program": "tests", "robot": "stm32"}
        self._capture = CaptureWriter(path, about, clock=lambda: self.now)
        self.controller = Controller(
            robot,
            link="memory",
            robots={"stm32": lambda: robot},
            robot_id="stm32",
            follower=steady_follower,
        )
        self._keeper = LinkKeeper(self.controller, open_link=self._open, opener=at_once)

    def _open(self, link: str, _robot: Robot) -> Transport:
        board = SimulatedBoard(start_homed=True, boot=7, now=0xFFFF_FFFF - 60_000)
        return MemoryTransport(board, lambda: self.now, partial(self._capture.tap, link))

    def do(self, intent: Callable[[float], i.Intent]) -> None:
        """One turn, in which somebody wishes something at this time."""
        self.turn(lambda: self._take(intent(self.now)))

    def _take(self, intent: i.Intent) -> None:
        assert self.controller.handle(intent, self.now) == i.Accepted()

    def until(self, condition: Callable[[], bool]) -> None:
        end = self.now + 5.0
        while not condition():
            assert self.now < end, self.controller.snapshot(self.now)
            self.turn()

    def run(self, seconds: float) -> None:
        for _ in range(round(seconds / TURN)):
            self.turn()

    def turn(self, wish: Callable[[], None] = lambda: None) -> None:
        """As the machine's process does it."""
        self.now = round(self.now + TURN, 6)
        self._keeper.receive(self.now)
        wish()
        self._keeper.send(self.controller.tick(self.now))
        while self.controller.hungry(self.now):
            self._keeper.send(self.controller.tick(self.now))
        self._keeper.follow()

    def close(self) -> None:
        self._keeper.close()
        self._capture.close()


def make(path: Path) -> None:
    run = CapturedRun(path)
    run.until(lambda: run.controller.mode is Mode.IDLE)
    run.do(lambda _: i.MoveToPoint(ME, (40.0, 10.0, -270.0), 1.0))
    run.run(0.2)
    run.do(lambda _: i.Stop(ME, "Stop was pressed"))
    run.until(lambda: run.controller.mode is Mode.IDLE)
    run.do(lambda _: i.StepPoint(ME, (0.0, -5.0, -5.0)))
    run.until(lambda: run.controller.mode is Mode.IDLE)
    run.do(lambda now: i.JogStart(ME, "jog", i.JogFrame.BASE, (80.0, 0.0, -40.0), now))
    run.run(0.15)
    run.do(lambda _: i.EStop(ME, "E-stop was pressed"))
    run.run(0.05)
    run.close()


if __name__ == "__main__":
    target = Path(sys.argv[1]) if sys.argv[1:] else KEPT
    target.unlink(missing_ok=True)
    make(target)
