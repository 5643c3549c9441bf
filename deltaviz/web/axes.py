"""Surfaces speak three coordinates and degrees; a robot its own coordinates, and rad."""

from __future__ import annotations

import math
from collections.abc import Sequence

from deltaviz.robots import Robot
from deltaviz.robots.coordinates import CoordinateError, in_robot, is_planar

LEAST_ACROSS = 0.1  # cosine of the view's angle to a plane, below which it looks along it


class AxesError(ValueError):
    """A number of values, or an axis, that this robot does not have; for a person."""


def to_robot_point(robot: Robot, xyz: Sequence[float], *, field: str) -> tuple[float, ...]:
    """Three coordinates in the robot's own: a planar robot's are (x, z)."""
    try:
        return in_robot(robot, xyz)
    except CoordinateError as error:
        raise AxesError(f"{field}: {error}") from None


def to_robot_angles(robot: Robot, degrees: Sequence[float], *, field: str) -> tuple[float, ...]:
    """Degrees for each joint in radians."""
    if len(degrees) != robot.joint_count:
        raise AxesError(
            f"{field} needs {robot.joint_count} numbers, one for each joint of {robot.name}; "
            f"got {len(degrees)}."
        )
    return tuple(math.radians(angle) for angle in degrees)


def from_camera(robot: Robot, xyz: Sequence[float], yaw: float) -> list[float]:
    """A vector of the camera's frame (right, away, up) in the base's, turned about Z by `yaw`
    (rad). For a planar robot right is +X or, seen from behind, -X, whatever the angle."""
    right, away, up = xyz
    cos, sin = math.cos(yaw), math.sin(yaw)
    if not is_planar(robot):
        return [right * cos - away * sin, right * sin + away * cos, up]
    if right and abs(cos) < LEAST_ACROSS:
        raise AxesError(f"The view looks along the plane of {robot.name}; turn it, then press.")
    return [math.copysign(1.0, cos) * right, away, up]
