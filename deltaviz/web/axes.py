"""Surfaces always speak three coordinates, in mm and degrees; a robot its own number, in rad."""

from __future__ import annotations

import math
from collections.abc import Sequence

from deltaviz.robots import Robot

PLANAR_JOINTS = 2


class AxesError(ValueError):
    """A number of values, or an axis, that this robot does not have; for a person."""


def to_robot_point(robot: Robot, xyz: Sequence[float], *, field: str) -> tuple[float, ...]:
    """Three coordinates in the robot's own: a planar robot's are (x, z)."""
    if robot.joint_count != PLANAR_JOINTS:
        return tuple(xyz)
    x, y, z = xyz
    if y != 0:
        raise AxesError(f"{field}[1] must be 0: {robot.name} is planar and has no Y; got {y:g}.")
    return (x, z)


def to_robot_angles(robot: Robot, degrees: Sequence[float], *, field: str) -> tuple[float, ...]:
    """Degrees for each joint in radians."""
    if len(degrees) != robot.joint_count:
        raise AxesError(
            f"{field} needs {robot.joint_count} numbers, one for each joint of {robot.name}; "
            f"got {len(degrees)}."
        )
    return tuple(math.radians(angle) for angle in degrees)


def to_surface_point(xyz: Sequence[float]) -> list[float]:
    """Three coordinates, whatever the robot has."""
    if len(xyz) == PLANAR_JOINTS:
        return [float(xyz[0]), 0.0, float(xyz[1])]
    return [float(value) for value in xyz]
