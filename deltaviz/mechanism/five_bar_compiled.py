"""The five-bar's arithmetic compiled for the control loop: a few poses, no overhead.

All compiled functions stand in this one file and take every number as an argument, because
numba's cache notices changes of the file that a function stands in, and of no other.

`g` has 4 rows of 5: for the left and the right arm (offset, upper_arm, forearm, outward, 0), with
outward -1 and +1 in x; then (tool offset x, z, 0, 0, 0); then the tolerances (`EDGE` and so on).
`limits` is a row of numbers, see `TYPE_1_SCALE` and so on. The formulas are those of `arm`,
`five_bar` and `stiffness`; tests hold them together.
"""

from __future__ import annotations

import math

import numpy as np

from deltaviz.mechanism.arrays import Array
from deltaviz.mechanism.compiled import compiled

# Columns of the last row of `g`.
EDGE = 0
MEET = 1
UNDETERMINED = 2
TINY = 3
LEAST_RHO = 4

# Indices into `limits`; each of the first four groups has one number per arm.
TYPE_1_SCALE = 0
JOINT_SCALE = 2
JOINT_MIN = 4
JOINT_MAX = 6
TYPE_2_SCALE = 8
ROUNDING = 9
BOX = 10  # z, x: low and high; NaN for "no limit", then no column
TYPE_1_RESERVE = 14
TYPE_2_RESERVE = 15
LIMITS = 16

OWN_COLUMNS = 7  # of margins, before those of the box

Vector = tuple[float, float]


@compiled
def _k(p: float, z: float, g: Array, i: int) -> float:
    upper = g[i, 1]
    return (p * p + z * z + (upper * upper - g[i, 2] * g[i, 2])) / (2.0 * upper)


@compiled
def _angle(x: float, z: float, g: Array, i: int) -> float:
    p = x * g[i, 3] - g[i, 0]
    k = _k(p, z, g, i)
    root = p * p + z * z - k * k
    total = p * p + z * z + g[i, 1] * g[i, 1] + g[i, 2] * g[i, 2]
    if root < -g[3, EDGE] * abs(k) * total / g[i, 1]:
        return math.nan
    q = math.sqrt(max(root, 0.0))
    return math.atan2(-z * k - p * q, p * k - z * q)


@compiled
def _nearest_angle(x: float, z: float, g: Array, i: int) -> float:
    p = x * g[i, 3] - g[i, 0]
    k = _k(p, z, g, i)
    q = math.sqrt(max(p * p + z * z - k * k, 0.0))
    return math.atan2(-z * k - p * q, p * k - z * q)


@compiled
def _elbow(theta: float, g: Array, i: int) -> Vector:
    return g[i, 3] * (g[i, 0] + g[i, 1] * math.cos(theta)), -g[i, 1] * math.sin(theta)


@compiled
def _forearm(x: float, z: float, theta: float, g: Array, i: int) -> tuple[float, float, float]:
    """The forearm's vector, and jq."""
    ex, ez = _elbow(theta, g, i)
    sx, sz = x - ex, z - ez
    jq = -g[i, 1] * (sx * g[i, 3] * math.sin(theta) + sz * math.cos(theta))
    return sx, sz, jq


@compiled
def _meet(t0: float, t1: float, g: Array) -> Vector:
    lx, lz = _elbow(t0, g, 0)
    rx, rz = _elbow(t1, g, 1)
    dx, dz = rx - lx, rz - lz
    square = dx * dx + dz * dz
    l1, l2 = g[0, 2] * g[0, 2], g[1, 2] * g[1, 2]
    if not square > g[3, UNDETERMINED] * g[3, UNDETERMINED] * l1:
        return math.nan, math.nan
    along = (square + (l1 - l2)) / (2.0 * square)
    height = l1 - along * along * square
    if height < 0.0:
        if height < -g[3, MEET] * (l1 + square):
            return math.nan, math.nan
        height = 0.0
    h = math.sqrt(height / square)
    return lx + along * dx + h * dz, lz + along * dz - h * dx


@compiled
def _type_1(x: float, z: float, g: Array, i: int, jq: float) -> float:
    p = x * g[i, 3] - g[i, 0]
    k = _k(p, z, g, i)
    value = 1.0 - k * k / max(p * p + z * z, (g[3, LEAST_RHO] * g[i, 1]) ** 2)
    return value if jq >= 0.0 else -abs(value)


