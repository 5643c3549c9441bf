"""The two tiers: counts and positions against exact arithmetic, however time is cut up."""

from __future__ import annotations

import random
from fractions import Fraction
from math import floor

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from deltaviz.link.board.brake import brake
from deltaviz.link.board.paths import Cubic
from deltaviz.link.board.stepper import Stepper
from deltaviz.link.messages import BoardState
from tests.link.board.bench import Bench

Q32 = 2**32
EXACT = settings(deadline=None, derandomize=True)
NEAR = Fraction(1, 10_000)  # microsteps: what the integers may be off

knots = st.tuples(
    st.integers(-(2**31), 2**31 - 1),  # p0, 2^-10 microsteps
    st.integers(-(2**22), 2**22),  # p1 - p0
    st.integers(-100 * 65536, 100 * 65536),
    st.integers(-100 * 65536, 100 * 65536),
    st.integers(800, 10_000),
)


def exact(p0, p1, v0, v1, ticks, tick):
    """The cubic by its definition, microsteps."""
    t, h = Fraction(tick, 200), Fraction(ticks, 200)  # ms
    a, b = Fraction(p0, 1024), Fraction(p1, 1024)
    u, w = Fraction(v0, 65536), Fraction(v1, 65536)
    s = t / h
    return (
        a * (1 + 2 * s) * (1 - s) ** 2
        + u * h * s * (1 - s) ** 2
        + b * s**2 * (3 - 2 * s)
        + w * h * s**2 * (s - 1)
    )


@EXACT
@given(knots, st.floats(0, 1))
def test_a_cubic_is_the_cubic(knot, share):
    p0, change, v0, v1, ticks = knot
    cubic = Cubic(
        start=[p0], end=[p0 + change], v_start=[v0], v_end=[v1], ticks=ticks, ticks_per_ms=200
    )
    tick = round(share * ticks)
    here = Fraction(cubic.positions(tick)[0], Q32)
    assert abs(here - exact(p0, p0 + change, v0, v1, ticks, tick)) < NEAR * 10
    assert cubic.positions(0)[0] == p0 << 22
    assert cubic.positions(ticks)[0] == (p0 + change) << 22


@EXACT
@given(knots, st.floats(0.1, 0.9))
def test_a_cubics_velocity_is_its_slope(knot, share):
    p0, change, v0, v1, ticks = knot
    cubic = Cubic(
        start=[p0], end=[p0 + change], v_start=[v0], v_end=[v1], ticks=ticks, ticks_per_ms=200
    )
    tick = round(share * ticks)
    slope = (
        exact(p0, p0 + change, v0, v1, ticks, tick + Fraction(1, 100))
        - exact(p0, p0 + change, v0, v1, ticks, tick - Fraction(1, 100))
    ) / Fraction(2, 100 * 200)
    assert abs(Fraction(cubic.velocities(tick)[0], 65536) - slope) < Fraction(1, 1000)


@EXACT
@given(
    st.integers(-(2**40), 2**40),
    st.lists(st.integers(-(2**38), 2**38), min_size=1, max_size=4),
    st.lists(st.integers(1, 60), max_size=6),
)
def test_pieces_are_the_same_however_time_is_cut(start, changes, cuts):
    """Against a counter that adds its increment tick by tick, as the real board does."""
    stepper, position = Stepper(1, 200), start
    stepper.place([start])
    for change in changes:
        target = start + change
        stepper.plan([target])
        stepper.advance(200)
        assert stepper.positions == [start]
        stepper.begin_piece()
        passed, cut = 0, iter([*cuts, 199, 199])
        while (step := min(next(cut), 199 - passed)) > 0:
            stepper.advance(step)
            position += change // 200 * step
            passed += step
            assert stepper.positions == [position]
            assert stepper.counts == ((2 * position + 2**32) // 2**33,)
        stepper.advance(200 - passed)
        stepper.plan([target])
        stepper.begin_piece()
        position = start = target
        assert stepper.positions == [target]


@EXACT
@given(st.lists(st.tuples(st.integers(-(2**25), 2**25), st.integers(2**17, 2**32)),
                min_size=1, max_size=4))  # fmt: skip
def test_the_brake_is_straight_even_and_within_limits(joints):
    velocities = [v for v, _ in joints]
    limits = [a for _, a in joints]
    ramp = brake(positions=[0] * len(joints), velocities=velocities, accelerations=limits,
                 ticks_per_ms=200)  # fmt: skip
    assert ramp.velocities(0) == velocities
    assert ramp.velocities(ramp.ticks) == [0] * len(joints)
    time = Fraction(ramp.ticks, 200)  # ms
    for velocity, limit in joints:
        assert abs(Fraction(velocity, 65536)) / time <= Fraction(limit, 2**32)
    longest = max(abs(Fraction(v, 65536)) / Fraction(a, 2**32) for v, a in joints)
    assert time <= max(longest + Fraction(1, 200), 1)
    for position, velocity in zip(ramp.positions(ramp.ticks), velocities, strict=True):
        assert abs(Fraction(position, Q32) - Fraction(velocity, 65536) * time / 2) < NEAR


def wander(rng: random.Random, counts, segments):
    """Random segments within the limits, of constant acceleration: (p, v, ms)."""
    knots = []
    p = [float(count) for count in counts]
    v = [0.0] * len(p)
    for _ in range(segments):
        ms = rng.randint(4, 20)
        h = ms / 1000
        for joint in range(len(p)):
            faster = v[joint] + rng.uniform(-45_000, 45_000) * h
            faster = max(-3000.0, min(3000.0, faster))
            p[joint] += (v[joint] + faster) / 2 * h
            v[joint] = faster
        knots.append((tuple(round(x * 1024) for x in p), tuple(round(x * 65.536) for x in v), ms))
    return knots


@pytest.mark.parametrize("joints", [2, 3, 4])
@settings(EXACT, max_examples=15, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(seed=st.integers(0, 2**32 - 1))
def test_every_millisecond_its_count_is_the_cubics(make_board, make_configure, joints, seed):
    rng = random.Random(seed)
    room = {"joint_min": (-3.0,) * joints, "joint_max": (3.0,) * joints}
    bench = Bench(make_configure(joints, **room), make_board=make_board, now=2**32 - 5000)
    board = bench.board
    bench.arm()
    knots = wander(rng, board.counts, 8)
    last = tuple(count << 10 for count in board.counts), (0,) * joints
    for p, v, ms in knots:
        bench.segment([x / 1024 for x in p], [x / 65.536 for x in v], ms=ms)
    assert board.state is BoardState.ARMED
    bench.advance(2 * 200)  # is planned already
    for p1, v1, ms in knots:
        p0, v0 = last
        for passed in range(1, ms + 1):
            before = board.counts
            part = rng.randint(1, 199)
            bench.advance(part)
            bench.advance(200 - part)
            for joint in range(joints):
                here = exact(p0[joint], p1[joint], v0[joint], v1[joint], ms * 200, passed * 200)
                assert board.counts[joint] in (floor(here - NEAR + 0.5), floor(here + NEAR + 0.5))
                assert abs(board.counts[joint] - before[joint]) <= 4  # 3 a ms, and a fraction
        last = p1, v1
    assert board.state is BoardState.BRAKING
