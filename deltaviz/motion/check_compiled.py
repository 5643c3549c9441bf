"""The check's arithmetic, compiled: no numpy call per pose.

All compiled functions and the numbers they use stand in this one file, because numba's cache
notices changes of the file that a function stands in, and not of those that it calls.
"""

from __future__ import annotations

import numpy as np

from deltaviz.mechanism.compiled import compiled
from deltaviz.motion.followed import Array

BRAKE_SHARE = 0.98  # of the acceleration limit: the rest is for rounding to the board's numbers
SHORTEST_SEGMENT = 0.004  # s; the board takes nothing shorter
BRAKE_POINTS = 4  # samples of each brake, equally far apart
TANGENT_STEP = 1e-4  # s; of the central difference along the tangent
SAME_BRANCH = 1e-6  # rad; how far inverse(forward(theta)) may be from theta


@compiled
def fill_brakes(theta: Array, rate: Array, acceleration: Array, out: Array) -> None:
    count, joints = theta.shape
    for k in range(count):
        time = SHORTEST_SEGMENT
        for i in range(joints):
            time = max(time, abs(rate[k, i]) / (acceleration[i] * BRAKE_SHARE))
        for b in range(BRAKE_POINTS):
            travel = 0.5 * time * (b + 1) / BRAKE_POINTS
            for i in range(joints):
                out[k * BRAKE_POINTS + b, i] = theta[k, i] + rate[k, i] * travel


@compiled
def path_points(
    theta: Array, rate: Array, duration: float, velocity: Array, acceleration: Array
) -> tuple[Array, Array, Array, tuple[float, float]]:
    """Every pose whose tip the check needs, velocities, accelerations, and the cubics' peaks.

    Poses: K middles, K * BRAKE_POINTS of brakes (of rows 1 to K), K+1 ahead along the tangent,
    K+1 behind, and as many of both for the middles. Velocities (K, n): at the middles.
    Accelerations (3K, n): at the first knots, the last ones, the middles. Peaks are shares of the
    limits.
    """
    rows, joints = theta.shape
    count = rows - 1
    brakes = count * BRAKE_POINTS
    points = np.empty((count + brakes + 2 * (rows + count), joints))
    middle = np.empty((count, joints))
    turn = np.empty((3 * count, joints))
    fastest = 0.0
    hardest = 0.0
    for k in range(count):
        for i in range(joints):
            v0 = rate[k, i]
            v1 = rate[k + 1, i]
            mean = (theta[k + 1, i] - theta[k, i]) / duration
            a0 = (6 * mean - 4 * v0 - 2 * v1) / duration
            a1 = (2 * v0 + 4 * v1 - 6 * mean) / duration
            turn[k, i] = a0
            turn[count + k, i] = a1
            turn[2 * count + k, i] = 0.5 * (a0 + a1)
            middle[k, i] = v0 + duration * (3 * a0 + a1) / 8
            peak = max(abs(v0), abs(v1))
            if a0 * a1 < 0:
                u = a0 / (a0 - a1)
                peak = max(peak, abs(v0 + duration * u * (a0 + 0.5 * (a1 - a0) * u)))
            fastest = max(fastest, peak / velocity[i])
            hardest = max(hardest, max(abs(a0), abs(a1)) / acceleration[i])
            points[k, i] = 0.5 * (theta[k, i] + theta[k + 1, i]) + duration / 8 * (v0 - v1)
    fill_brakes(theta[1:], rate[1:], acceleration, points[count : count + brakes])
    base = count + brakes
    for k in range(rows):
        for i in range(joints):
            points[base + k, i] = theta[k, i] + TANGENT_STEP * rate[k, i]
            points[base + rows + k, i] = theta[k, i] - TANGENT_STEP * rate[k, i]
    base += 2 * rows
    for k in range(count):
        for i in range(joints):
            points[base + k, i] = points[k, i] + TANGENT_STEP * middle[k, i]
            points[base + count + k, i] = points[k, i] - TANGENT_STEP * middle[k, i]
    return points, middle, turn, (fastest, hardest)


