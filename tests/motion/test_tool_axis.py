"""A tool that turns: with the tip, without it, and up to its limits."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from deltaviz.motion.follower import Follower
from deltaviz.motion.goal import AtJointVelocity, AtVelocity, Goal, ToAngles, ToPoint
from deltaviz.motion.knot import Knot
from deltaviz.motion.straight import check_straight
from deltaviz.robots import Robot


@pytest.fixture
def follower(tool_robot: Robot) -> Follower:
    return Follower(tool_robot, tool_robot.homing.ready, clock=lambda: 0.0)


def follow(follower: Follower, goal: Goal, ticks: int) -> list[Knot]:
    return [follower.step(goal) for _ in range(ticks)]


def until_rest(follower: Follower, goal: Goal) -> list[Knot]:
    knots = [follower.step(goal)]
    while not follower.resting:
        knots.append(follower.step(goal))
        assert len(knots) < 2000
    return knots


def tips(robot: Robot, knots: list[Knot]) -> np.ndarray:
    return robot.forward(np.array([knot.theta for knot in knots]))


def test_a_straight_move_turns_the_tool_on_the_way(tool_robot: Robot, follower: Follower) -> None:
    start, end = follower.xyz.copy(), np.array([90.0, -60.0, -330.0])
    goal = ToPoint(tuple(end.tolist()), slide=False, tool=2.0)
    knots = until_rest(follower, goal)
    assert follower.theta[3] == pytest.approx(2.0, abs=1e-9)
    assert follower.xyz == pytest.approx(end, abs=1e-6)
    off = np.cross(tips(tool_robot, knots) - start, (end - start) / np.linalg.norm(end - start))
    assert np.abs(off).max() < 1e-6
    turning = [knot.velocity[3] > 0.5 for knot in knots]
    moving = [abs(knot.velocity[0]) > 0.1 for knot in knots]
    assert sum(a and b for a, b in zip(turning, moving, strict=True)) > 10


def test_only_the_tool_turns_when_the_tip_is_there(follower: Follower) -> None:
    xyz = follower.xyz.copy()
    knots = until_rest(follower, ToPoint(tuple(xyz.tolist()), slide=False, tool=-1.0))
    assert follower.theta[3] == pytest.approx(-1.0, abs=1e-9)
    assert np.abs([knot.velocity[:3] for knot in knots]).max() < 1e-6
    assert follower.held_by == ()


@pytest.mark.parametrize(
    "goal", [ToPoint((60.0, 0.0, -320.0)), AtVelocity((100.0, 0.0, 0.0))], ids=["drag", "jog"]
)
def test_what_asks_nothing_of_the_tool_brings_it_to_rest(follower: Follower, goal: Goal) -> None:
    follow(follower, AtJointVelocity((0.0, 0.0, 0.0, 6.0)), 30)
    assert follower.velocity[3] == pytest.approx(6.0, rel=0.02)
    angle = follower.theta[3]
    follow(follower, goal, 25)
    assert abs(follower.velocity[3]) < 1e-9
    stopped = follower.theta[3]
    assert angle < stopped < angle + 0.6, "no jump, and no way back"
    until_rest(follower, goal) if isinstance(goal, ToPoint) else follow(follower, goal, 20)
    assert follower.theta[3] == pytest.approx(stopped, abs=1e-9)
    assert follower.xyz[0] > 20


def test_a_drag_leaves_the_tool_as_it_stands(follower: Follower) -> None:
    until_rest(follower, ToAngles((0.1, 0.1, 0.1, 1.2)))
    for x in range(40):
        follower.step(ToPoint((2.0 * x, 0.0, -320.0)))
    until_rest(follower, ToPoint((80.0, 0.0, -320.0)))
    assert follower.theta[3] == pytest.approx(1.2, abs=1e-9)


def test_a_jog_of_the_tool_ends_at_its_limit_and_says_so(
    tool_robot: Robot, follower: Follower
) -> None:
    xyz = follower.xyz.copy()
    knots = follow(follower, AtJointVelocity((0.0, 0.0, 0.0, 20.0)), 100)
    assert max(knot.velocity[3] for knot in knots) == pytest.approx(math.radians(600), rel=0.02)
    assert follower.theta[3] == pytest.approx(math.radians(175), abs=0.01)
    assert follower.theta[3] <= math.radians(175)
    (held,) = follower.held_by
    assert (held.limit, held.arm, held.way_out) == (
        "Tool at its upper limit (175.0°)",
        3,
        ("-Tool",),
    )
    assert np.abs(tips(tool_robot, knots) - xyz).max() < 1e-6, "the tip stays"
    why = check_straight(tool_robot, tool_robot.pose(xyz, 0.0), tool_robot.pose(xyz, 3.1)) or ""
    assert why.endswith("tool at its upper limit (175.0°)")


@pytest.mark.parametrize(
    "goal",
    [
        ToPoint((0.0, 0.0, -300.0), tool=math.nan),
        ToPoint((0.0, 0.0, -300.0, 1.0)),
        ToAngles((0.0, 0.0, 0.0)),
        AtVelocity((1.0, 0.0, 0.0, 0.0)),
        AtJointVelocity((0.0, 0.0, 0.0)),
    ],
)
def test_goals_that_do_not_fit(follower: Follower, goal: Goal) -> None:
    with pytest.raises(ValueError, match=r"must have|does not turn"):
        follower.step(goal)


def test_a_robot_without_one_turns_no_tool(stm32_follower: Any) -> None:
    with pytest.raises(ValueError, match="does not turn"):
        stm32_follower.step(ToPoint((0.0, 0.0, -300.0), tool=1.0))


@pytest.fixture
def stm32_follower() -> Follower:
    from deltaviz.robots import load_robot

    return Follower(load_robot("stm32"), (0.0, 0.0, 0.0), clock=lambda: 0.0)
