"""What the board accepts of the tip keeps the joints' limits, between its looks, too.

The judge is the robot's own inverse kinematics, five times a millisecond, and differences.
"""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

from deltaviz import load_robot
from deltaviz.link.board import tip_checks
from deltaviz.link.board.limits import Limits
from deltaviz.link.board.parameters import parameters_from
from deltaviz.link.board.tip_checks import TipChecks
from deltaviz.link.configuration import configure_from
from deltaviz.link.messages import Refusal
from tests.link.board.tip_ways import TICK_HZ, Way, leeway_of, ways

PRESETS = ["stm32", "trossen", "zheng2023", "deltadraw"]
APART = 0.0002  # s
MOST = 1.003  # of a limit: a thousandth of slack, and what lies between two looks


def checks_of(robot):
    parameters = parameters_from(configure_from(robot), tick_hz=TICK_HZ)
    assert parameters is not None
    return TipChecks(Limits(parameters), tick_hz=TICK_HZ)


def objection_to(robot, way: Way):
    """In an epoch that began where the way does."""
    parameters = parameters_from(configure_from(robot), tick_hz=TICK_HZ)
    assert parameters is not None
    leeway = leeway_of(parameters, way)
    return checks_of(robot).objection(way.start, way.end, way.ticks, leeway=leeway)


def judge(robot, way: Way):
    """The highest speed and acceleration, in limits; and microsteps beyond a joint's range."""
    theta = robot.inverse(way.at(np.linspace(0, 1, round(way.seconds / APART) + 1)))
    rates = np.diff(theta, axis=0) / APART
    turns = np.diff(rates, axis=0) / APART
    limits = robot.limits.joint
    beyond = max((theta - robot.joints.max).max(), (robot.joints.min - theta).max())
    return (
        (np.abs(rates) / limits.velocity).max(),
        (np.abs(turns) / limits.acceleration).max(),
        beyond * max(robot.drive.microsteps_per_rad),
    )


def accepted(robot, count, *, seed=1):
    reasons = Counter()
    kept = []
    for way in ways(robot, count, seed=seed):
        objection = objection_to(robot, way)
        if objection is None:
            kept.append(way)
        else:
            reasons[objection.reason] += 1
    return kept, reasons


@pytest.mark.parametrize("name", PRESETS)
def test_no_joint_is_beyond_its_limits(name):
    robot = load_robot(name)
    kept, reasons = accepted(robot, 300)
    judged = np.array([judge(robot, way) for way in kept])
    assert len(kept) > 60
    assert judged[:, 0].max() <= MOST
    assert 0.9 < judged[:, 1].max() <= MOST
    assert judged[:, 2].max() <= 1.01
    assert reasons[Refusal.ACCELERATION] > 30
    assert set(reasons) >= {Refusal.WORKSPACE, Refusal.BRAKE}


def test_it_looks_between_the_ends(monkeypatch):
    """Down through the floor of the workspace and up again."""
    robot = load_robot("stm32")
    floor = robot.zone.z[0]
    for deep, refused in ((0.05, None), (0.15, Refusal.WORKSPACE)):
        speed = deep * 4 / 0.050
        here, v = np.array([20.0, 30.0, floor]), np.array([0.0, 0.0, speed])
        way = Way(here, -v, here, v, 0.050)
        objection = objection_to(robot, way)
        assert (objection and objection.reason) == refused
    monkeypatch.setattr(tip_checks, "APART_MS", 1000)
    assert objection_to(robot, way) is None


def test_a_way_that_is_refused_breaks_a_limit():
    """Not all are, but of those for a joint's speed or acceleration."""
    robot = load_robot("stm32")
    seen = 0
    for way in ways(robot, 300, seed=2):
        objection = objection_to(robot, way)
        if objection is not None and objection.reason is Refusal.ACCELERATION:
            seen += 1
            assert judge(robot, way)[1] > 0.98
    assert seen > 30