@compiled
def inverse(xyz: Array, g: Array) -> Array:
    out = np.empty((xyz.shape[0], 2))
    for k in range(xyz.shape[0]):
        x, z = xyz[k, 0] - g[2, 0], xyz[k, 1] - g[2, 1]
        left, right = _angle(x, z, g, 0), _angle(x, z, g, 1)
        spoilt = (left + right) * 0.0
        out[k, 0], out[k, 1] = left + spoilt, right + spoilt
    return out


@compiled
def forward(theta: Array, g: Array) -> Array:
    out = np.empty((theta.shape[0], 2))
    for k in range(theta.shape[0]):
        x, z = _meet(theta[k, 0], theta[k, 1], g)
        out[k, 0], out[k, 1] = x + g[2, 0], z + g[2, 1]
    return out


@compiled
def joint_velocity(xyz: Array, theta: Array, velocity: Array, g: Array) -> Array:
    out = np.empty((xyz.shape[0], 2))
    for k in range(xyz.shape[0]):
        x, z = xyz[k, 0] - g[2, 0], xyz[k, 1] - g[2, 1]
        for i in range(2):
            sx, sz, jq = _forearm(x, z, theta[k, i], g, i)
            out[k, i] = (sx * velocity[k, 0] + sz * velocity[k, 1]) / jq
    return out


@compiled
def tip_velocity(xyz: Array, theta: Array, velocity: Array, g: Array) -> Array:
    out = np.empty((xyz.shape[0], 2))
    for k in range(xyz.shape[0]):
        x, z = xyz[k, 0] - g[2, 0], xyz[k, 1] - g[2, 1]
        lx, lz, lq = _forearm(x, z, theta[k, 0], g, 0)
        rx, rz, rq = _forearm(x, z, theta[k, 1], g, 1)
        det = lx * rz - lz * rx
        lq, rq = lq * velocity[k, 0] / det, rq * velocity[k, 1] / det
        out[k, 0] = rz * lq - lz * rq
        out[k, 1] = lx * rq - rx * lq
    return out


@compiled
def _stiffness(ax: float, az: float, bx: float, bz: float, tiny: float) -> float:
    """Of the unit vectors along two forearms."""
    a = max(math.sqrt(ax * ax + az * az), tiny)
    b = max(math.sqrt(bx * bx + bz * bz), tiny)
    ax, az, bx, bz = ax / a, az / a, bx / b, bz / b
    norm = math.sqrt(ax * ax + az * az + bx * bx + bz * bz)
    return (ax * bz - az * bx) / max(norm, tiny)


@compiled
def _margins_of(row: Array, tip: Array, theta: Array, g: Array, limits: Array) -> None:
    x, z = tip[0] - g[2, 0], tip[1] - g[2, 1]
    rounding = limits[ROUNDING]
    forearm = np.empty((2, 2))
    for i in range(2):
        angle = theta[i]
        if math.isnan(angle):
            angle = _nearest_angle(x, z, g, i)
        sx, sz, jq = _forearm(x, z, angle, g, i)
        forearm[i, 0], forearm[i, 1] = sx, sz
        spare = _type_1(x, z, g, i, jq) - limits[TYPE_1_RESERVE]
        row[i] = spare * limits[TYPE_1_SCALE + i] + rounding
        scale = limits[JOINT_SCALE + i]
        row[3 + i] = (angle - limits[JOINT_MIN + i]) * scale + rounding
        row[5 + i] = (limits[JOINT_MAX + i] - angle) * scale + rounding
    held = -_stiffness(forearm[0, 0], forearm[0, 1], forearm[1, 0], forearm[1, 1], g[3, TINY])
    row[2] = (held - limits[TYPE_2_RESERVE]) * limits[TYPE_2_SCALE] + rounding
    column = OWN_COLUMNS
    for axis in range(2):
        low, high = limits[BOX + 2 * axis], limits[BOX + 2 * axis + 1]
        if not math.isnan(low):
            row[column] = tip[1 - axis] - low + rounding
            row[column + 1] = high - tip[1 - axis] + rounding
            column += 2


@compiled
def margins(xyz: Array, theta: Array, g: Array, limits: Array, columns: int) -> Array:
    out = np.empty((xyz.shape[0], columns))
    for k in range(xyz.shape[0]):
        _margins_of(out[k], xyz[k], theta[k], g, limits)
    return out
