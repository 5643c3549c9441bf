"""From an intent to an activity: checks the values, and the way, before anything moves."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from deltaviz.machine import intent as i
from deltaviz.machine.activity import Activity, Kind
from deltaviz.machine.transitions import Event
from deltaviz.motion.goal import AtJointVelocity, AtVelocity, Goal, ToAngles, ToPoint
from deltaviz.motion.straight import check_straight
from deltaviz.robots import Robot

MotionIntent = (
    i.JogStart
    | i.DragStart
    | i.FollowPoint
    | i.FollowAngles
    | i.StepPoint
    | i.StepAngles
    | i.MoveToPoint
    | i.MoveToAngles
)
SAMPLE = 0.01  # rad between the poses at which a way of the joints is checked
SLACK = 1e-6  # units of margin: rounding


class BadValue(Exception):
    """What is asked for is out of reach or beyond a limit; the text is for a person."""


@dataclass(frozen=True, slots=True)
class Pose:
    """Where the command stands: tool tip (mm) and joints (rad)."""

    xyz: tuple[float, ...]
    theta: tuple[float, ...]

    @property
    def known(self) -> bool:
        return all(map(math.isfinite, (*self.xyz, *self.theta)))


def event_of(intent: MotionIntent) -> Event:
    match intent:
        case i.JogStart():
            joints = intent.frame is i.JogFrame.JOINTS
            return Event.JOG_JOINTS if joints else Event.JOG
        case i.DragStart():
            return Event.DRAG
        case i.FollowPoint() | i.FollowAngles():
            return Event.FOLLOW
        case i.StepPoint() | i.StepAngles():
            return Event.STEP
        case i.MoveToPoint() | i.MoveToAngles():
            return Event.MOVE


def activity_for(
    intent: MotionIntent, robot: Robot, pose: Pose, running: Activity | None
) -> Activity:
    """What `intent` starts from `pose`, where `running` is under way. Raises BadValue."""
    client = intent.client
    match intent:
        case i.JogStart():
            goal = jog_goal(intent.frame, intent.velocity, robot)
            return Activity(Kind.JOG, client, goal, held=True)
        case i.DragStart():
            return Activity(Kind.DRAG, client, ToPoint(pose.xyz), held=True)
        case i.FollowPoint():
            return Activity(Kind.FOLLOW, client, drag_goal(intent.xyz, robot))
        case i.FollowAngles():
            _check_angles(intent.theta, robot)
            _check_joints(intent.theta, robot)
            return Activity(Kind.FOLLOW, client, ToAngles(intent.theta))
        case i.StepPoint():
            _check_coordinates(intent.xyz, robot)
            goal = _point_step(intent, robot, pose, running)
            return Activity(Kind.STEP, client, goal)
        case i.StepAngles():
            _check_angles(intent.theta, robot)
            goal = _angle_step(intent, robot, pose, running)
            return Activity(Kind.STEP, client, goal)
        case i.MoveToPoint():
            _check_coordinates(intent.xyz, robot)
            goal = _to_point(intent.xyz, intent.speed, robot, pose, tool=intent.tool)
            return Activity(Kind.MOVE, client, goal)
        case i.MoveToAngles():
            _check_angles(intent.theta, robot)
            goal = _to_angles(intent.theta, intent.speed, robot, pose)
            return Activity(Kind.MOVE, client, goal)


def jog_goal(frame: i.JogFrame, velocity: tuple[float, ...], robot: Robot) -> Goal:
    """Raises BadValue for a velocity of another size, or not finite."""
    if frame is i.JogFrame.JOINTS:
        _check_angles(velocity, robot)
        return AtJointVelocity(velocity)
    _check_coordinates(velocity, robot)
    return AtVelocity(velocity)


def drag_goal(xyz: tuple[float, ...], robot: Robot) -> Goal:
    """Out of reach is no error: the robot slides along its limits towards it."""
    _check_coordinates(xyz, robot)
    return ToPoint(xyz)


def _point_step(intent: i.StepPoint, robot: Robot, pose: Pose, running: Activity | None) -> Goal:
    start = pose.xyz
    if running is not None and running.kind is Kind.STEP and isinstance(running.goal, ToPoint):
        start = running.goal.xyz
    target = tuple(a + b for a, b in zip(start, intent.xyz, strict=True))
    return _to_point(target, intent.speed, robot, pose)


def _angle_step(intent: i.StepAngles, robot: Robot, pose: Pose, running: Activity | None) -> Goal:
    start = pose.theta
    if running is not None and running.kind is Kind.STEP and isinstance(running.goal, ToAngles):
        start = running.goal.theta
    target = tuple(a + b for a, b in zip(start, intent.theta, strict=True))
    return _to_angles(target, intent.speed, robot, pose)


def _to_point(
    xyz: tuple[float, ...], speed: float, robot: Robot, pose: Pose, *, tool: float | None = None
) -> Goal:
    _check_speed(speed)
    if tool is not None:
        _check_tool(tool, robot)
    reach = robot.reach(xyz)
    if not reach.legal:
        raise BadValue(str(reach))
    here = pose.theta[-1]
    start, end = robot.pose(pose.xyz, here), robot.pose(xyz, here if tool is None else tool)
    on_the_way = check_straight(robot, start, end)
    if on_the_way is not None:
        raise BadValue(f"{on_the_way}.")
    return ToPoint(xyz, speed=speed, slide=False, tool=tool)


def _to_angles(theta: tuple[float, ...], speed: float, robot: Robot, pose: Pose) -> Goal:
    _check_speed(speed)
    _check_joints(theta, robot)
    on_the_way = _check_way(theta, robot, pose)
    if on_the_way is not None:
        raise BadValue(f"The way there is not free: {on_the_way}.")
    return ToAngles(theta, speed=speed)


def _check_way(theta: tuple[float, ...], robot: Robot, pose: Pose) -> str | None:
    """Why the straight way in joint angles breaks a limit that it does not start outside of."""
    start, end = np.array(pose.theta), np.array(theta)
    count = 2 + math.ceil(float(np.abs(end - start).max()) / SAMPLE)
    way = start + np.linspace(0.0, 1.0, count)[:, None] * (end - start)
    kernel = robot.kernel
    poses = kernel.forward(way)
    if not np.all(np.abs(kernel.inverse(poses) - way) < 1e-6):
        return "the arms would have to change over, or the forearms cannot meet"
    margins = kernel.margins(poses, way)
    _, columns = np.nonzero(margins < np.minimum(margins[0], 0.0) - SLACK)
    return None if len(columns) == 0 else str(robot.margin_names[int(columns[0])])


def _check_angles(values: Sequence[float], robot: Robot) -> None:
    _check_vector(values, robot, "one for each joint", robot.joint_count)


def _check_coordinates(values: Sequence[float], robot: Robot) -> None:
    _check_vector(values, robot, ", ".join(robot.axes), len(robot.axes))


def _check_vector(values: Sequence[float], robot: Robot, what: str, count: int) -> None:
    if len(values) != count:
        raise BadValue(f"{len(values)} numbers given; {robot.name} takes {count}: {what}.")
    if not all(map(math.isfinite, values)):
        raise BadValue(f"Values must be finite numbers, not {tuple(values)}.")


def _check_speed(speed: float) -> None:
    if not 0.0 < speed <= 1.0:
        raise BadValue(f"Speed is a share above 0, up to 1, not {speed:g}.")


def _check_joints(theta: Sequence[float], robot: Robot) -> None:
    arms = robot.mechanism.joints
    for joint, angle in enumerate(theta):
        _check_joint(angle, joint, robot, f"Arm {joint + 1}" if joint < arms else "The tool")


def _check_tool(angle: float, robot: Robot) -> None:
    if not robot.tool_axis:
        raise BadValue(f"{robot.name} has no tool that turns.")
    _check_joint(angle, robot.joint_count - 1, robot, "The tool")


def _check_joint(angle: float, joint: int, robot: Robot, who: str) -> None:
    low, high = robot.joints.min[joint], robot.joints.max[joint]
    if not low - 1e-9 <= angle <= high + 1e-9:
        raise BadValue(
            f"{who} would stand at {math.degrees(angle):.2f}°; its limits are "
            f"{math.degrees(low):g}° and {math.degrees(high):g}°."
        )
