"""What a robot's motors must give: to hold a payload, and for a motion."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from deltaviz.mechanism import FiveBar, RotaryDelta
from deltaviz.mechanism.arrays import Array, rows
from deltaviz.mechanism.dynamics import (
    Motion,
    RodModel,
    holding_torques,
    inverse_motion,
    torques,
)
from deltaviz.mechanism.masses import Masses
from deltaviz.robots.robot import Robot

SAMPLES = 1000  # of a motion
# Of a minimum-jerk motion over a distance d in a time T: largest speed over d/T, and largest
# acceleration over d/T². s = 10 t³ - 15 t⁴ + 6 t⁵.
PEAK_SPEED = 15 / 8
PEAK_ACCELERATION = 10 / np.sqrt(3)


class MassesMissing(ValueError):
    """The robot file does not tell what the parts weigh."""


@dataclass(frozen=True)
class Torques:
    """N m at the arms' shafts, (n,) each, of a motion that takes `duration` s. A motor must give
    `peak` for a moment, and `rms` all day."""

    duration: float
    peak: Array
    rms: Array


def holding(robot: Robot, points: ArrayLike, *, payload: float = 0.0) -> Array:
    """(..., d) tool tips to (..., n) N m at rest, with a payload in kg; NaN out of reach. Raises
    MassesMissing."""
    mechanism, masses = _known(robot)
    centre = rows(points, len(robot.tool_offset), "points") - np.asarray(robot.tool_offset)
    return holding_torques(mechanism, masses, mechanism.inverse(centre), payload=payload)


def crossing(
    robot: Robot,
    start: ArrayLike,
    end: ArrayLike,
    *,
    duration: float | None = None,
    payload: float = 0.0,
    rods: RodModel = RodModel.UNIFORM,
) -> Torques:
    """Of a straight minimum-jerk motion from rest to rest; without `duration` as quick as the
    robot's Cartesian speed and acceleration allow. Raises MassesMissing, and ValueError if the
    way leaves the arms' reach."""
    mechanism, masses = _known(robot)
    path, duration = straight(robot, start, end, duration=duration)
    tau = torques(mechanism, masses, path, payload=payload, rods=rods)
    if not np.isfinite(tau).all():
        raise ValueError("the way leaves what the arms reach")
    return Torques(duration, np.abs(tau).max(axis=0), np.sqrt((tau**2).mean(axis=0)))


def straight(
    robot: Robot, start: ArrayLike, end: ArrayLike, *, duration: float | None = None
) -> tuple[Motion, float]:
    """The motion of `crossing`, at equal steps of time, and how long it takes."""
    mechanism, _ = _known(robot)
    first, last = (rows(p, len(robot.tool_offset), "point") for p in (start, end))
    way = last - first
    if duration is None:
        limits, length = robot.limits.cartesian, float(np.linalg.norm(way))
        by_speed = PEAK_SPEED * length / limits.velocity
        duration = max(by_speed, float(np.sqrt(PEAK_ACCELERATION * length / limits.acceleration)))
    t = np.linspace(0.0, 1.0, SAMPLES)[:, None]
    place = t**3 * (10 - 15 * t + 6 * t**2)
    speed = 30 * t**2 * (1 - t) ** 2 / duration
    change = 60 * t * (1 - t) * (1 - 2 * t) / duration**2
    centre = first - np.asarray(robot.tool_offset) + way * place
    return inverse_motion(mechanism, centre, way * speed, way * change), duration


def _known(robot: Robot) -> tuple[RotaryDelta | FiveBar, Masses]:
    if robot.masses is None or not isinstance(robot.mechanism, RotaryDelta | FiveBar):
        raise MassesMissing(
            f"{robot.name}: torques need the section [masses] in the robot file (see "
            "docs/robot-files.md)"
        )
    return robot.mechanism, robot.masses
