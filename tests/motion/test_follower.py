"""What the follower does for each goal, seen through its knots."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from deltaviz.motion import otg
from deltaviz.motion.follower import Follower
from deltaviz.motion.goal import AtJointVelocity, AtVelocity, Goal, Rest, ToAngles, ToPoint
from deltaviz.motion.knot import Knot
from deltaviz.robots import Robot, load_robot


@pytest.fixture(scope="module")
def robot() -> Robot:
    return load_robot("stm32")


def still() -> float:
    """A clock that never uses a budget up."""
    return 0.0


def make(robot: Robot, xyz: tuple[float, ...] | None = None, **how: Any) -> Follower:
    theta = robot.homing.ready if xyz is None else robot.inverse(xyz)
    return Follower(robot, theta, **{"clock": still, **how})


def follow(follower: Follower, goal: Goal, ticks: int, **how: Any) -> list[Knot]:
    return [follower.step(goal, **how) for _ in range(ticks)]


def until_rest(follower: Follower, goal: Goal, **how: Any) -> list[Knot]:
    knots = [follower.step(goal, **how)]
    while not follower.resting:
        knots.append(follower.step(goal, **how))
        assert len(knots) < 2000
    return knots


def tips(robot: Robot, knots: list[Knot]) -> np.ndarray:
    return robot.forward(np.array([knot.theta for knot in knots]))


def speeds(robot: Robot, knots: list[Knot]) -> np.ndarray:
    theta = np.array([knot.theta for knot in knots])
    rate = np.array([knot.velocity for knot in knots])
    return np.linalg.norm(np.einsum("kij,kj->ki", robot.jacobian(theta), rate), axis=1)


def off_line(points: np.ndarray, start: np.ndarray, end: np.ndarray) -> float:
    ahead = (end - start) / np.linalg.norm(end - start)
    off = points - start - ((points - start) @ ahead)[:, None] * ahead
    return float(np.linalg.norm(off, axis=1).max())


def test_point_is_reached(robot: Robot) -> None:
    follower = make(robot)
    until_rest(follower, ToPoint((80.0, -40.0, -330.0)))
    assert follower.xyz == pytest.approx((80.0, -40.0, -330.0), abs=1e-6)
    assert follower.held_by == ()


def test_angles_are_reached_together(robot: Robot) -> None:
    follower = make(robot)
    knots = until_rest(follower, ToAngles((0.3, -0.1, 0.5)))
    assert follower.theta == pytest.approx((0.3, -0.1, 0.5))
    start = np.asarray(robot.homing.ready)
    shares = (np.array([k.theta for k in knots]) - start) / (np.array([0.3, -0.1, 0.5]) - start)
    assert np.ptp(shares, axis=1).max() < 1e-6


@pytest.mark.parametrize("z", [-440.0, -225.0])
def test_a_point_exactly_at_a_limit_is_reached(robot: Robot, z: float) -> None:
    follower = make(robot)
    until_rest(follower, ToPoint((0.0, 0.0, z), slide=False))
    assert follower.xyz[2] == pytest.approx(z, abs=1e-6)


def test_from_rest_the_way_is_straight_whatever_the_override_does(robot: Robot) -> None:
    start, end = np.array([-120.0, -60.0, -300.0]), np.array([110.0, 90.0, -380.0])
    follower = make(robot, tuple(start))
    goal = ToPoint(tuple(end), slide=False)
    knots: list[Knot] = []
    for override in (1.0, 0.3, 1.5, 0.0, 0.7):
        knots += follow(follower, goal, 12, override=override)
    knots += until_rest(follower, goal)
    assert follower.xyz == pytest.approx(end, abs=1e-6)
    assert off_line(tips(robot, knots), start, end) < 1e-6


def test_override_zero_comes_to_rest_and_waits(robot: Robot) -> None:
    follower = make(robot)
    goal = ToPoint((100.0, 0.0, -300.0))
    follow(follower, goal, 10)
    follow(follower, goal, 40, override=0.0)
    assert follower.resting
    waited = follower.xyz[0]
    assert waited < 99.0
    follow(follower, goal, 20, override=0.0)
    assert follower.xyz[0] == waited
    until_rest(follower, goal, override=1.0)
    assert follower.xyz[0] == pytest.approx(100.0)


@pytest.mark.parametrize(
    ("speed", "override", "share"), [(0.5, 1, 0.5), (0.5, 0.5, 0.25), (1, 1.5, 1)]
)
def test_speed_and_override_scale_the_velocity_up_to_the_limit(
    robot: Robot, speed: float, override: float, share: float
) -> None:
    follower = make(robot, (-130.0, 0.0, -330.0))
    knots = until_rest(follower, ToPoint((130.0, 0.0, -330.0), speed), override=override)
    top = robot.limits.cartesian.velocity
    assert speeds(robot, knots).max() == pytest.approx(share * top, rel=0.02)


def test_a_slow_move_is_planned_in_parts_and_arrives(robot: Robot) -> None:
    follower = make(robot, (-20.0, 0.0, -330.0))
    knots = until_rest(follower, ToPoint((20.0, 0.0, -330.0), 0.01))
    assert follower.xyz[0] == pytest.approx(20.0, abs=1e-6)
    assert speeds(robot, knots).max() == pytest.approx(6.0, rel=0.02)


def test_rest_slows_from_the_very_next_knot_along_the_tangent(robot: Robot) -> None:
    follower = make(robot, (-120.0, 0.0, -330.0))
    follow(follower, ToPoint((120.0, 0.0, -330.0)), 20)
    theta, rate = follower.theta.copy(), follower.velocity.copy()
    before = np.abs(rate).max()
    first = follower.step(Rest())
    assert np.abs(first.velocity).max() < before * 0.95
    until_rest(follower, Rest())
    moved = follower.theta - theta
    assert moved / np.linalg.norm(moved) == pytest.approx(rate / np.linalg.norm(rate), abs=1e-9)
    quickest = np.max(np.abs(rate) / np.asarray(robot.limits.joint.acceleration))
    assert np.linalg.norm(moved) == pytest.approx(np.linalg.norm(rate) * quickest / 2, rel=0.05)


def test_a_jog_keeps_its_velocity_and_its_line(robot: Robot) -> None:
    follower = make(robot, (-150.0, 0.0, -330.0))
    knots = follow(follower, AtVelocity((90.0, 0.0, 0.0)), 150)
    assert speeds(robot, knots)[30:].max() == pytest.approx(90.0, rel=0.01)
    assert speeds(robot, knots)[30:].min() == pytest.approx(90.0, rel=0.01)
    assert (
        off_line(tips(robot, knots), np.array([-150.0, 0, -330]), np.array([0.0, 0, -330])) < 1e-6
    )


def test_letting_go_of_a_jog_slows_under_the_jerk_limit_to_rest(robot: Robot) -> None:
    follower = make(robot)
    follow(follower, AtVelocity((300.0, 0.0, 0.0)), 25)
    knots = until_rest(follower, AtVelocity((0.0, 0.0, 0.0)))
    slowing = np.diff(speeds(robot, knots)) / 0.01
    assert np.abs(slowing).max() <= robot.limits.cartesian.acceleration
    jerk = np.diff(slowing[:-1]) / 0.01
    assert np.abs(jerk).max() <= robot.limits.cartesian.jerk * 1.001
    assert len(knots) < 20


def test_a_jog_into_a_limit_stops_there_and_says_why(robot: Robot) -> None:
    follower = make(robot, (0.0, 0.0, -400.0))
    follow(follower, AtVelocity((0.0, 0.0, -200.0)), 100)
    assert follower.resting
    assert follower.xyz == pytest.approx((0.0, 0.0, -440.0), abs=0.2)
    (held,) = follower.held_by
    assert held.limit == "At the bottom of the workspace (Z -440.0 mm)"
    assert held.way_out == ("+Z",)
    follow(follower, AtVelocity((0.0, 0.0, 50.0)), 20)
    assert follower.held_by == ()


def test_a_joint_jog_into_its_limit_stops_there_and_says_which(robot: Robot) -> None:
    follower = make(robot, (0.0, 0.0, -280.0))
    follow(follower, AtJointVelocity((-1.0, -1.0, -1.0)), 300)
    assert follower.resting
    words = [held.limit for held in follower.held_by]
    assert any("lower limit (-45.0°)" in word for word in words) or any("top" in w for w in words)
    arms = {held.arm for held in follower.held_by}
    assert arms


def test_an_unreachable_target_is_followed_to_the_edge(robot: Robot) -> None:
    follower = make(robot)
    until_rest(follower, ToPoint((400.0, 0.0, -330.0)))
    assert np.hypot(*follower.xyz[:2]) == pytest.approx(230.0, abs=0.5)
    assert [held.limit for held in follower.held_by] == ["At the workspace's radius (230.0 mm)"]
    assert follower.held_by[0].way_out == ("-X",)
    assert follower.target_xyz == pytest.approx((400.0, 0.0, -330.0))


def test_without_slide_an_unreachable_target_moves_nothing(robot: Robot) -> None:
    follower = make(robot)
    knots = follow(follower, ToPoint((400.0, 0.0, -330.0), slide=False), 20)
    assert {knot.theta for knot in knots} == {tuple(robot.homing.ready)}


def test_a_target_that_is_reached_is_not_planned_for(
    robot: Robot, monkeypatch: pytest.MonkeyPatch
) -> None:
    follower = make(robot)
    goal = ToPoint((30.0, 0.0, -300.0))
    until_rest(follower, goal)
    follow(follower, goal, 2)
    calls: list[object] = []
    monkeypatch.setattr(otg.Generator, "__call__", lambda *args: calls.append(args))
    knots = follow(follower, goal, 50)
    assert not calls
    assert {knot.velocity for knot in knots} == {(0.0, 0.0, 0.0)}


def test_a_generator_that_fails_leaves_the_committed_plan(
    robot: Robot, monkeypatch: pytest.MonkeyPatch
) -> None:
    follower = make(robot)
    follow(follower, ToPoint((100.0, 0.0, -300.0)), 10)
    monkeypatch.setattr(otg.Generator, "__call__", lambda *_args: None)
    until_rest(follower, ToPoint((-100.0, 0.0, -300.0)))
    assert follower.xyz == pytest.approx((100.0, 0.0, -300.0), abs=1e-6)


def test_without_time_to_plan_the_committed_plan_goes_on_to_rest(robot: Robot) -> None:
    late = iter(range(10**9))
    clock: list[Callable[[], float]] = [still]
    follower = make(robot, clock=lambda: clock[0]())
    follow(follower, ToPoint((100.0, 0.0, -300.0)), 10)
    clock[0] = lambda: float(next(late))
    until_rest(follower, ToPoint((-100.0, 0.0, -300.0)))
    assert follower.xyz == pytest.approx((100.0, 0.0, -300.0), abs=1e-6)
    follow(follower, ToPoint((-100.0, 0.0, -300.0)), 100)
    assert follower.xyz == pytest.approx((100.0, 0.0, -300.0), abs=1e-6)
    clock[0] = still
    follow(follower, ToPoint((-100.0, 0.0, -300.0)), 150)
    assert follower.xyz == pytest.approx((-100.0, 0.0, -300.0), abs=1e-6)


def test_with_time_for_one_try_in_each_tick_it_still_gets_there(robot: Robot) -> None:
    ticking = iter(range(10**9))
    follower = make(robot, (80.0, 0.0, -300.0), clock=lambda: 0.003 * next(ticking), budget=0.004)
    follow(follower, ToPoint((-80.0, 40.0, -350.0)), 150)  # at full speed it is too fast for arm 1
    assert follower.xyz == pytest.approx((-80.0, 40.0, -350.0), abs=1e-6)


def test_the_same_goals_give_the_same_knots(robot: Robot) -> None:
    goals: list[Goal] = [ToPoint((100.0, 0.0, -300.0)), AtVelocity((0.0, 200.0, 50.0)), Rest()]

    def run() -> list[Knot]:
        follower = make(robot)
        return [follower.step(goal) for goal in goals for _ in range(15)]

    assert run() == run()


@pytest.mark.parametrize("inward", [ToPoint((0.0, 0.0, -330.0)), AtVelocity((0.0, 0.0, 80.0))])
def test_from_outside_its_limits_it_moves_inward(robot: Robot, inward: Goal) -> None:
    follower = make(robot, (0.0, 0.0, -446.0))
    z = tips(robot, follow(follower, inward, 60))[:, 2]
    assert np.all(np.diff(z) >= -1e-9)
    assert z[-1] > -440.0


@pytest.mark.parametrize(
    "outward",
    [
        ToPoint((0.0, 0.0, -455.0)),
        AtVelocity((0.0, 0.0, -80.0)),
        AtVelocity((80.0, 0.0, -20.0)),
        AtJointVelocity((0.3, 0.3, 0.3)),
    ],
)
def test_from_outside_its_limits_it_does_not_move_further_out(robot: Robot, outward: Goal) -> None:
    follower = make(robot, (0.0, 0.0, -446.0))
    z = tips(robot, follow(follower, outward, 60))[:, 2]
    assert z.min() >= -446.0 - 1e-3


@pytest.mark.parametrize(
    "goal",
    [
        ToPoint((np.nan, 0.0, 0.0)),
        ToPoint((0.0, 0.0)),
        AtVelocity((np.inf, 0.0, 0.0)),
        ToAngles((0.0,)),
    ],
)
def test_a_goal_that_is_no_goal_is_refused_and_nothing_changes(robot: Robot, goal: Goal) -> None:
    follower = make(robot)
    follow(follower, ToPoint((60.0, 0.0, -300.0)), 8)
    with pytest.raises(ValueError, match="must have 3 finite values"):
        follower.step(goal)
    until_rest(follower, ToPoint((60.0, 0.0, -300.0)))
    assert follower.xyz == pytest.approx((60.0, 0.0, -300.0), abs=1e-6)


def test_an_override_out_of_range_is_refused(robot: Robot) -> None:
    with pytest.raises(ValueError, match=r"from 0 to 1\.5"):
        make(robot).step(Rest(), override=1.6)
