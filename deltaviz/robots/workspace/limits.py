"""What may end a workspace."""

from __future__ import annotations

from enum import Flag, auto

from deltaviz.robots.robot import Robot


class Limit(Flag):
    """Kinds of limit; a workspace is the set of points that keep those asked for.

    `REACH` always counts: the arms' lengths, and the assembly that the robot works in (below its
    elbows, before the forearms lie flat). `SINGULARITIES` are the reserves that the controller
    keeps from both kinds of singularity. `ZONE` is what the robot file allows the tool tip.
    """

    REACH = auto()
    JOINTS = auto()
    BALL_JOINTS = auto()
    SINGULARITIES = auto()
    COLLISIONS = auto()
    ZONE = auto()

    MACHINE = REACH | JOINTS | BALL_JOINTS | SINGULARITIES | COLLISIONS
    ALL = MACHINE | ZONE


def not_considered(robot: Robot, limits: Limit) -> dict[Limit, str]:
    """Which of these limits count for nothing with a robot, and why."""
    out: dict[Limit, str] = {}
    if Limit.BALL_JOINTS in limits and robot.joints.ball_joint_max is None:
        out[Limit.BALL_JOINTS] = "this kind of robot has none"
    if Limit.COLLISIONS in limits and robot.bodies is None:
        out[Limit.COLLISIONS] = "the robot file has no section [bodies]"
    return out
