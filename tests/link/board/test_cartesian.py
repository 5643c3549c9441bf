"""Cartesian segments: the tip goes where they say, and the joints keep their limits meanwhile."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from math import inf

import numpy as np
import pytest

from deltaviz import load_robot
from deltaviz.link.configuration import configure_from
from deltaviz.link.messages import (
    BoardState,
    Enable,
    Refusal,
    Refused,
    RobotKind,
    Stop,
    StopCause,
    Stopped,
)

MS = 200
UM = 1e-3  # mm
STM32 = load_robot("stm32")
PER_RAD = np.array(STM32.drive.microsteps_per_rad)


def reasons(messages):
    return [m.reason for m in messages if isinstance(m, Refused)]


def tip(bench, joints=3):
    """Where the tip is by the robot's own forward kinematics, fractions of microsteps included."""
    positions = np.array(bench.board.positions[:joints]) / 2**32
    return STM32.forward(positions / PER_RAD[:joints])


def by(point, x, y, z):
    return np.asarray(point) + np.array([x, y, z])


def line(start, way, ms, *, knot_ms=10):
    """Knots (xyz, v) of a straight way in `ms`, from rest to rest with even jerk at both ends."""
    start, way = np.array(start), np.array(way)
    knots = []
    for t in np.arange(knot_ms, ms + knot_ms / 2, knot_ms) / ms:
        share = t**3 * (10 - 15 * t + 6 * t * t)
        rate = 30 * t * t * (1 - t) ** 2 / (ms / 1000)
        knots.append((start + way * share, way * rate))
    return knots


def beside(points, start, way):
    """The largest distance of points from a line, mm."""
    along = np.array(way) / np.linalg.norm(way)
    off = np.array(points) - start
    return np.linalg.norm(off - np.outer(off @ along, along), axis=1).max()


@pytest.fixture
def delta(make_bench):
    return make_bench(configure_from(STM32))


def run_line(bench, knots, where=tip, *, ahead=5):
    """Drives along knots of 10 ms; where the tip was at each millisecond until it rests."""
    points = [where(bench)]
    for number, (xyz, v) in enumerate(knots):
        assert reasons(bench.tip_segment(xyz, v)) == []
        if number >= ahead:
            points += advance(bench, 10, where)
    for _ in range(10 * ahead + 20):
        points += advance(bench, 1, where)
    assert not bench.board.moving
    return points


def advance(bench, ms, where=tip):
    points = []
    for _ in range(ms):
        bench.run(1)
        points.append(where(bench))
    return points


def test_the_tip_stays_on_a_straight_line(delta):
    bench = delta
    bench.arm()
    start, way = tip(bench), np.array([60.0, -45.0, -30.0])
    points = run_line(bench, line(start, way, 600))
    assert beside(points, start, way) < 1.0 * UM
    assert np.linalg.norm(points[-1] - (start + way)) < 1.0 * UM
    assert bench.board.state is BoardState.ARMED
    assert max(np.linalg.norm(b - a) for a, b in pairwise(points)) < 0.3


def test_even_joints_would_not_stay_on_it(delta):
    """Or the test before would prove nothing."""
    start, way = tip(delta), np.array([60.0, -45.0, -30.0])
    middle = (STM32.inverse(start) + STM32.inverse(start + way)) / 2
    assert beside([STM32.forward(middle)], start, way) > 1.0


@pytest.mark.parametrize("knot_ms", [4, 50])
def test_short_and_long_segments_follow_the_line_alike(delta, knot_ms):
    bench = delta
    bench.arm()
    start, way = tip(bench), np.array([0.0, 8.0, 0.0])
    for xyz, v in line(start, way, 400, knot_ms=knot_ms)[:8]:
        assert reasons(bench.tip_segment(xyz, v, ms=knot_ms)) == []
    points = advance(bench, 8 * knot_ms)
    assert beside(points, start, way) < 1.0 * UM


