"""A person who works with the robot whatever the wire does: jogs, moves, drags, lets go; presses
again after a stop, and connects again when the link is given up.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from math import cos, sin

from deltaviz.machine import intent as i
from deltaviz.machine.mode import Mode
from deltaviz.machine.transitions import AT_REST, MOVING
from tests.faults.wire_bench import LINK, WireBench

ME = "me"
TURN = 0.002  # s
BEAT = 0.05  # s
SPEED = 200.0  # mm/s
WORK = 1.0  # s of one press
LONGEST = 5.0  # s in which every motion here comes to its end
PATIENCE = 3.0  # s until a stopped robot rests and may be moved again


@dataclass
class Day:
    """What the person met. `stops` are by what they were told."""

    moved: float = 0.0  # s in which the robot did as told
    stops: Counter[str] = field(default_factory=Counter)
    untold: int = 0  # stops without a word

    @property
    def count(self) -> int:
        return self.stops.total() + self.untold


class Operator:
    def __init__(self, bench: WireBench) -> None:
        self.bench = bench
        self.day = Day()
        self._presses = 0

    def work(self, seconds: float) -> Day:
        """For so long, and until the robot rests."""
        end = self.bench.now + seconds
        while self.bench.now < end:
            if self._get_ready():
                self._presses += 1
                (self._jog, self._move, self._drag)[self._presses % 3]()
        self.rest()
        return self.day

    def get_ready(self, *, within: float) -> None:
        end = self.bench.now + within
        while not self._get_ready():
            assert self.bench.now < end, f"cannot be made ready: {self.bench.snapshot}"

    def rest(self) -> None:
        self._wait(lambda: self.bench.mode in AT_REST and not self.bench.board.moving)
        self.bench.run(0.1)

    # One press each.

    def _jog(self) -> None:
        press, start = f"press {self._presses}", self.bench.now
        began = i.JogStart(ME, press, i.JogFrame.BASE, self._velocity(start), start)
        if self._accepted(began):

            def beat() -> None:
                self.bench.beat(self._velocity(start), press=press)

            self._hold(start, beat)
            self._accepted(i.JogEnd(ME, press))
            self._until_still()

    def _move(self) -> None:
        x, y = self._somewhere()
        if self._accepted(i.MoveToPoint(ME, (x, y, -300.0), 1.0)):
            self._until_still()

    def _drag(self) -> None:
        start = self.bench.now
        self._alive()
        if self._accepted(i.DragStart(ME, start)):

            def pull() -> None:
                self._alive()
                angle = 2.0 * (self.bench.now - start)
                self.bench.do(i.DragTo(ME, (60 * sin(angle), 60 * cos(angle), -300.0), start))

            self._hold(start, pull)
            self._accepted(i.DragEnd(ME))
            self._until_still()

    def _velocity(self, start: float) -> tuple[float, float, float]:
        x, y, _ = self.bench.snapshot.xyz or (0.0, 0.0, 0.0)
        inwards = -SPEED if x > 0 else SPEED
        turned = inwards if round((self.bench.now - start) / 0.3) % 2 == 0 else -inwards
        return (turned, -SPEED / 4 if y > 0 else SPEED / 4, 0.0)

    def _somewhere(self) -> tuple[float, float]:
        angle = 2.4 * self._presses
        return 70 * sin(angle), 70 * cos(angle)

    def _alive(self) -> None:
        now = self.bench.now
        self.bench.do(i.DragAlive(ME, round(now * 1000), now * 1000, now))

    # What comes between.

    def _accepted(self, intent: i.Intent) -> bool:
        """A person does not press again within this."""
        accepted = self.bench.do(intent) == i.Accepted()
        if not accepted:
            self.bench.run(BEAT)
        return accepted

    def _get_ready(self) -> bool:
        """Idle, connected and enabled; whether that has come about."""
        bench = self.bench
        match bench.mode:
            case Mode.IDLE:
                return True
            case Mode.OFFLINE if not bench.controller._opening and bench.transport is None:
                self._accepted(i.Connect(ME, LINK))
            case Mode.DISABLED:
                self._accepted(i.Enable(ME))
            case Mode.UNHOMED:
                self._accepted(i.Home(ME))
            case Mode.FAULT | Mode.ESTOP:
                self._accepted(i.Reset(ME))
            case _:
                pass
        bench.run(0.02)
        return False

    def _hold(self, start: float, beat: object) -> None:
        assert callable(beat)
        while self.bench.mode is Mode.JOGGING and self.bench.now < start + WORK:
            beat()
            self.bench.run(BEAT)
            self.day.moved += BEAT

    def _until_still(self) -> None:
        """Or until it was stopped: then the person reads why."""
        end = self.bench.now + LONGEST
        while self.bench.mode in (Mode.JOGGING, Mode.MOVING):
            assert self.bench.now < end, f"goes on without an end: {self.bench.snapshot}"
            self.bench.run(TURN)
            self.day.moved += TURN
        if self.bench.mode is Mode.IDLE and self.bench.snapshot.stop_reason is None:
            return
        self._wait(lambda: self.bench.mode not in MOVING)
        told = self.bench.snapshot.stop_reason or self.bench.snapshot.link.problem
        if told is None:
            self.day.untold += 1
        else:
            self.day.stops[told] += 1

    def _wait(self, condition: object) -> None:
        assert callable(condition)
        end = self.bench.now + PATIENCE
        while not condition():
            assert self.bench.now < end, f"does not come to rest: {self.bench.snapshot}"
            self.bench.run(TURN)
