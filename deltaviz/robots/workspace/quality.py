"""How well a robot moves at each point of its workspace."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import ArrayLike

from deltaviz.mechanism import FiveBar, RotaryDelta
from deltaviz.mechanism.arrays import Array, rows
from deltaviz.mechanism.dexterity import Dexterity
from deltaviz.mechanism.stiffness import planar_stiffness, stiffness, unit
from deltaviz.robots.robot import Robot


@dataclass(frozen=True)
class Quality:
    """Arrays of one shape, NaN where the robot's arms do not reach.

    See `Dexterity` for what the first six mean. `resolution`: mm that the tip moves in the worst
    direction for one microstep (of all joints together, the root of their squares). `type_1`: the
    sine of the angle between upper arm and the line from shoulder to tip, of the arm nearest to
    straight or folded: 0 at a type 1 singularity, 1 at best. `type_2`: how firmly the forearms
    hold the effector, 0 at a type 2 singularity: errors in them show 1/type_2 times as large.
    `joint_margin_deg`: to the nearest joint limit. `ball_joint_deg`: how far the ball joint that
    is tilted most stands out of its arm's plane (0 without ball joints).
    """

    condition: Array
    slowest: Array
    fastest: Array
    stiffness: Array
    least_force: Array
    most_force: Array
    resolution: Array
    type_1: Array
    type_2: Array
    joint_margin_deg: Array
    ball_joint_deg: Array

    @classmethod
    def measures(cls) -> tuple[str, ...]:
        return tuple(field.name for field in fields(cls))


UNITS = {
    "condition": "",
    "slowest": "mm/s per rad/s",
    "fastest": "mm/s per rad/s",
    "stiffness": "N/mm per N m/rad",
    "least_force": "N per N m",
    "most_force": "N per N m",
    "resolution": "mm per microstep",
    "type_1": "",
    "type_2": "",
    "joint_margin_deg": "°",
    "ball_joint_deg": "°",
}

# Which way a measure is worse.
WORSE_ABOVE = {"condition", "fastest", "resolution", "ball_joint_deg"}


def quality(robot: Robot, points: ArrayLike) -> Quality:
    """Of tool tips (..., d) mm; some microseconds each."""
    mechanism = robot.mechanism
    if not isinstance(mechanism, RotaryDelta | FiveBar):
        raise TypeError(f"{robot.name}: the quality of a {type(mechanism).__name__} is not known")
    tip = rows(points, len(robot.tool_offset), "points")
    centre = tip - np.asarray(robot.tool_offset)
    theta = mechanism.inverse(centre)
    jacobian = mechanism.jacobian(theta)
    dexterity = Dexterity.of(jacobian)
    steps = np.asarray(robot.drive.microsteps_per_rad[: mechanism.joints])
    low, high = (
        np.asarray(side[: mechanism.joints]) for side in (robot.joints.min, robot.joints.max)
    )
    return Quality(
        condition=dexterity.condition,
        slowest=dexterity.slowest,
        fastest=dexterity.fastest,
        stiffness=dexterity.stiffness,
        least_force=dexterity.least_force,
        most_force=dexterity.most_force,
        resolution=Dexterity.of(jacobian / steps).fastest,
        type_1=_type_1(mechanism, centre, theta),
        type_2=type_2(mechanism, centre, theta),
        joint_margin_deg=np.degrees(np.minimum(theta - low, high - theta).min(axis=-1)),
        ball_joint_deg=_ball_joint(mechanism, centre) + 0.0 * theta.sum(axis=-1),
    )


def _type_1(mechanism: RotaryDelta | FiveBar, centre: Array, theta: Array) -> Array:
    x, y, z = centre[..., 0], centre[..., 1] if centre.shape[-1] == 3 else 0.0, centre[..., -1]
    each = [arm.discriminant(x, np.asarray(y), z) for arm in mechanism.arms]
    squares = np.maximum(np.stack(each, axis=-1).min(axis=-1), 0.0)
    return np.sqrt(squares) + 0.0 * theta.sum(axis=-1)


def type_2(mechanism: RotaryDelta | FiveBar, centre: Array, theta: Array) -> Array:
    """Of effector's centres (..., d) mm and their joint angles: see `Quality`."""
    forearms = unit(centre[..., None, :] - mechanism.elbows(theta))
    held = stiffness(forearms) if mechanism.joints == 3 else planar_stiffness(forearms)
    return -mechanism.handedness * held


def _ball_joint(mechanism: RotaryDelta | FiveBar, centre: Array) -> Array:
    sideways = np.abs(mechanism.sideways(centre))
    if not sideways.shape[-1]:
        return np.zeros(sideways.shape[:-1])
    sines = np.minimum(sideways / np.asarray(mechanism.forearm), 1.0)
    return np.degrees(np.arcsin(sines.max(axis=-1)))