@compiled
def same_branch(back: Array, points: Array) -> bool:
    for k in range(back.shape[0]):
        for i in range(back.shape[1]):
            if not abs(back[k, i] - points[k, i]) < SAME_BRANCH:
                return False
    return True


@compiled
def lowest(left: float, middle: float, right: float) -> float:
    """The least value of the parabola through three equally spaced samples."""
    least = min(left, min(middle, right))
    bend = 2 * (left - 2 * middle + right)
    if bend > 0:
        slope = right - left - bend
        at = -slope / (2 * bend)
        if 0 < at < 1:
            least = min(least, left - slope * slope / (4 * bend))
    return least


@compiled
def judge(margins: Array, count: int, at_knots: float, between: float) -> tuple[int, int]:
    """(fault, column) of the rows: count+1 knots, count middles, then the brakes' samples."""
    columns = margins.shape[1]
    rows = count + 1
    for k in range(count):
        for c in range(columns):
            here = margins[k, c]
            there = margins[k + 1, c]
            floor = min(0.0, here)
            if not there >= floor - at_knots:
                return 1, c
            if not lowest(here, margins[rows + k, c], there) >= floor - between:
                return 1, c
    for k in range(count):
        base = rows + count + k * BRAKE_POINTS
        for c in range(columns):
            start = margins[k + 1, c]
            floor = min(0.0, start) - between
            for b in range(0, BRAKE_POINTS, 2):
                if not lowest(start, margins[base + b, c], margins[base + b + 1, c]) >= floor:
                    return 2, c
                start = margins[base + b + 1, c]
    return 0, -1


@compiled
def first_bad_brake(margins: Array, between: float) -> int:
    """The first column that one brake breaks, or -1. Rows: its start, then its samples."""
    for c in range(margins.shape[1]):
        floor = min(0.0, margins[0, c]) - between
        for b in range(0, BRAKE_POINTS, 2):
            if not lowest(margins[b, c], margins[b + 1, c], margins[b + 2, c]) >= floor:
                return c
    return -1


@compiled
def thrust(tip: Array, axes: int, push: int, ahead: int, behind: int, step: float) -> float:
    """The tip's acceleration: what the joints' gives, and what their velocities bend."""
    square = 0.0
    for i in range(axes):
        bent = (tip[ahead, i] - tip[behind, i]) / (2 * step)
        square += (tip[push, i] + bent) ** 2
    return np.sqrt(square)


@compiled
def tip_peaks(
    tip: Array, axes: int, count: int, duration: float, step: float
) -> tuple[float, float]:
    """The tip's largest speed and acceleration (norms over its `axes`).

    Rows: velocities at the K+1 knots, ahead of them, behind them, ahead of the K middles, behind
    them; then the accelerations of the K cubics mapped by the Jacobian, at their first and last
    knots and their middles. Where the speed rises at the one end of a segment and falls at the
    other, it has its peak between; the acceleration's is that of the parabola through three.
    """
    rows = count + 1
    middles = 3 * rows
    pushes = middles + 2 * count
    fastest = 0.0
    hardest = 0.0
    speed = np.zeros(2)
    slope = np.zeros(2)
    force = np.zeros(2)
    for k in range(count):
        for end in range(2):
            knot = k + end
            push = pushes + end * count + k
            force[end] = thrust(tip, axes, push, rows + knot, 2 * rows + knot, step)
            square = 0.0
            along = 0.0
            for i in range(axes):
                bent = (tip[rows + knot, i] - tip[2 * rows + knot, i]) / (2 * step)
                square += tip[knot, i] * tip[knot, i]
                along += (tip[push, i] + bent) * tip[knot, i]
            speed[end] = np.sqrt(square)
            slope[end] = along / speed[end] if square > 0.0 else 0.0
            fastest = max(fastest, speed[end])
        between = thrust(tip, axes, pushes + 2 * count + k, middles + k, middles + count + k, step)
        hardest = max(hardest, -lowest(-force[0], -between, -force[1]))
        if slope[0] > 0.0 and slope[1] < 0.0:
            half = 0.5 * duration / (slope[0] - slope[1])
            for end in range(2):
                fastest = max(fastest, speed[end] + slope[end] * slope[end] * half)
    return fastest, hardest
