"""The board guards itself: each limit by a segment just inside and one just outside."""

from __future__ import annotations

from dataclasses import replace
from math import inf, nan
from pathlib import Path

import numpy as np
import pytest

from deltaviz import load_robot
from deltaviz.link.board import SimulatedBoard
from deltaviz.link.board.checks import Checks
from deltaviz.link.board.limits import Limits, Objection
from deltaviz.link.board.parameters import parameters_from
from deltaviz.link.configuration import configure_from
from deltaviz.link.messages import (
    PROTOCOL_VERSION,
    BoardState,
    Configured,
    Enable,
    Hello,
    Refusal,
    Refused,
    RobotKind,
    StopCause,
    Stopped,
)
from tests.link.board.bench import Host, simulated_only

TOOL_AXIS = Path(__file__).parents[3] / "docs" / "examples" / "stm32-tool.toml"
PRESETS = ["stm32", "trossen", "zheng2023", "deltadraw", "fivebar"]
ACCELERATION = 50_000.0


def reasons(messages):
    return [(m.reason, m.joint) for m in messages if isinstance(m, Refused)]


def test_accelerations_are_judged_at_both_ends(bench):
    bench.arm()
    # a0 = 6 p / h², a1 = -a0, from rest to rest in 10 ms
    assert reasons(bench.segment([0.83, 100], [0, 0])) == []
    bench.run(5)
    assert reasons(bench.segment([0.83, 100.85], [0, 0])) == [(Refusal.ACCELERATION, 1)]
    assert bench.board.state is BoardState.BRAKING


@pytest.mark.parametrize(("speed", "accepted"), [(4000, True), (4010, False)])
def test_velocity_at_the_knot(make_bench, make_configure, speed, accepted):
    bench = make_bench(make_configure(joint_max=(9.0, 9.0)))
    bench.speed_up(speed)
    assert (bench.board.cause is not StopCause.BAD_SEGMENT) == accepted


def test_velocity_between_the_knots(make_bench, make_configure):
    bench = make_bench(make_configure(joint_max=(9.0, 9.0)))
    bench.speed_up(3950)
    p, _ = bench.coast
    # The same speed at both ends, 1.5 (d / h - v) more in the middle.
    messages = bench.segment([p + (3950 + 40) * 0.02, 100], [3950, 0], ms=20)
    assert reasons(messages) == [(Refusal.VELOCITY, 0)]


def test_joint_limits_at_the_knot(make_bench, make_configure):
    bench = make_bench(make_configure(ready=(1.4985, 0.0), homing_switch=(-1.1, -1.1)))
    bench.arm()
    assert reasons(bench.segment([1499.9, 0], [0, 0], ms=50)) == []
    assert reasons(bench.segment([1501.5, 0], [0, 0], ms=50)) == [(Refusal.JOINT_LIMIT, 0)]


def test_joint_limits_between_the_knots(make_bench, make_configure):
    """Out over the limit and back again within one segment."""
    bench = make_bench(make_configure(ready=(1.49, 0.0)))
    bench.arm()
    assert reasons(bench.segment([1495, 0], [400, 0], ms=25)) == []
    messages = bench.segment([1495, 0], [-400, 0], ms=40)  # 4 microsteps over in the middle
    assert reasons(messages) == []
    bench.segment([1490, 0], [0, 0], ms=25)
    assert bench.board.state is BoardState.ARMED
    bench.segment([1496.875, 0], [550, 0], ms=25)
    assert bench.board.state is BoardState.ARMED
    messages = bench.segment([1496.875, 0], [-550, 0], ms=50)  # 6.9 further
    assert reasons(messages) == [(Refusal.JOINT_LIMIT, 0)]


def test_every_knot_must_be_brakeable(make_bench, make_configure):
    bench = make_bench(make_configure(joint_max=(0.15, 1.5)))
    bench.speed_up(2000)  # the brake takes 40 microsteps
    bench.go_on(1)
    assert bench.board.cause is not StopCause.BAD_SEGMENT
    bench.go_on(5)
    assert (Refusal.BRAKE, 0) in reasons(bench.said)
    bench.run_to_rest()
    assert bench.board.counts[0] <= 151
    assert bench.last(Stopped).cause is StopCause.BAD_SEGMENT


@simulated_only
def test_without_the_brakeability_check_the_limit_is_broken(
    make_bench, make_configure, monkeypatch
):
    monkeypatch.setattr(Checks, "_joint_objection", lambda *_: None)
    bench = make_bench(make_configure(joint_max=(0.1, 1.5)))
    bench.speed_up(2000)
    bench.go_on(6)
    bench.run_to_rest()
    assert bench.board.counts[0] > 101


