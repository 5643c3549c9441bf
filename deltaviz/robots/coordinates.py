"""Between the three coordinates that surfaces speak and those that a robot has.

A planar robot moves in the plane of X and Z; its Y is 0.
"""

from __future__ import annotations

from collections.abc import Sequence

from deltaviz.robots.robot import Robot

SPACE = ("X", "Y", "Z")
_PLANE = ("X", "Z")


class CoordinateError(ValueError):
    """A place that is not in the robot's plane; the text is for a person."""


def is_planar(robot: Robot) -> bool:
    return "Y" not in robot.axes


def in_robot(robot: Robot, xyz: Sequence[float]) -> tuple[float, ...]:
    """The robot's own of three coordinates. Raises CoordinateError."""
    for axis, value in zip(SPACE, xyz, strict=True):
        if axis not in robot.axes and value != 0:
            raise CoordinateError(f"{axis} must be 0, as {robot.name} is planar; got {value:g}.")
    return tuple(float(value) for axis, value in zip(SPACE, xyz, strict=True) if axis in robot.axes)


def in_space(xyz: Sequence[float]) -> tuple[float, float, float]:
    """Three coordinates, whatever the robot has."""
    own = dict(zip(SPACE if len(xyz) == len(SPACE) else _PLANE, xyz, strict=True))
    x, y, z = (float(own.get(axis, 0.0)) for axis in SPACE)
    return x, y, z
