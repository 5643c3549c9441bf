"""The firmware judges Cartesian segments as the simulated board does, within single precision.

It never refuses what the simulated board accepts, and accepts nothing that is more than three of
its own errors further out. And it runs them alike: counts differ by one at most.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from math import inf

import numpy as np
import pytest

from deltaviz import load_robot
from deltaviz.link.board import tip_checks
from deltaviz.link.board.limits import Limits
from deltaviz.link.board.parameters import parameters_from
from deltaviz.link.board.tip_checks import TipChecks
from deltaviz.link.configuration import configure_from
from deltaviz.link.messages import Refusal, RobotKind
from tests.firmware import c_library
from tests.firmware.c_board import CBoard
from tests.firmware.two_judges import POSITION_ERROR, TIP_ERROR, gantry
from tests.link.board.bench import Bench, PythonBoard
from tests.link.board.tip_ways import TICK_HZ, Way, leeway_of, ways

PRESETS = ["stm32", "trossen", "zheng2023", "deltadraw"]
RELATIVE_ERROR = 1e-4  # firmware/core/tip_checks.c, of speeds and accelerations


class Both:
    """One configuration, judged by both boards, and with more slack."""

    def __init__(self, configure):
        parameters = parameters_from(configure, tick_hz=TICK_HZ)
        in_c = c_library.parameters_from(configure, tick_hz=TICK_HZ)
        assert parameters is not None
        assert in_c is not None
        self._in_c, self._parameters = in_c, parameters
        self._strict, self._loose = Limits(parameters), Limits(parameters)
        self._loose.low = [low - 3 * POSITION_ERROR for low in self._loose.low]
        self._loose.high = [high + 3 * POSITION_ERROR for high in self._loose.high]

    def compare(self, way: Way, monkeypatch) -> int:
        """The firmware's reason, after a look at whether it is one that it may give."""
        leeway = leeway_of(self._parameters, way)
        reason, joint = c_library.check_tip_segment(
            self._in_c,
            tick_hz=TICK_HZ,
            start=(way.start.p, way.start.v),
            end=(way.end.p, way.end.v),
            ticks=way.ticks,
            began=leeway.began,
            outside=leeway.outside,
        )
        strict = self._ask(self._strict, way)
        with monkeypatch.context() as patch:
            slack = tip_checks.RELATIVE_SLACK + 3 * RELATIVE_ERROR
            patch.setattr(tip_checks, "RELATIVE_SLACK", slack)
            patch.setattr(tip_checks, "TIP_SLACK", tip_checks.TIP_SLACK + 3 * TIP_ERROR)
            loose = self._ask(self._loose, way)
        said = f"firmware {reason, joint}, simulated board {strict}, with more slack {loose}"
        if strict == loose:
            assert (reason, joint) == strict, said
        else:
            assert reason != 0 or loose == (0, -1), said
        return reason

    def _ask(self, limits: Limits, way: Way) -> tuple[int, int]:
        found = TipChecks(limits, tick_hz=TICK_HZ).objection(
            way.start, way.end, way.ticks, leeway=leeway_of(self._parameters, way)
        )
        if found is None:
            return (0, -1)
        return (int(found.reason), -1 if found.joint is None else found.joint)


@pytest.mark.parametrize("name", PRESETS)
def test_presets(name, monkeypatch):
    robot = load_robot(name)
    both = Both(configure_from(robot))
    reasons = Counter(both.compare(way, monkeypatch) for way in ways(robot, 250, seed=3))
    assert reasons[0] > 50
    assert {Refusal.ACCELERATION, Refusal.BRAKE, Refusal.WORKSPACE} <= set(reasons)


def five_bar():
    none = (0.0,) * 2
    return replace(
        gantry(2).configure,
        kind=RobotKind.FIVE_BAR, base_radius=(75.0, 76.0), effector_radius=(25.0, 24.0),
        upper_arm=(100.0, 101.0), forearm=(220.0, 215.0), azimuth=none, ready=(200, 300),
        tool_offset=(3.0, -2.0, -20.0), workspace_z=(-260.0, inf),
    )  # fmt: skip


def test_a_five_bar(monkeypatch):
    both, chance, reasons = Both(five_bar()), np.random.default_rng(4), Counter()
    parameters = parameters_from(five_bar(), tick_hz=TICK_HZ)
    assert parameters is not None
    assert parameters.kinematics is not None
    for _ in range(1500):
        tip = parameters.kinematics.tip(list(chance.uniform(-1.02, 1.52, 2)))
        if tip is None:
            continue
        h, size = float(chance.choice([0.004, 0.010, 0.030])), chance.choice([0.1, 0.5, 1.0, 1.5])
        v0, turn = chance.uniform(-1, 1, (2, 3)) * size * [[200], [3000]] * [1, 0, 1]
        p0 = np.array(tip)
        way = Way(p0, v0, p0 + v0 * h + turn * h * h / 2, v0 + turn * h, h)
        reasons[both.compare(way, monkeypatch)] += 1
    limits = {Refusal.ACCELERATION, Refusal.VELOCITY, Refusal.JOINT_LIMIT, Refusal.BRAKE}
    assert set(reasons) >= limits | {0, Refusal.WORKSPACE}
    assert min(reasons.values()) >= 3, reasons


def test_both_boards_step_alike():
    """Two seconds of a Lissajous figure; where they differ, a position is near a half."""
    robot = load_robot("stm32")
    boards = [
        Bench(configure_from(robot), make_board=make, now=2**32 - 100_000)
        for make in (PythonBoard, CBoard)
    ]
    centre = robot.forward(np.array(robot.homing.ready))
    size, pace = np.array([40.0, 25.0, 15.0]), np.array([2.0, 3.0, 1.0]) * np.pi
    for bench in boards:
        bench.arm()
    apart = differ = 0
    for number in range(1, 201):
        t = number * 0.010
        grow = min(1.0, t) ** 3 * (10 - 15 * min(1.0, t) + 6 * min(1.0, t) ** 2)
        grows = 30 * min(1.0, t) ** 2 * (1 - min(1.0, t)) ** 2
        p = centre + grow * size * np.sin(pace * t)
        v = grows * size * np.sin(pace * t) + grow * size * pace * np.cos(pace * t)
        for bench in boards:
            assert not any(m for m in bench.tip_segment(list(p), list(v)) if hasattr(m, "reason"))
            bench.run(10 if number > 3 else 0)
        one, other = (np.array(bench.counts_trace[-10:]) for bench in boards)
        if number > 3:
            apart = max(apart, np.abs(one - other).max())
            differ += (one != other).sum()
    assert apart <= 1
    assert differ < 0.01 * 3 * 2000
    ends = [np.array(bench.board.positions) / 2**32 for bench in boards]
    assert np.abs(ends[0] - ends[1]).max() < 0.02
