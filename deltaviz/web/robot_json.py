"""The robot as the pages and programs see it: what it is, what it may do, what else there is."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import asdict, is_dataclass
from typing import Any

from deltaviz.mechanism import Mechanism
from deltaviz.robots import Robot
from deltaviz.robots.coordinates import in_space


def robot_json(robot: Robot, choices: Iterable[str]) -> dict[str, Any]:
    """Lengths in mm, angles in degrees, one entry per joint; null where there is no such limit.

    `choices` are the ids of the robots that may be driven.

    `axes` are the coordinates that it has, of X, Y, Z; with a `tool_axis` the last joint turns
    the tool.
    """
    joint, cartesian = robot.limits.joint, robot.limits.cartesian
    return {
        "name": robot.name,
        "kind": robot.kind,
        "joints": robot.joint_count,
        "axes": list(robot.axes),
        "joint_names": list(robot.joint_names),
        "tool_axis": robot.tool_axis,
        "geometry": {**_geometry(robot.mechanism), "tool_offset": in_space(robot.tool_offset)},
        "workspace": {
            axis: _plain(getattr(robot.zone, axis)) for axis in ("x", "y", "z", "radius")
        },
        "limits": {
            "joint": {
                "min_deg": _degrees(robot.joints.min),
                "max_deg": _degrees(robot.joints.max),
                "ball_joint_max_deg": _ball_joint_max(robot),
                "velocity_deg_s": _degrees(joint.velocity),
                "acceleration_deg_s2": _degrees(joint.acceleration),
                "unhomed_velocity_deg_s": _degrees(joint.unhomed_velocity),
            },
            "cartesian": {
                "velocity": cartesian.velocity,
                "acceleration": cartesian.acceleration,
                "jerk": cartesian.jerk,
            },
        },
        "presets": sorted(choices),
    }


def _geometry(mechanism: Mechanism) -> dict[str, Any]:
    """The mechanism's own fields, which are in mm and degrees as in a robot file."""
    if is_dataclass(mechanism) and not isinstance(mechanism, type):
        return asdict(mechanism)
    return {}


def _ball_joint_max(robot: Robot) -> float | None:
    most = robot.joints.ball_joint_max
    return None if most is None else _degrees([most])[0]


def _plain(value: float | Sequence[float] | None) -> float | list[float] | None:
    return list(value) if isinstance(value, Sequence) else value


def _degrees(angles: Sequence[float]) -> list[float]:
    return [round(math.degrees(angle), 9) + 0.0 for angle in angles]
