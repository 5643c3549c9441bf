"""What simpler models of a forearm, its mass lumped at its ends, miss of a motion's torques."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from deltaviz.mechanism.arrays import Array
from deltaviz.mechanism.dynamics import Motion, RodModel, torques
from deltaviz.robots.robot import Robot
from deltaviz.robots.torques import OUT_OF_REACH, straight, with_masses


@dataclass(frozen=True)
class Missed:
    """Shares of the exact torques, each an RMS over all arms and the whole motion: of the torques
    themselves, of that part which holds the robot's weight, and of that which accelerates it."""

    share: float
    weight: float
    acceleration: float


def missed(
    robot: Robot,
    start: ArrayLike,
    end: ArrayLike,
    *,
    rods: RodModel,
    duration: float | None = None,
    payload: float = 0.0,
) -> Missed:
    """Of the motion of `torques.crossing`. Raises MassesMissing, and ValueError if the way leaves
    the arms' reach."""
    path, _ = straight(robot, start, end, duration=duration)
    zero = np.zeros_like
    rest = replace(
        path,
        theta_dot=zero(path.theta_dot),
        theta_ddot=zero(path.theta_ddot),
        velocity=zero(path.velocity),
        acceleration=zero(path.acceleration),
    )
    exact, held = (_torques(robot, m, RodModel.UNIFORM, payload) for m in (path, rest))
    if not np.isfinite(exact).all():
        raise ValueError(OUT_OF_REACH)
    lumped, lumped_held = (_torques(robot, m, rods, payload) for m in (path, rest))
    return Missed(
        _off(lumped, exact),
        _off(lumped_held, held),
        _off(lumped - lumped_held, exact - held),  # torques are linear in gravity
    )


def _torques(robot: Robot, motion: Motion, rods: RodModel, payload: float) -> Array:
    mechanism, masses = with_masses(robot)
    return torques(mechanism, masses, motion, payload=payload, rods=rods)


def _off(lumped: Array, exact: Array) -> float:
    return float(np.sqrt(((lumped - exact) ** 2).mean() / (exact**2).mean()))
