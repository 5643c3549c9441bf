"""A robot that homes in two seconds rather than ten."""

from __future__ import annotations

from dataclasses import replace
from math import radians

from deltaviz.robots import Robot


def with_quick_homing(robot: Robot) -> Robot:
    def each(degrees: float) -> tuple[float, ...]:
        return (radians(degrees),) * robot.joint_count

    homing = replace(robot.homing, fast=each(90.0), slow=each(5.0), backoff=each(1.0))
    return replace(robot, homing=homing)
