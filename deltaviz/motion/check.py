"""The check of a planned path, exactly as the board will run it: cubics between its knots.

Checked are each cubic's end accelerations and velocity extremum, the tip's velocity and
acceleration at the knots and between them, the margins at every knot, between knots, and along
the brake from every knot. What is only sampled is taken for the parabola through three samples.
A margin that is violated at the start must never get worse: only what leads inward is legal.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from deltaviz.motion.check_compiled import (
    BRAKE_POINTS,
    TANGENT_STEP,
    fill_brakes,
    judge,
    path_points,
    same_branch,
    tip_peaks,
)
from deltaviz.motion.followed import Array, Kernel

AT_KNOTS = 1e-6  # units of margin: rounding
BETWEEN = 0.005  # units of margin (about mm): a cubic between knots of a straight line bulges


class Fault(IntEnum):
    NONE = 0
    PATH = 1
    BRAKE = 2


@dataclass(frozen=True, slots=True)
class Verdict:
    """`fault` says whether the path or a brake from it breaks a margin, `column` which one
    (-1: the arms' branch). The shares are the peaks in parts of their limits."""

    fault: Fault
    column: int
    joint_velocity: float
    joint_acceleration: float
    tip_velocity: float
    tip_acceleration: float

    @property
    def velocity(self) -> float:
        return max(self.joint_velocity, self.tip_velocity)

    @property
    def acceleration(self) -> float:
        return max(self.joint_acceleration, self.tip_acceleration)


class Checker:
    """Checks the paths of one robot. Limits in rad, mm and s."""

    def __init__(
        self,
        kernel: Kernel,
        *,
        velocity: Array,
        acceleration: Array,
        tip_axes: int,
        tip_velocity: float,
        tip_acceleration: float,
    ) -> None:
        self.kernel = kernel
        self.velocity = velocity
        self.acceleration = acceleration
        self.tip_axes = tip_axes
        self.tip_velocity = tip_velocity
        self.tip_acceleration = tip_acceleration

    def __call__(self, theta: Array, rate: Array, pose: Array, duration: float) -> Verdict:
        """Checks the knots (K+1, n), (K+1, n), (K+1, d), each `duration` seconds apart.

        Row 0 is the state already sent; its own brake has been checked before. A path that
        is too fast for the joints is not looked at further.
        """
        kernel, count = self.kernel, len(theta) - 1
        points, middle, turn, peaks = path_points(
            theta, rate, duration, self.velocity, self.acceleration
        )
        if max(peaks) > 1.0:
            return Verdict(Fault.NONE, -1, *peaks, 0.0, 0.0)
        reached = kernel.forward(points)
        sampled = count * (1 + BRAKE_POINTS)
        back = kernel.inverse(reached[:sampled])
        if not same_branch(back[:count], points):
            return Verdict(Fault.PATH, -1, *peaks, 0.0, 0.0)
        if not same_branch(back[count:], points[count:]):
            return Verdict(Fault.BRAKE, -1, *peaks, 0.0, 0.0)
        margins = kernel.margins(
            np.concatenate((pose, reached[:sampled])), np.concatenate((theta, points[:sampled]))
        )
        fault, column = judge(margins, count, AT_KNOTS, BETWEEN)
        tip = kernel.tip_velocity(
            np.concatenate((pose, reached[sampled:], pose[:-1], pose[1:], reached[:count])),
            np.concatenate((theta, points[sampled:], theta[:-1], theta[1:], points[:count])),
            np.concatenate((rate, rate, rate, middle, middle, turn)),
        )
        speed, thrust = tip_peaks(tip, self.tip_axes, count, duration, TANGENT_STEP)
        return Verdict(
            Fault(fault),
            column,
            *peaks,
            speed / self.tip_velocity,
            thrust / self.tip_acceleration,
        )


def brake_points(theta: Array, rate: Array, acceleration: Array) -> Array:
    """Samples of the brakes from each row of theta and rate (K, n): (K * BRAKE_POINTS, n)."""
    result = np.empty((len(theta) * BRAKE_POINTS, theta.shape[1]))
    fill_brakes(theta, rate, acceleration, result)
    return result
