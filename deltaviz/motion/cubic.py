"""The cubic that the board runs between two knots: Hermite, by both ends' angle and velocity.

For one segment of duration T with mean velocity D = (theta1 - theta0)/T the acceleration is
linear in time, so its extrema are at the ends, and the velocity is a parabola.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from deltaviz.motion.followed import Array


def end_accelerations(
    theta0: Array, rate0: Array, theta1: Array, rate1: Array, duration: ArrayLike
) -> tuple[Array, Array]:
    """Accelerations (rad/s²) at both ends of each segment.

    Shapes broadcast: theta and rate (..., n), `duration` (...) or (..., 1) in s, above 0.
    """
    time = _column(duration, theta1)
    mean = (theta1 - theta0) / time
    return (6 * mean - 4 * rate0 - 2 * rate1) / time, (2 * rate0 + 4 * rate1 - 6 * mean) / time


def peak_velocity(
    theta0: Array, rate0: Array, theta1: Array, rate1: Array, duration: ArrayLike
) -> Array:
    """The largest |velocity| (rad/s) within each segment, ends included. Shape (..., n)."""
    time = _column(duration, theta1)
    first, last = end_accelerations(theta0, rate0, theta1, rate1, duration)
    peak = np.maximum(np.abs(rate0), np.abs(rate1))
    turns = first * last < 0
    at = np.where(turns, first / np.where(turns, first - last, 1.0), 0.0)
    extremum = rate0 + time * (first * at + 0.5 * (last - first) * at * at)
    return np.where(turns, np.maximum(peak, np.abs(extremum)), peak)


def sample(
    theta0: Array, rate0: Array, theta1: Array, rate1: Array, duration: float, share: ArrayLike
) -> tuple[Array, Array, Array]:
    """Angle, velocity and acceleration at shares (0 to 1) of one segment's time.

    theta and rate (n,), `share` (k,); each result (k, n).
    """
    at = np.asarray(share, dtype=float)[..., None]
    first, last = end_accelerations(theta0, rate0, theta1, rate1, duration)
    time = at * duration
    slope = (last - first) / duration
    theta = theta0 + time * (rate0 + time * (first / 2 + time * slope / 6))
    return theta, rate0 + time * (first + time * slope / 2), first + time * slope


def _column(duration: ArrayLike, like: Array) -> Array:
    time = np.asarray(duration, dtype=float)
    return time[..., None] if 0 < time.ndim < like.ndim else time
