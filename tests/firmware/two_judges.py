"""The simulated board's judgement of a segment beside the firmware's, on the same integers.

The simulated board computes in double precision. The firmware adds to its slack what single
precision can be off by: it never refuses what the simulated board accepts, and what it accepts
is at most twice that further out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np
import pytest

from deltaviz import load_robot
from deltaviz.link.board import checks as slack
from deltaviz.link.board.checks import Checks
from deltaviz.link.board.limits import Leeway, Limits, Objection
from deltaviz.link.board.parameters import Parameters, parameters_from
from deltaviz.link.board.queue import Knot
from deltaviz.link.configuration import configure_from
from deltaviz.link.messages import Configure
from deltaviz.mechanism import RotaryDelta
from deltaviz.mechanism.stiffness import TYPE_1_RESERVE, TYPE_2_RESERVE
from tests.firmware import c_library
from tests.link.board import bench

TICK_HZ = 200_000

# firmware/core/limits.h and checks.h, of single precision
RELATIVE_ERROR = 2e-6
POSITION_ERROR = 1 / 16  # microsteps
TIP_ERROR = 0.01  # mm


@dataclass(frozen=True)
class Knots:
    """A segment's two ends, in units of the messages."""

    p0: tuple[int, ...]
    v0: tuple[int, ...]
    p1: tuple[int, ...]
    v1: tuple[int, ...]
    ticks: int
    homed: bool = True


class Watched(Limits):
    """Remembers the poses that were looked at."""

    def __init__(self, parameters: Parameters) -> None:
        super().__init__(parameters)
        self.poses: list[list[float]] = []

    def outside_at(self, microsteps: Sequence[float]) -> float:
        self.poses.append([p / m for p, m in zip(microsteps, self.per_rad, strict=True)])
        return super().outside_at(microsteps)


class Both:
    """One configuration, judged by both boards."""

    def __init__(self, configure: Configure, mechanism: RotaryDelta | None = None) -> None:
        parameters = parameters_from(configure, tick_hz=TICK_HZ)
        in_c = c_library.parameters_from(configure, tick_hz=TICK_HZ)
        assert parameters is not None
        assert in_c is not None
        self.configure = configure
        self._mechanism = mechanism
        self._in_c = in_c
        self._plain = Limits(parameters)
        self._strict = Watched(parameters)
        self._loose = Watched(parameters)

    def c_answer(self, knots: Knots) -> tuple[int, int]:
        return c_library.check_segment(
            self._in_c,
            tick_hz=TICK_HZ,
            start=(knots.p0, knots.v0),
            end=(knots.p1, knots.v1),
            ticks=knots.ticks,
            homed=knots.homed,
            outside=self._outside(knots),
        )

    def _outside(self, knots: Knots) -> float:
        return _leeway(self._plain, knots).outside

    def compare(self, knots: Knots) -> tuple[int, int]:
        """The firmware's answer, after a look at whether it is one of those that it may give."""
        strict, loose = self._ask_both(knots)
        ours = self.c_answer(knots)
        if self._near_a_singularity():
            return ours
        said = f"firmware {ours}, simulated board {strict}, and with more slack {loose}"
        if strict == loose:
            assert ours == strict, said
        else:
            assert ours != (0, -1) or loose == (0, -1), said
        return ours

    def is_clear(self, knots: Knots) -> bool:
        """Whether the judgement is no matter of what single precision is off by."""
        strict, loose = self._ask_both(knots)
        return not self._near_a_singularity() and strict == loose

    def _ask_both(self, knots: Knots) -> tuple[tuple[int, int], tuple[int, int]]:
        """The simulated board, as it is and with more slack."""
        strict = _ask(self._strict, knots)
        start = [p / 1024 for p in knots.p0]
        low, high = (
            zip(self._strict.low, start, strict=True),
            zip(self._strict.high, start, strict=True),
        )
        self._loose.low = [min(pair) - 2 * POSITION_ERROR for pair in low]
        self._loose.high = [max(pair) + 2 * POSITION_ERROR for pair in high]
        with pytest.MonkeyPatch.context() as patch:
            # The slack of accelerations and speeds has a part that does not grow with them.
            patch.setattr(slack, "RELATIVE_SLACK", slack.RELATIVE_SLACK + 3 * RELATIVE_ERROR)
            patch.setattr(slack, "TIP_SLACK", slack.TIP_SLACK + 2 * TIP_ERROR)
            return strict, _ask(self._loose, knots)

    def _near_a_singularity(self) -> bool:
        """Whether a pose was looked at where the tip is hardly determined. The host keeps at
        least thirty times as far from there."""
        theta = np.array(self._strict.poses + self._loose.poses)
        self._strict.poses.clear()
        self._loose.poses.clear()
        if self._mechanism is None or len(theta) == 0:
            return False
        arms = self._mechanism
        margins = arms.margins(arms.forward(theta), theta)
        type_1 = margins[:, :3] / arms.type_1_scale + TYPE_1_RESERVE
        type_2 = margins[:, 3] / arms.type_2_scale + TYPE_2_RESERVE
        near = (np.abs(type_1) < TYPE_1_RESERVE / 30).any(axis=-1)
        near |= ~(np.abs(type_2) > TYPE_2_RESERVE / 30)
        return bool(near.any())


def _leeway(limits: Limits, knots: Knots) -> Leeway:
    """Of an epoch that began where the segment does."""
    return limits.leeway_at(Knot(knots.p0, knots.v0), homed=knots.homed)


def _ask(limits: Limits, knots: Knots) -> tuple[int, int]:
    found: Objection | None = Checks(limits, tick_hz=TICK_HZ).objection(
        p0=knots.p0,
        v0=knots.v0,
        p1=knots.p1,
        v1=knots.v1,
        ticks=knots.ticks,
        homed=knots.homed,
        outside=_leeway(limits, knots).outside,
    )
    if found is None:
        return (0, -1)
    return (int(found.reason), -1 if found.joint is None else found.joint)


@cache
def preset(name: str) -> Both:
    robot = load_robot(name)
    assert isinstance(robot.mechanism, RotaryDelta)
    return Both(configure_from(robot), robot.mechanism)


@cache
def gantry(joints: int = 2) -> Both:
    """Joints alone: 1000 microsteps per rad, -1000 to 1500 of them, 4000/s, 50000/s²; 100/s
    until it is homed."""
    return Both(bench.gantry(joints, ready=(0.0,) * joints))
