"""The firmware judges segments as the simulated board does: each limit by a motion just inside and
one just outside, then in bulk.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import product
from math import pi

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deltaviz import load_robot
from deltaviz.link.messages import Refusal
from tests.firmware.two_judges import TICK_HZ, Both, Knots, gantry, preset

MS = TICK_HZ // 1000
I32 = st.integers(-(1 << 31), (1 << 31) - 1)


def move(
    p0: Sequence[float], v0: Sequence[float], p1: Sequence[float], v1: Sequence[float], ms: float
) -> Knots:
    """In microsteps, and microsteps per second."""
    return Knots(
        p0=tuple(round(p * 1024) for p in p0),
        v0=tuple(round(v * 65.536) for v in v0),
        p1=tuple(round(p * 1024) for p in p1),
        v1=tuple(round(v * 65.536) for v in v1),
        ticks=round(ms * MS),
    )


# Each reason by a motion just inside and one just outside.


def test_accelerations():
    both = gantry()
    assert both.compare(move([0, 100], [0, 0], [0.83, 100], [0, 0], 10)) == (0, -1)
    refused = both.compare(move([0, 100], [0, 0], [0.83, 100.85], [0, 0], 10))
    assert refused == (Refusal.ACCELERATION, 1)


def test_velocity_at_the_knot_and_between():
    both = gantry()
    assert both.compare(move([0, 0], [4000, 0], [40, 0], [4000, 0], 10)) == (0, -1)
    refused = both.compare(move([0, 0], [4010, 0], [40.1, 0], [4010, 0], 10))
    assert refused == (Refusal.VELOCITY, 0)
    between = both.compare(move([0, 0], [3950, 0], [79.8, 0], [3950, 0], 20))
    assert between == (Refusal.VELOCITY, 0)


def test_speed_until_it_is_homed():
    both = gantry()
    slow = move([9000, 0], [99, 0], [9000.99, 0], [99, 0], 10)
    fast = move([9000, 0], [101, 0], [9001.01, 0], [101, 0], 10)
    assert both.compare(replace(slow, homed=False)) == (0, -1)
    assert both.compare(replace(fast, homed=False)) == (Refusal.UNHOMED_SPEED, 0)


def test_joint_limits_at_the_knot_and_between():
    both = gantry()
    assert both.compare(move([1498.5, 0], [0, 0], [1500.9, 0], [0, 0], 50)) == (0, -1)
    at_knot = both.compare(move([1498.5, 0], [0, 0], [1501.2, 0], [0, 0], 50))
    assert at_knot == (Refusal.JOINT_LIMIT, 0)
    out_and_back = move([1496.875, 0], [550, 0], [1496.875, 0], [-550, 0], 50)
    assert both.compare(out_and_back) == (Refusal.JOINT_LIMIT, 0)
    assert both.compare(move([0, -999], [0, 0], [0, -1001.2], [0, 0], 50))[1] == 1


def test_room_for_the_brake():
    both = gantry()
    assert both.compare(move([1400, 0], [2000, 0], [1460, 0], [2000, 0], 30)) == (0, -1)
    late = both.compare(move([1402, 0], [2000, 0], [1462, 0], [2000, 0], 30))
    assert late == (Refusal.BRAKE, 0)


def test_knots_cannot_creep_beyond_a_limit():
    """Not by the least unit of a position: what one segment may, a thousand may."""
    both = gantry()
    out = 1501 << 10
    for p1, answer in ((out, (0, -1)), (out + 1, (Refusal.JOINT_LIMIT, 0))):
        assert both.compare(Knots((out, 0), (0, 0), (p1, 0), (0, 0), 800)) == answer


def test_outside_its_limits_only_the_way_in():
    both = gantry()
    assert both.compare(move([1520, 0], [0, 0], [1519, 0], [0, 0], 20)) == (0, -1)
    out = both.compare(move([1520, 0], [0, 0], [1521, 0], [0, 0], 20))
    assert out == (Refusal.JOINT_LIMIT, 0)


def test_workspace_and_the_brake_inside_it():
    both = preset("stm32")
    per_rad = both.configure.microsteps_per_rad[0]
    low = float(load_robot("stm32").inverse(np.array([0.0, 0.0, -440.0]))[0]) * per_rad

    def down(to: float, speed: float) -> tuple[int, int]:
        start = to - speed * 0.020
        return both.compare(move([start] * 3, [speed] * 3, [to] * 3, [speed] * 3, 20))

    assert down(low, 0) == (0, -1)
    assert down(low + 1.6, 100) == (Refusal.WORKSPACE, -1)
    assert down(low - 1, 1000) == (Refusal.BRAKE, -1)
    assert down(low - 20, 1000) == (0, -1)


# The same, in bulk.


def _share() -> st.SearchStrategy[float]:
    """Of a limit: often just below or above what is allowed."""
    edge = st.sampled_from([0.0, 0.5, 0.999, 1.0, 1.0009, 1.00099, 1.00101, 1.0011, 1.005, 1.2])
    return st.builds(lambda size, sign: size * sign, edge, st.sampled_from([-1, 1])) | st.floats(
        -1.1, 1.1
    )


@st.composite
def motions(draw: st.DrawFn, both: Both) -> Knots:
    """From any pose in or near the joint limits, with speeds and accelerations near theirs."""
    c = both.configure
    ticks = draw(st.sampled_from([800, 1000, 2000, 4000, 10_000]) | st.integers(800, 10_000))
    h = ticks / TICK_HZ
    ends: list[tuple[int, int, int, int]] = []
    for joint in range(len(c.ready)):
        speed, acceleration = c.velocity[joint] / 65.536, c.acceleration[joint] / 2**24 * 1e6
        low, high = c.joint_min[joint] / 1024, c.joint_max[joint] / 1024
        beyond = 0.05 * (high - low)
        start = draw(
            st.sampled_from([low, high, c.ready[joint]]) | st.floats(low - beyond, high + beyond)
        )
        v0 = draw(_share()) * speed
        a0, a1 = draw(_share()) * acceleration, draw(_share()) * acceleration
        if draw(st.booleans()):  # as a follower would: no faster at the end than allowed
            a1 = max(-speed, min(speed, v0 + (a0 + a1) / 2 * h)) - v0
            a1 = a1 / h * 2 - a0
        if draw(st.booleans()):  # a limit is where the motion, or its brake, ends
            limit = draw(st.sampled_from([low - 1, high + 1])) + draw(st.floats(-0.2, 0.2))
            v1 = v0 + (a0 + a1) / 2 * h
            brake = v1 * abs(v1) / acceleration / 2 * draw(st.sampled_from([0, 1]))
            start = limit - brake - v0 * h - (2 * a0 + a1) * h * h / 6
        end = start + v0 * h + (2 * a0 + a1) * h * h / 6
        v1 = v0 + (a0 + a1) / 2 * h
        ends.append(
            (round(start * 1024), round(v0 * 65.536), round(end * 1024), round(v1 * 65.536))
        )
    p0, v0s, p1, v1s = zip(*ends, strict=True)
    return Knots(p0, v0s, p1, v1s, ticks, draw(st.sampled_from([True, True, True, False])))


@pytest.mark.parametrize("name", ["stm32", "trossen", "zheng2023", "deltadraw"])
@settings(deadline=None, max_examples=200)
@given(data=st.data())
def test_presets(name, data):
    both = preset(name)
    both.compare(data.draw(motions(both)))


@pytest.mark.parametrize("joints", [1, 2, 4])
@settings(deadline=None, max_examples=150)
@given(data=st.data())
def test_joints_alone(joints, data):
    both = gantry(joints)
    both.compare(data.draw(motions(both)))


@settings(deadline=None, max_examples=300)
@given(numbers=st.tuples(*[st.tuples(I32, I32, I32)] * 4), ticks=st.integers(800, 10_000))
def test_any_numbers(numbers, ticks):
    p0, v0, p1, v1 = numbers
    preset("stm32").compare(Knots(p0, v0, p1, v1, ticks))


def test_many_small_moves_reach_every_reason():
    """Slow moves, and fast ones from far off, of a real robot: from poses that a grid gives."""
    both = preset("stm32")
    c = both.configure
    per_rad = c.microsteps_per_rad[0]
    rng = np.random.default_rng(4)
    grid = np.linspace(-pi / 4, pi / 2, 7) * per_rad
    reached: dict[tuple[int, bool], int] = {}
    for pose in product(grid, repeat=3):
        for size in (0.02, 0.1, 0.3, 1.002):
            v0 = rng.uniform(-1, 1, 3) * c.velocity[0] / 65.536 * size
            v1 = v0 + rng.uniform(-1, 1, 3) * 0.008 * c.acceleration[0] / 2**24 * 1e6 * size
            p1 = np.array(pose) + (v0 + v1) / 2 * 0.008
            reason, joint = both.compare(move(pose, list(v0), list(p1), list(v1), 8))
            key = (reason, joint >= 0)
            reached[key] = reached.get(key, 0) + 1
    assert (
        min(
            reached[0, False],
            reached[Refusal.JOINT_LIMIT, True],
            reached[Refusal.BRAKE, True],
            reached[Refusal.BRAKE, False],
            reached[Refusal.WORKSPACE, False],
            reached[Refusal.VELOCITY, True],
        )
        >= 10
    ), reached