def test_joint_and_cartesian_segments_meet_at_rest(delta):
    bench = delta
    bench.arm()
    start = tip(bench)
    assert reasons(bench.tip_segment(by(start, 0, 0, -0.5), [0, 0, 0], ms=40)) == []
    joints = STM32.inverse(by(start, 0, 0.5, -0.5)) * PER_RAD
    assert reasons(bench.segment(joints, [0] * 3, ms=40)) == []
    assert reasons(bench.tip_segment(start, [0, 0, 0], ms=50)) == []
    points = advance(bench, 135)
    assert np.linalg.norm(points[41] - (by(start, 0, 0, -0.5))) < 1.0 * UM
    assert np.linalg.norm(points[-1] - start) < 1.0 * UM
    assert bench.board.state is BoardState.ARMED


@pytest.mark.parametrize("first", ["joint", "cartesian"])
def test_they_do_not_meet_in_motion(delta, first):
    bench = delta
    bench.arm()
    here, start = np.array(bench.board.counts), tip(bench)
    send = {
        "joint": lambda: bench.segment(here + 0.05, [10.0] * 3),
        "cartesian": lambda: bench.tip_segment(by(start, 0, 0, -0.02), [0, 0, -4.0]),
    }
    assert reasons(send.pop(first)()) == []
    bench.run(5)
    (other,) = send.values()
    messages = other()
    assert reasons(messages) == [Refusal.KIND]
    command = "segment" if first == "cartesian" else "cartesiansegment"
    assert [(m.command, m.index) for m in messages if isinstance(m, Refused)] == [(command, 1)]
    assert bench.board.state is BoardState.BRAKING
    bench.run_to_rest()
    assert bench.last(Stopped).cause is StopCause.BAD_SEGMENT


def test_where_no_tip_is_known_only_joints_move(make_bench):
    unhomed = make_bench(configure_from(STM32), homed=False)
    without_geometry = make_bench()
    for bench in (unhomed, without_geometry):
        bench.arm()
        assert reasons(bench.tip_segment((0, 0, -300), [0, 0, 0])) == [Refusal.KIND]
        assert bench.board.state is BoardState.HALTED
        assert bench.board.cause is StopCause.BAD_SEGMENT


def to_rest(bench, way, ms, *, start=None):
    """One segment by `way` mm from rest to rest, or from `start`; what was refused."""
    bench.arm()
    origin = tip(bench) if start is None else start
    messages = bench.tip_segment(origin + np.array(way), [0, 0, 0], ms=ms)
    return [(m.reason, m.joint) for m in messages if isinstance(m, Refused)]


def test_joint_accelerations_are_judged(delta):
    """Straight down, the joints turn alike; d = a h² / 6, and 44 mm/rad at the ready pose."""
    limit = STM32.limits.joint.acceleration[0]
    moved = STM32.inverse(by(tip(delta), 0, 0, -0.01))[0] - STM32.inverse(tip(delta))[0]
    most = limit * 0.020**2 / 6 / moved * 0.01
    assert to_rest(delta, (0, 0, -most * 0.99), 20) == []
    delta.send(Stop())
    assert to_rest(delta, (0, 0, -most * 1.02), 20) == [(Refusal.ACCELERATION, 0)]


def test_one_joint_may_be_too_fast_alone(delta):
    bench = delta
    bench.arm()
    start, way = tip(bench), np.array([200.0, 0.0, 0.0])
    knots = line(start, way, 220)
    seen = []
    for xyz, v in knots:
        seen += [
            (m.reason, m.joint)
            for m in bench.tip_segment(xyz, v)
            if isinstance(m, Refused) and m.reason is not Refusal.STATE
        ]
        bench.run(10)
    assert seen
    assert seen[0][0] in (Refusal.VELOCITY, Refusal.ACCELERATION)
    assert seen[0][1] is not None
    assert bench.board.cause is StopCause.BAD_SEGMENT


def unlimited(**changes):
    """Joints of one microstep per rad: none is ever too fast."""
    endless = (-inf, inf)
    free = replace(
        configure_from(STM32),
        microsteps_per_rad=(1.0,) * 3, ready=(0,) * 3,
        joint_min=(-10_240,) * 3, joint_max=(10_240,) * 3,
        velocity=(6_500_000,) * 3, acceleration=(2**32 - 1,) * 3,
        workspace_x=endless, workspace_y=endless, workspace_z=endless, workspace_radius=inf,
    )  # fmt: skip
    return replace(free, **changes)


