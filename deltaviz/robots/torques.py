"""What a robot's motors must give: to hold a payload, and for a motion."""

from __future__ import annotations

from collections.abc import Callable
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
OUT_OF_REACH = "the way leaves what the arms reach"


class MassesMissing(ValueError):
    """The robot file does not tell what the parts weigh."""


@dataclass(frozen=True)
class Torques:
    """N m at the arms' shafts, (n,) each, of a motion that takes `duration` s. A motor must give
    `peak` for a moment, and `rms` all day; `fastest` are the joints' largest speeds, rad/s."""

    duration: float
    peak: Array
    rms: Array
    fastest: Array


def holding(robot: Robot, points: ArrayLike, *, payload: float = 0.0) -> Array:
    """(..., d) tool tips to (..., n) N m at rest, with a payload in kg; NaN out of reach. Raises
    MassesMissing."""
    mechanism, masses = with_masses(robot)
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
    robot's limits of speed and acceleration allow, the tool tip's and the joints'. Raises
    MassesMissing, and ValueError if the way leaves the arms' reach or the robot's limits."""
    mechanism, masses = with_masses(robot)
    path, duration = straight(robot, start, end, duration=duration)
    _check_way(robot, path)
    tau = torques(mechanism, masses, path, payload=payload, rods=rods)
    if not np.isfinite(tau).all():
        raise ValueError(OUT_OF_REACH)
    return Torques(
        duration,
        peak=np.abs(tau).max(axis=0),
        rms=np.sqrt((tau**2).mean(axis=0)),
        fastest=np.abs(path.theta_dot).max(axis=0),
    )


def straight(
    robot: Robot, start: ArrayLike, end: ArrayLike, *, duration: float | None = None
) -> tuple[Motion, float]:
    """The motion of `crossing`, at equal steps of time, and how long it takes."""
    mechanism, _ = with_masses(robot)
    first, last = (rows(p, len(robot.tool_offset), "point") for p in (start, end))
    way = last - first
    t = np.linspace(0.0, 1.0, SAMPLES)[:, None]
    place = t**3 * (10 - 15 * t + 6 * t**2)
    speed = 30 * t**2 * (1 - t) ** 2
    change = 60 * t * (1 - t) * (1 - 2 * t)
    centre = first - np.asarray(robot.tool_offset) + way * place

    def lasting(seconds: float) -> Motion:
        return inverse_motion(mechanism, centre, way * speed / seconds, way * change / seconds**2)

    if duration is None:
        duration = _shortest(robot, float(np.linalg.norm(way)), lasting)
    return lasting(duration), duration


def _shortest(robot: Robot, length: float, lasting: Callable[[float], Motion]) -> float:
    """s; the joints' speeds fall with the duration, their accelerations with its square."""
    tip, joint, n = robot.limits.cartesian, robot.limits.joint, robot.mechanism.joints
    by_tip = max(
        PEAK_SPEED * length / tip.velocity,
        float(np.sqrt(PEAK_ACCELERATION * length / tip.acceleration)),
    )
    if by_tip == 0:
        return by_tip
    motion = lasting(by_tip)
    speed = np.abs(motion.theta_dot) / np.asarray(joint.velocity[:n])
    change = np.abs(motion.theta_ddot) / np.asarray(joint.acceleration[:n])
    over = np.fmax.reduce([*speed.ravel(), *np.sqrt(change).ravel(), 1.0])
    return by_tip * float(over)


def _check_way(robot: Robot, path: Motion) -> None:
    """Raises ValueError, with the limit that is exceeded most and where."""
    tip = path.position + np.asarray(robot.tool_offset)
    angles = robot.inverse(tip)
    if not np.isfinite(angles).all():
        raise ValueError(OUT_OF_REACH)
    margins = robot.margins(tip, angles)
    if (margins >= 0).all():
        return
    worst = int(margins.min(axis=1).argmin())
    place = ", ".join(f"{v:.1f}" for v in tip[worst].tolist())
    name = robot.margin_names[int(margins[worst].argmin())]
    raise ValueError(f"the way leaves the limits, most at ({place}) mm: {name}")


def with_masses(robot: Robot) -> tuple[RotaryDelta | FiveBar, Masses]:
    """The mechanism and what its parts weigh. Raises MassesMissing."""
    if robot.masses is None or not isinstance(robot.mechanism, RotaryDelta | FiveBar):
        raise MassesMissing(
            f"{robot.name}: torques need the section [masses] in the robot file (see "
            "docs/robot-files.md)"
        )
    return robot.mechanism, robot.masses
