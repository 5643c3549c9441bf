"""Homing finds the switches wherever the arms hang, and says so when it cannot."""

from __future__ import annotations

import pytest

from deltaviz.link.messages import (
    BoardState,
    Done,
    Fault,
    Home,
    Keep,
    Refusal,
    Refused,
    Reset,
    Stop,
    StopCause,
    Stopped,
    Telemetry,
    TelemetryFlags,
)

PER_RAD = 1000.0
ACCELERATION = 50_000.0
MICROSTEP = 1 / PER_RAD


@pytest.mark.parametrize("together", [True, False], ids=["together", "one after another"])
@pytest.mark.parametrize("direction", [-1, 1], ids=["up", "down"])
@pytest.mark.parametrize("joints", [2, 4])
def test_it_ends_at_the_ready_pose_and_knows_it(
    make_bench, make_configure, accelerations, together, direction, joints
):
    switch = -1.1 if direction < 0 else 1.6
    configure = make_configure(
        joints,
        homing_together=together,
        homing_direction=direction,
        homing_switch=tuple(switch + 0.013 * joint for joint in range(joints)),
    )
    bench = make_bench(
        configure, homed=False, theta=tuple(0.6 * switch + 0.1 * j for j in range(joints))
    )
    heard = bench.home()
    assert Done("home") in heard
    assert bench.board.state is BoardState.HALTED
    assert bench.board.homed
    assert bench.last(Stopped).cause is StopCause.HOMED
    assert TelemetryFlags.HOMED in bench.last(Telemetry).flags
    for count, ready, true in zip(
        bench.board.counts, configure.ready, bench.board.plant.theta, strict=True
    ):
        assert count == ready
        assert true * PER_RAD == pytest.approx(ready, abs=1.5)


def test_it_keeps_its_accelerations(make_bench, accelerations):
    """Judged by the true angles of the arms: the counts jump when the switch is found."""
    bench = make_bench(homed=False)
    bench.send(Keep(bench.now))
    bench.send(Home())
    angles = []
    for _ in range(20_000):
        bench.run(1)
        angles.append([theta * PER_RAD for theta in bench.board.plant.theta])
        if not bench.board.moving:
            break
    assert bench.board.homed
    # Arms move in whole microsteps: up to 4 of them in a second difference.
    assert accelerations(angles, window=20) <= ACCELERATION + 4 / 0.020**2


def test_one_after_another_moves_one_arm_at_a_time(make_bench, make_configure):
    bench = make_bench(make_configure(homing_together=False), homed=False)
    bench.send(Keep(bench.now))
    bench.send(Home())
    still = bench.board.plant.theta[1]
    bench.run(200)
    assert bench.board.plant.theta[0] != pytest.approx(0.2, abs=0.1)
    assert bench.board.plant.theta[1] == still


@pytest.mark.parametrize("where", [-1.1, -1.12, -1.15])
def test_it_starts_on_a_pressed_switch_too(make_bench, where):
    bench = make_bench(homed=False, theta=(where, 0.2))
    bench.home()
    assert bench.board.homed
    assert bench.board.plant.theta[0] == pytest.approx(0.0, abs=1.5 * MICROSTEP)


def test_a_switch_that_never_comes_is_a_fault(make_bench, accelerations):
    bench = make_bench(homed=False)
    bench.board.plant.force_switch(1, False)
    bench.home()
    assert bench.board.state is BoardState.FAULT
    assert bench.board.fault is Fault.HOMING_NO_SWITCH
    assert bench.last(Stopped).cause is StopCause.HOMING_FAILED
    assert not bench.board.homed


def test_a_switch_that_is_stuck_is_a_fault(make_bench):
    bench = make_bench(homed=False)
    bench.board.plant.force_switch(0, True)
    bench.home()
    assert bench.board.state is BoardState.FAULT
    assert bench.board.fault is Fault.HOMING_SWITCH_STUCK
    assert Done("reset") in bench.send(Reset())
    assert bench.board.state is BoardState.DISABLED


def test_a_stuck_switch_moves_the_arm_no_further_than_twice_the_back_off(make_bench):
    bench = make_bench(homed=False, theta=(0.5, 0.5))
    bench.board.plant.force_switch(0, True)
    bench.home()
    assert abs(bench.board.plant.theta[0] - 0.5) < 2 * 0.05 + 0.05


def test_it_may_be_repeated(make_bench):
    bench = make_bench()
    bench.home()
    assert bench.board.homed
    bench.home()
    assert bench.board.counts == (0, 100)


def test_it_is_refused_while_something_moves(make_bench):
    bench = make_bench()
    bench.speed_up(1000)
    assert Refused("home", Refusal.MOVING) in bench.send(Home())


def test_a_stop_on_the_way_to_the_ready_pose_leaves_it_unhomed(make_bench):
    bench = make_bench(homed=False)
    bench.send(Keep(bench.now))
    bench.send(Home())
    for _ in range(10_000):
        bench.run(1)
        if abs(bench.counts_trace[-1][0] - bench.counts_trace[max(-2, -len(bench.trace))][0]) > 20:
            break  # the counts have just been set at the switch
    bench.run(100)
    bench.send(Stop())
    bench.run_to_rest()
    assert not bench.board.homed
    assert bench.board.state is BoardState.HALTED


def test_unhomed_it_jogs_slowly_and_without_joint_limits(make_bench):
    bench = make_bench(homed=False)
    bench.arm()
    bench.segment([0.8, 0], [90, 0], ms=20)
    assert bench.board.state is BoardState.ARMED
    messages = bench.segment([0.8 + 2.5, 0], [150, 0], ms=20)
    assert Refusal.UNHOMED_SPEED in [m.reason for m in messages if isinstance(m, Refused)]


def test_unhomed_and_on_its_switch_it_may_be_jogged_off_it(make_bench):
    bench = make_bench(homed=False, theta=(-1.12, 0.2))
    bench.arm()
    bench.segment([0.8, 0], [90, 0], ms=20)
    for step in range(1, 20):
        bench.segment([0.8 + 1.8 * step, 0], [90, 0], ms=20)
    bench.run(300)
    assert bench.board.fault is Fault.NONE
    assert bench.board.plant.theta[0] > -1.1
