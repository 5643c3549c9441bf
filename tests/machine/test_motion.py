"""Ways of moving: what a person does, and where the reported pose goes."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import pytest

from deltaviz.link import messages as m
from deltaviz.machine import intent as i
from deltaviz.machine.mode import Mode

ME = "me"
ACCEPTED = i.Accepted()
STEP = 0.25  # mm; about one microstep of the stm32 preset


def drag_alive(bench: Any) -> None:
    ms = bench.now * 1000
    bench.do(i.DragAlive(ME, round(ms), ms, bench.now))


def start_drag(bench: Any) -> None:
    drag_alive(bench)
    assert bench.do(i.DragStart(ME, bench.now)) == ACCEPTED


def test_a_held_jog_moves_and_letting_go_slows_it_down(bench: Any) -> None:
    x = bench.snapshot.xyz[0]
    bench.jog((100.0, 0.0, 0.0), 0.5)
    assert bench.snapshot.xyz_speed[0] == pytest.approx(100.0, rel=0.15)
    epoch = bench.segments()[-1].epoch
    bench.do(i.JogEnd(ME, "p"))
    assert bench.mode is Mode.JOGGING
    bench.run_until(lambda: bench.mode is Mode.IDLE, within=0.5)
    assert bench.snapshot.xyz[0] > x + 40
    assert bench.snapshot.stop_reason is None, "letting go is no stop"
    assert not any(isinstance(message, m.Stop) for message in bench.sent)
    assert not any(isinstance(message, m.Stopped) for message in bench.heard)
    bench.check_limits()
    bench.jog((-100.0, 0.0, 0.0), 0.1, press="q")
    assert bench.segments()[-1].epoch == epoch, "the epoch goes on"


def test_a_beat_may_change_the_velocity(bench: Any) -> None:
    bench.jog((60.0, 0.0, 0.0), 0.3)
    bench.hold((0.0, 60.0, 0.0), 0.4)
    vx, vy, _ = bench.snapshot.xyz_speed
    assert abs(vx) < 15
    assert vy == pytest.approx(60.0, rel=0.25)
    bench.run(0.01)
    assert bench.beat((math.nan, 0.0, 0.0)).kind is i.RefusalKind.VALUE
    bench.run(0.01)
    assert bench.beat((1.0, 0.0)).kind is i.RefusalKind.VALUE


def test_a_single_joint_turns(bench: Any) -> None:
    before = bench.snapshot.theta
    bench.do(i.JogStart(ME, "1", i.JogFrame.JOINTS, (0.5, 0.0, 0.0), bench.now))
    bench.hold((0.5, 0.0, 0.0), 0.4, press="1")
    after = bench.snapshot.theta
    assert after[0] > before[0] + 0.1
    assert after[1:] == pytest.approx(before[1:], abs=3e-3)


def test_a_jog_against_a_limit_says_which_and_what_leads_out(bench: Any) -> None:
    bench.jog((0.0, 0.0, 200.0), 1.5)
    held = bench.snapshot.held_by
    assert held
    assert held[0].limit
    assert "-Z" in held[0].way_out
    assert bench.mode is Mode.JOGGING
    bench.hold((0.0, 0.0, -100.0), 0.4)
    assert bench.snapshot.xyz_speed[2] < -50
    bench.check_limits()


def test_steps_add_to_the_running_steps_target(bench: Any) -> None:
    x, y, z = bench.snapshot.xyz
    for _ in range(4):
        assert bench.do(i.StepPoint(ME, (5.0, 0.0, 0.0))) == ACCEPTED
        bench.run(0.02)
    bench.run_until(lambda: bench.mode is Mode.IDLE)
    assert bench.snapshot.command_xyz == pytest.approx((x + 20, y, z), abs=0.01)
    assert bench.snapshot.xyz == pytest.approx((x + 20, y, z), abs=STEP)
    assert bench.do(i.StepAngles(ME, (0.05, 0.0, 0.0))) == ACCEPTED
    assert bench.do(i.StepAngles(ME, (0.05, 0.0, 0.0))) == ACCEPTED
    theta = bench.snapshot.command_theta
    bench.run_until(lambda: bench.mode is Mode.IDLE)
    assert bench.snapshot.command_theta[0] == pytest.approx(theta[0] + 0.1, abs=1e-3)


def test_steps_there_and_back_do_not_drift(bench: Any) -> None:
    """Rounding never adds up: every knot is converted from its absolute position."""
    counts = bench.snapshot.counts
    start = bench.snapshot.command_xyz
    for k in range(40):
        bench.do(i.StepPoint(ME, (0.37 if k % 2 == 0 else -0.37, 0.0, 0.0)))
        bench.run_until(lambda: bench.mode is Mode.IDLE)
    assert bench.snapshot.command_xyz == pytest.approx(start, abs=1e-6)
    assert all(abs(a - b) <= 1 for a, b in zip(bench.snapshot.counts, counts, strict=True))


def test_a_step_out_of_reach_is_refused_and_nothing_moves(bench: Any) -> None:
    refused = bench.do(i.StepPoint(ME, (0.0, 0.0, 500.0)))
    assert refused.kind is i.RefusalKind.VALUE
    bench.run(0.2)
    assert bench.mode is Mode.IDLE
    assert not bench.segments()


def test_a_move_is_straight_and_arrives(bench: Any) -> None:
    x, y, z = bench.snapshot.xyz
    target = (x + 80.0, y - 40.0, z - 30.0)
    assert bench.do(i.MoveToPoint(ME, target, 1.0)) == ACCEPTED
    assert bench.mode is Mode.MOVING
    off: list[float] = []
    length = math.dist((x, y, z), target)

    def look() -> None:
        px, py, pz = bench.snapshot.xyz
        along = [(px - x), (py - y), (pz - z)]
        axis = [(t - s) / length for t, s in zip(target, (x, y, z), strict=True)]
        share = sum(a * b for a, b in zip(along, axis, strict=True))
        off.append(math.dist(along, [share * a for a in axis]))

    for _ in range(40):
        bench.run(0.02)
        look()
    assert bench.mode is Mode.IDLE
    assert max(off) < 0.5
    assert bench.snapshot.xyz == pytest.approx(target, abs=STEP)
    assert bench.snapshot.target_xyz == pytest.approx(target)
    bench.check_limits()


@pytest.mark.parametrize(
    "wish",
    [
        i.MoveToPoint(ME, (0.0, 0.0, -100.0), 1.0),
        i.MoveToPoint(ME, (400.0, 0.0, -300.0), 1.0),
        i.MoveToPoint(ME, (0.0, 0.0, math.nan), 1.0),
        i.MoveToPoint(ME, (0.0, math.inf, -300.0), 1.0),
        i.MoveToPoint(ME, (0.0, 0.0), 1.0),
        i.MoveToPoint(ME, (10.0, 0.0, -300.0), 0.0),
        i.MoveToPoint(ME, (10.0, 0.0, -300.0), 1.1),
        i.MoveToPoint(ME, (10.0, 0.0, -300.0), math.nan),
        i.MoveToAngles(ME, (2.0, 0.0, 0.0), 1.0),
        i.MoveToAngles(ME, (-0.7, 1.5, 1.5), 1.0),
        i.MoveToAngles(ME, (0.0, 0.0), 1.0),
        i.MoveToAngles(ME, (0.0, 0.0, math.nan), 1.0),
        i.FollowPoint(ME, (0.0, math.nan, 0.0)),
        i.FollowAngles(ME, (3.0, 0.0, 0.0)),
        i.SetOverride(ME, 1.6),
        i.SetOverride(ME, -0.1),
        i.SetOverride(ME, math.nan),
    ],
)
def test_what_cannot_be_is_refused_with_a_sentence(bench: Any, wish: i.Intent) -> None:
    refused = bench.do(wish)
    assert isinstance(refused, i.Refused)
    assert refused.kind is i.RefusalKind.VALUE
    assert refused.detail.endswith(".")
    bench.run(0.1)
    assert bench.mode is Mode.IDLE
    assert not bench.segments()


def test_speed_is_a_share(make_bench: Callable[..., Any]) -> None:
    def fastest(speed: float) -> float:
        bench = make_bench()
        x, y, z = bench.snapshot.xyz
        bench.do(i.MoveToPoint(ME, (x + 60.0, y, z), speed))
        speeds: list[float] = []
        while bench.mode is Mode.MOVING:
            bench.run(0.02)
            speeds.append(math.hypot(*bench.snapshot.xyz_speed))
        return max(speeds)

    slow = fastest(0.1)
    assert slow == pytest.approx(60.0, rel=0.1)
    assert fastest(0.3) > 2.5 * slow


def test_the_override_scales_what_is_under_way_and_zero_waits(bench: Any) -> None:
    bench.jog((80.0, 0.0, 0.0), 0.3)
    assert bench.do(i.SetOverride(ME, 0.5)) == ACCEPTED
    bench.hold((80.0, 0.0, 0.0), 0.4)
    assert bench.snapshot.xyz_speed[0] == pytest.approx(40.0, rel=0.2)
    bench.do(i.SetOverride(ME, 0.0))
    bench.hold((80.0, 0.0, 0.0), 0.4)
    assert bench.snapshot.xyz_speed[0] == pytest.approx(0.0, abs=1.0)
    assert bench.mode is Mode.JOGGING
    bench.do(i.SetOverride(ME, 1.5))
    bench.hold((80.0, 0.0, 0.0), 0.4)
    assert bench.snapshot.xyz_speed[0] == pytest.approx(120.0, rel=0.2)
    assert bench.snapshot.override == 1.5
    bench.check_limits()


def test_a_drag_is_followed_and_its_last_target_is_reached(bench: Any) -> None:
    x, y, z = bench.snapshot.xyz
    start_drag(bench)
    for k in range(1, 11):
        bench.do(i.DragTo(ME, (x + 6.0 * k, y, z - k), bench.now))
        drag_alive(bench)
        bench.run(0.05)
    assert bench.mode is Mode.JOGGING
    assert bench.snapshot.target_xyz == pytest.approx((x + 60, y, z - 10))
    assert bench.do(i.DragEnd(ME)) == ACCEPTED
    bench.run_until(lambda: bench.mode is Mode.IDLE)
    assert bench.snapshot.xyz == pytest.approx((x + 60, y, z - 10), abs=STEP)
    assert bench.snapshot.stop_reason is None
    assert isinstance(bench.do(i.DragTo(ME, (x, y, z), bench.now)), i.Refused)
    bench.check_limits()


def test_a_drag_out_of_reach_slides_along_and_says_what_holds_it(bench: Any) -> None:
    x, y, z = bench.snapshot.xyz
    start_drag(bench)
    for _ in range(40):
        bench.do(i.DragTo(ME, (x + 600.0, y, z), bench.now))
        drag_alive(bench)
        bench.run(0.05)
    assert bench.snapshot.xyz[0] > x + 100
    assert bench.snapshot.held_by
    assert bench.robot.reach(bench.snapshot.command_xyz).legal
    bench.check_limits()


def test_a_slider_is_followed(bench: Any) -> None:
    for k in range(1, 11):
        assert bench.do(i.FollowAngles(ME, (0.02 * k, 0.0, 0.0))) == ACCEPTED
        bench.run(0.05)
    bench.run_until(lambda: bench.mode is Mode.IDLE)
    assert bench.snapshot.theta == pytest.approx((0.2, 0.0, 0.0), abs=3e-3)
    x, y, z = bench.snapshot.xyz
    assert bench.do(i.FollowPoint(ME, (x + 10, y, z))) == ACCEPTED
    bench.run_until(lambda: bench.mode is Mode.IDLE)
    assert bench.snapshot.xyz == pytest.approx((x + 10, y, z), abs=STEP)


def test_while_something_is_held_nothing_else_takes_over(bench: Any) -> None:
    bench.jog((30.0, 0.0, 0.0), 0.1)
    for wish in (
        i.StepPoint(ME, (1.0, 0.0, 0.0)),
        i.FollowAngles(ME, (0.0, 0.0, 0.0)),
        i.DragStart(ME, bench.now),
    ):
        assert "let go" in bench.do(wish).detail
    assert bench.snapshot.xyz_speed[0] > 10


def test_a_second_press_replaces_the_first_for_good(bench: Any) -> None:
    bench.jog((50.0, 0.0, 0.0), 0.2)
    bench.jog((0.0, 50.0, 0.0), 0.3, press="q")
    assert isinstance(bench.beat((50.0, 0.0, 0.0), press="p"), i.Refused)
    bench.do(i.JogEnd(ME, "p"))
    bench.hold((0.0, 50.0, 0.0), 0.1, press="q")
    assert bench.mode is Mode.JOGGING
    assert bench.snapshot.xyz_speed[1] > 40


def test_pause_slows_down_and_resume_arrives(bench: Any) -> None:
    x, y, z = bench.snapshot.xyz
    bench.do(i.MoveToPoint(ME, (x + 80, y, z), 0.5))
    bench.run(0.15)
    assert bench.do(i.Pause(ME)) == ACCEPTED
    bench.run(0.3)
    assert bench.mode is Mode.PAUSED
    assert not bench.board.moving
    paused = bench.snapshot.xyz[0]
    assert x + 5 < paused < x + 75
    bench.run(0.5)
    assert bench.snapshot.xyz[0] == paused
    assert bench.do(i.Resume(ME)) == ACCEPTED
    bench.run_until(lambda: bench.mode is Mode.IDLE)
    assert bench.snapshot.xyz == pytest.approx((x + 80, y, z), abs=STEP)
    bench.check_limits()


def test_from_rest_the_first_segment_leaves_in_the_same_turn(bench: Any) -> None:
    bench.run(0.5)
    bench.do(i.JogStart(ME, "1", i.JogFrame.BASE, (50.0, 0.0, 0.0), bench.now))
    bench.run(0.002)
    assert bench.segments()
    bench.run(0.006)
    assert bench.board.moving


def test_no_more_than_the_horizon_is_ever_on_the_board(bench: Any) -> None:
    most = 0.0

    def look() -> None:
        nonlocal most
        telemetry = bench.controller._session.telemetry
        if telemetry.state is m.BoardState.ARMED:
            ahead = (telemetry.t_queue_end - telemetry.now) & 0xFFFF_FFFF
            most = max(most, ahead / 200_000)

    bench.do(i.JogStart(ME, "p", i.JogFrame.BASE, (60.0, 0.0, 0.0), bench.now))
    for _ in range(100):
        bench.beat((60.0, 0.0, 0.0))
        bench.run(0.01)
        look()
    assert 0.04 < most <= 0.075
    assert bench.snapshot.underruns == 0
    assert not any(isinstance(message, m.Refused) for message in bench.heard)


def test_frozen_telemetry_freezes_the_solid_robot_while_the_command_goes_on(bench: Any) -> None:
    """Reported is what the board counted, never what was commanded."""
    bench.jog((60.0, 0.0, 0.0), 0.2)
    seen, commanded = bench.snapshot.xyz, bench.snapshot.command_xyz
    bench.cut = True
    bench.hold((60.0, 0.0, 0.0), 0.06)
    assert bench.snapshot.xyz == seen
    assert bench.snapshot.command_xyz[0] > commanded[0] + 2
