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
            _check_vector(intent.theta, robot, "angles")
            _check_joints(intent.theta, robot)
            return Activity(Kind.FOLLOW, client, ToAngles(intent.theta))
        case i.StepPoint():
            _check_vector(intent.xyz, robot, "coordinates")
            goal = _point_step(intent, robot, pose, running)
            return Activity(Kind.STEP, client, goal)
        case i.StepAngles():
            _check_vector(intent.theta, robot, "angles")
            goal = _angle_step(intent, robot, pose, running)
            return Activity(Kind.STEP, client, goal)
        case i.MoveToPoint():
            _check_vector(intent.xyz, robot, "coordinates")
            return Activity(Kind.MOVE, client, _to_point(intent.xyz, intent.speed, robot, pose))
        case i.MoveToAngles():
            _check_vector(intent.theta, robot, "angles")
            goal = _to_angles(intent.theta, intent.speed, robot, pose)
            return Activity(Kind.MOVE, client, goal)


def jog_goal(frame: i.JogFrame, velocity: tuple[float, ...], robot: Robot) -> Goal:
    """Raises BadValue for a velocity of another size, or not finite."""
    _check_vector(velocity, robot, "velocities")
    return AtJointVelocity(velocity) if frame is i.JogFrame.JOINTS else AtVelocity(velocity)


def drag_goal(xyz: tuple[float, ...], robot: Robot) -> Goal:
    """Out of reach is no error: the robot slides along its limits towards it."""
    _check_vector(xyz, robot, "coordinates")
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


def _to_point(xyz: tuple[float, ...], speed: float, robot: Robot, pose: Pose) -> Goal:
    _check_speed(speed)
    reach = robot.reach(xyz)
    if not reach.legal:
        raise BadValue(str(reach))
    on_the_way = check_straight(robot, pose.xyz, xyz)
    if on_the_way is not None:
        raise BadValue(f"{on_the_way}.")
    return ToPoint(xyz, speed=speed, slide=False)


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
    xyz = kernel.forward(way)
    if not np.all(np.abs(kernel.inverse(xyz) - way) < 1e-6):
        return "the arms would have to change over, or the forearms cannot meet"
    margins = kernel.margins(xyz, way)
    _, columns = np.nonzero(margins < np.minimum(margins[0], 0.0) - SLACK)
    return None if len(columns) == 0 else str(robot.margin_names[int(columns[0])])


def _check_vector(values: Sequence[float], robot: Robot, what: str) -> None:
    if len(values) != robot.joint_count:
        raise BadValue(f"{len(values)} {what} given; {robot.name} takes {robot.joint_count}.")
    if not all(map(math.isfinite, values)):
        raise BadValue(f"Values must be finite numbers, not {tuple(values)}.")


def _check_speed(speed: float) -> None:
    if not 0.0 < speed <= 1.0:
        raise BadValue(f"Speed is a share above 0, up to 1, not {speed:g}.")


def _check_joints(theta: Sequence[float], robot: Robot) -> None:
    for joint, angle in enumerate(theta):
        low, high = robot.joints.min[joint], robot.joints.max[joint]
        if not low - 1e-9 <= angle <= high + 1e-9:
            raise BadValue(
                f"Arm {joint + 1} would stand at {math.degrees(angle):.2f}°; its limits are "
                f"{math.degrees(low):g}° and {math.degrees(high):g}°."
            )