def test_outside_its_limits_it_accepts_only_the_way_in(make_configure):
    parameters = parameters_from(make_configure(), tick_hz=200_000)
    assert parameters is not None
    checks = Checks(Limits(parameters), tick_hz=200_000)

    def judge(p0, p1):
        return checks.objection(
            p0=(p0 * 1024, 0),
            v0=(0, 0),
            p1=(p1 * 1024, 0),
            v1=(0, 0),
            ticks=4000,
            homed=True,
            outside=0.0,
        )

    assert judge(1520, 1519) is None
    assert judge(1520, 1521) == Objection(Refusal.JOINT_LIMIT, 0)
    assert judge(-1020, -1019) is None
    assert judge(-1020, -1021) == Objection(Refusal.JOINT_LIMIT, 0)


@pytest.fixture(params=["stm32", "fivebar", TOOL_AXIS], ids=str)
def guarded(request, make_bench):
    """A robot of each kind, homed; a move in joint space that leaves its workspace."""
    robot = load_robot(request.param)
    return make_bench(configure_from(robot)), robot


def fall(bench, robot, ms=3000):
    """Lowers the tip past the workspace's floor, within every joint's own limits."""
    per_rad = np.array(robot.drive.microsteps_per_rad)
    bench.arm()
    speed, h = 1.0, 0.010  # rad/s
    theta, velocity = np.array(robot.homing.ready), 0.0
    for _ in range(ms // 10):
        faster = min(speed, velocity + 20 * h)
        theta = theta + (velocity + faster) / 2 * h
        velocity = faster
        bench.segment(tuple(theta * per_rad), tuple(velocity * per_rad))
        if bench.index == 1:
            continue  # one stays ahead
        bench.run(10)
        if bench.board.state is not BoardState.ARMED:
            break
    bench.run_to_rest()
    return robot.forward(np.array(bench.board.counts) / per_rad)


def test_it_brakes_before_it_leaves_the_workspace(guarded):
    bench, robot = guarded
    tip = fall(bench, robot)
    assert {reason for reason, _ in reasons(bench.said)} <= {
        Refusal.BRAKE,
        Refusal.WORKSPACE,
        Refusal.STATE,
    }
    assert bench.board.cause in (StopCause.BAD_SEGMENT, StopCause.UNDERRUN)
    assert robot.zone.z[0] - 0.5 <= tip[-1] < robot.zone.z[0] + 20


def creep(bench, robot, *, by_tip):
    """Lowers the tip at 15 mm/s past a floor that is 1 mm below the ready pose, a segment every
    4 ms: none of them goes further than a tip's slack. How far below the floor it came."""
    per_rad = np.array(robot.drive.microsteps_per_rad)
    ready = robot.forward(np.array(robot.homing.ready))
    down, speed, seconds = np.zeros(len(ready)), 0.0, 0.004
    bench.arm()
    for number in range(300):
        faster = min(15.0, speed + 3.0)
        down[-1] -= (speed + faster) / 2 * seconds
        speed = faster
        tip, velocity = ready + down, np.append(np.zeros(len(ready) - 1), -speed)
        if by_tip:
            bench.tip_segment(tip, velocity, ms=4)
        else:
            theta = robot.inverse(tip)
            rates = np.linalg.solve(robot.mechanism.jacobian(theta), velocity)
            bench.segment(tuple(theta * per_rad), tuple(rates * per_rad), ms=4)
        if number > 0:
            bench.run(4)
        if bench.board.state is not BoardState.ARMED:
            break
    bench.run_to_rest()
    return ready[-1] - 1.0 - robot.forward(np.array(bench.board.counts) / per_rad)[-1]


@pytest.mark.parametrize("by_tip", [False, True])
def test_segments_cannot_creep_out_of_the_workspace(make_bench, by_tip):
    """By the slack of each: what one may, a hundred may not."""
    robot = load_robot("stm32")
    floor = robot.forward(np.array(robot.homing.ready))[-1] - 1.0
    configure = replace(configure_from(robot), workspace_z=(float(floor), 0.0))
    bench = make_bench(configure)
    below = creep(bench, robot, by_tip=by_tip)
    assert bench.board.cause is StopCause.BAD_SEGMENT
    assert -0.2 < below < 0.2  # the slack, and the brake's way


@simulated_only
def test_without_its_own_workspace_check_it_would_leave(guarded, monkeypatch):
    monkeypatch.setattr(Checks, "_workspace_objection", lambda *_: None)
    bench, robot = guarded
    assert fall(bench, robot)[-1] < robot.zone.z[0] - 1


TOP_VELOCITY = 200 * 1000 * 65536 // 2004  # a step in 2.004 ticks; 200 are a millisecond


@pytest.mark.parametrize(
    ("field", "taken", "refused"),
    [
        ("joint_min", 100 * 1024, 100 * 1024 + 1),  # the ready pose of joint 1
        ("joint_max", 100 * 1024, 100 * 1024 - 1),
        ("velocity", TOP_VELOCITY, TOP_VELOCITY + 1),
        ("velocity", 131_072, 131_071),  # as fast as homing is
        ("acceleration", 67_109, 67_108),  # a brake of a second
        ("unhomed_velocity", 1, 0),
        ("microsteps_per_rad", 1e-3, 0.0),
        ("microsteps_per_rad", 1e30, inf),
        ("microsteps_per_rad", 1.0, nan),
        ("ready", 1500, 1501),
        ("homing_fast", 262_144, 262_145),  # the joint's velocity
        ("homing_fast", 328, 327),  # its way within ten minutes
        ("homing_slow", 262_144, 262_145),
        ("homing_slow", 328, 327),
        ("homing_backoff", 1, 0),
        ("homing_max_travel", 1, 0),
        ("homing_max_travel", 1 << 20, (1 << 20) + 1),
        ("homing_switch", -(1 << 20), -(1 << 20) - 1),
    ],
)
def test_a_configuration_that_makes_no_sense_is_refused(make_configure, field, taken, refused):
    good = replace(
        make_configure(),
        velocity=(262_144,) * 2,
        acceleration=(1 << 24,) * 2,
        homing_fast=(131_072,) * 2,
        homing_slow=(131_072,) * 2,
    )
    for value, is_taken in ((taken, True), (refused, False)):
        values = (getattr(good, field)[0], value)
        board = SimulatedBoard(start_homed=True)
        board.receive(replace(good, **{field: values}))
        answer = next(m for m in board.take() if isinstance(m, Configured | Refused))
        if is_taken:
            assert isinstance(answer, Configured), value
        else:
            assert answer == Refused("configure", Refusal.CONFIGURATION), value
            assert board.state is BoardState.DISABLED


@pytest.mark.parametrize(
    "changes",
    [
        {"homing_direction": 0},
        {"workspace_radius": 0.0},
        {"workspace_radius": nan},
        {"workspace_x": (1.0, 1.0)},
        {"workspace_z": (nan, 1.0)},
        {"tool_offset": (0.0, inf, 0.0)},
        {"forearm": (338.0, 0.0, 338.0)},
        {"upper_arm": (125.0, 125.0, -1.0)},
        {"azimuth": (0.0, nan, 4.2)},
        {"forearm": (10.0, 10.0, 10.0)},  # they do not meet at the ready pose
    ],
    ids=str,
)
def test_arms_that_make_no_sense_are_refused(changes):
    board = SimulatedBoard(start_homed=True)
    board.receive(replace(configure_from(load_robot("stm32")), **changes))
    assert Refused("configure", Refusal.CONFIGURATION) in board.take()
    assert board.state is BoardState.DISABLED


def test_arms_are_those_of_three_joints(make_configure):
    board = SimulatedBoard(start_homed=True)
    board.receive(replace(make_configure(), kind=RobotKind.ROTARY_DELTA))
    assert Refused("configure", Refusal.CONFIGURATION) in board.take()


@pytest.mark.parametrize("estop", [False, True])
def test_a_board_without_its_clock_takes_no_robot_and_no_enable(make_board, make_configure, estop):
    """At 16 MHz; and it says so in every state, for its host to explain."""
    board = make_board(tick_hz=10_000)
    host = Host(board)
    host.send(Hello(PROTOCOL_VERSION))
    board.press_estop(estop)
    board.advance(20)
    assert board.state is (BoardState.ESTOP if estop else BoardState.DISABLED)
    assert Refused("configure", Refusal.CONFIGURATION) in host.send(make_configure())
    assert Refused("enable", Refusal.CONFIGURATION) in host.send(Enable(on=True))


def test_another_configuration_needs_a_disabled_board(bench, make_configure):
    other = make_configure(joint_max=(1.4, 1.4))
    assert Refused("configure", Refusal.STATE) in bench.send(other)