def test_out_of_reach_is_outside_the_workspace(make_bench):
    start = STM32.forward(np.zeros(3))
    for way, refused in (((0, 0, -150), []), ((0, 0, -180), [(Refusal.WORKSPACE, None)])):
        bench = make_bench(unlimited())
        assert to_rest(bench, way, 50, start=start) == refused


def test_out_of_reach_between_two_looks_it_brakes(make_bench):
    """The board looks each 2 ms, and plans each ms. Between looks, at 1 ms, the tip's cubic
    u (1 - u) (1 - 2u) leads 0.4 mm beyond what is straight arms and forearms.
    """
    bench = make_bench(unlimited())
    deepest = -np.sqrt((125 + 338) ** 2 - 40**2)
    edge, out = [0.0, 0.0, deepest + 0.030], [0.0, 0.0, -1000.0]
    bench.arm()
    assert reasons(bench.tip_segment(edge, out, ms=50)) == []
    assert reasons(bench.tip_segment(edge, out, ms=4)) == []
    bench.run(50)
    assert bench.board.state is BoardState.ARMED
    bench.run(1)
    assert bench.board.state is BoardState.BRAKING
    bench.run_to_rest()
    assert bench.last(Stopped).cause is StopCause.BAD_SEGMENT
    assert max(abs(count) for count in bench.board.counts) <= 3


def test_the_workspace_ends_for_the_tip(make_bench):
    start = STM32.forward(np.zeros(3))
    bench = make_bench(unlimited(workspace_z=(float(start[2]) - 5.0, inf)))
    assert to_rest(bench, (0, 0, -5.09), 50, start=start) == []
    bench.send(Stop())
    assert to_rest(bench, (0, 0, -5.12), 50, start=start) == [(Refusal.WORKSPACE, None)]


def test_joint_limits_and_the_room_to_brake(make_bench):
    """5 microsteps, and one of slack. To a speed from rest, and back to rest, is twice as far."""
    configure = configure_from(STM32)
    most = configure.ready[0] * 1024 + 5 * 1024
    bench = make_bench(replace(configure, joint_max=(most,) * 3))
    start, theta = tip(bench), np.array(configure.ready) / PER_RAD

    def turned(microsteps):
        return STM32.forward(theta + microsteps / PER_RAD) - start

    assert to_rest(bench, turned(6.1), 50) == [(Refusal.JOINT_LIMIT, 0)]
    assert to_rest(bench, turned(5.9), 50) == []
    bench.send(Stop())
    for microsteps, refused in ((4.0, [Refusal.BRAKE]), (2.5, [])):
        ms = np.ceil(np.sqrt(2 * microsteps / 36_000) * 1000)
        bench.arm()
        way = turned(microsteps)
        messages = bench.tip_segment(start + way, way * 2000 / ms, ms=ms)
        assert reasons(messages) == refused
        bench.send(Stop())


@pytest.mark.parametrize("ms", [3, 17, 46, 88, 123])
def test_a_stop_brakes_the_joints(delta, accelerations, ms):
    bench = delta
    bench.arm()
    for xyz, v in line(tip(bench), (40.0, 30.0, -20.0), 300)[:20]:
        assert reasons(bench.tip_segment(xyz, v)) == []
    bench.run(ms)
    bench.advance(ms)
    bench.send(Stop())
    bench.advance(MS - ms)
    bench.trace.append([position / 2**32 for position in bench.board.positions])
    bench.run_to_rest()
    assert bench.board.state is BoardState.HALTED
    limit = STM32.limits.joint.acceleration[0] * PER_RAD[0]
    assert accelerations(bench.trace) <= limit * 1.02
    bench.arm()
    assert bench.board.state is BoardState.ARMED


def test_a_queue_that_ends_in_motion_brakes(delta, accelerations):
    bench = delta
    bench.arm()
    for xyz, v in line(tip(bench), (40.0, 30.0, -20.0), 300)[:10]:
        bench.tip_segment(xyz, v)
    bench.run_to_rest()
    assert bench.last(Stopped).cause is StopCause.UNDERRUN
    limit = STM32.limits.joint.acceleration[0] * PER_RAD[0]
    assert 0.2 * limit < accelerations(bench.trace) <= limit * 1.02


def with_rotation(configure):
    """A fourth joint that turns the tool, without a geometry."""
    changed = {}
    for name in (
        "joint_min", "joint_max", "velocity", "acceleration", "unhomed_velocity",
        "microsteps_per_rad", "inverted", "homing_switch", "homing_fast", "homing_slow",
        "homing_backoff", "homing_max_travel",
    ):  # fmt: skip
        values = getattr(configure, name)
        changed[name] = (*values, values[0])
    for name in ("base_radius", "effector_radius", "upper_arm", "forearm", "azimuth"):
        changed[name] = (*getattr(configure, name), 0.0)
    return replace(configure, ready=(*configure.ready, 77), **changed)


def test_a_tool_that_turns_stands_still_meanwhile(make_bench):
    bench = make_bench(with_rotation(configure_from(STM32)))
    bench.arm()
    start = tip(bench)
    turned = [*np.array(bench.board.counts[:3]), 80.0]
    assert reasons(bench.segment(turned, [0.0] * 4, ms=50)) == []
    assert reasons(bench.tip_segment(by(start, 0.5, 0, 0), [0, 0, 0], ms=50)) == []
    bench.run(110)
    assert not bench.board.moving
    assert np.linalg.norm(tip(bench) - (by(start, 0.5, 0, 0))) < 1.0 * UM
    assert bench.board.counts[3] == 80
    turned = [*(STM32.inverse(start) * PER_RAD), 79.0]
    assert reasons(bench.segment(turned, [0.0] * 4, ms=50)) == []
    bench.run(60)
    assert bench.board.counts[3] == 79
    assert np.linalg.norm(tip(bench) - start) < 1.0 * UM


def five_bar(gantry):
    """150 mm between its motors; the ready pose is level."""
    return replace(
        gantry,
        kind=RobotKind.FIVE_BAR,
        base_radius=(75.0,) * 2,
        effector_radius=(25.0,) * 2,
        upper_arm=(100.0,) * 2,
        forearm=(220.0,) * 2,
        tool_offset=(0.0, 0.0, -20.0),
        ready=(200, 300),
    )


def five_bar_tip(bench):
    """Where circles of 220 mm about the elbows meet, below them."""
    left, right = (position / 2**32 / 1000 for position in bench.board.positions)
    elbows = np.array(
        [
            (-50 - 100 * np.cos(left), -100 * np.sin(left)),
            (50 + 100 * np.cos(right), -100 * np.sin(right)),
        ]
    )
    middle, half = elbows.mean(axis=0), (elbows[1] - elbows[0]) / 2
    down = np.array([half[1], -half[0]]) / np.linalg.norm(half)
    x, z = middle + down * np.sqrt(220**2 - half @ half)
    return np.array([x, 0.0, z - 20.0])


def test_a_five_bar_draws_a_line_in_its_plane(make_bench, make_configure):
    bench = make_bench(five_bar(make_configure()))
    bench.arm()
    start, way = five_bar_tip(bench), np.array([25.0, 0.0, -12.0])
    points = run_line(bench, line(start, way, 500), five_bar_tip)
    assert beside(points, start, way) < 1.0 * UM
    assert np.linalg.norm(points[-1] - (start + way)) < 1.0 * UM


def test_a_five_bar_does_not_leave_its_plane(make_bench, make_configure):
    bench = make_bench(five_bar(make_configure()))
    bench.arm()
    start = five_bar_tip(bench)
    assert reasons(bench.tip_segment(by(start, 0, 0.1, 0), [0, 0, 0], ms=50)) == [Refusal.WORKSPACE]
    bench.arm()
    assert reasons(bench.tip_segment(start, [0, 20.0, 0], ms=50)) == [Refusal.WORKSPACE]


def test_after_homing_the_tip_is_known(make_bench, make_configure):
    bench = make_bench(five_bar(make_configure()), homed=False)
    bench.send(Enable(on=True))
    bench.home()
    bench.arm()
    start = five_bar_tip(bench)
    assert reasons(bench.tip_segment(by(start, 0.3, 0, 0), [0, 0, 0], ms=50)) == []
    bench.run(60)
    assert np.linalg.norm(five_bar_tip(bench) - start - (0.3, 0, 0)) < 1.0 * UM
