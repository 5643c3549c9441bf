"""The rotary delta's arithmetic compiled for the control loop: a few poses, no overhead.

All compiled functions stand in this one file and take every number as an argument, because
numba's cache notices changes of the file that a function stands in, and of no other: neither of
functions that it calls nor of constants that it imports.

`g` is made by `rotary_delta_numbers`. `limits` is a row of numbers, see `TYPE_1_SCALE` and so on.
The formulas are those of `arm`, `rotary_delta` and `stiffness`; tests hold them together.
"""

from __future__ import annotations

import math

import numpy as np

from deltaviz.mechanism.arrays import Array
from deltaviz.mechanism.compiled import compiled

# Columns of the last row of `g`; `rotary_delta_batch_compiled` has the others.
TINY = 3
LEAST_RHO = 4

# Indices into `limits`; each of the first six groups has one number per arm.
TYPE_1_SCALE = 0
JOINT_SCALE = 3
SIDEWAYS_MAX = 6
JOINT_MIN = 9
JOINT_MAX = 12
TYPE_2_SCALE = 15
ROUNDING = 16
BOX = 17  # z, x, y: low and high; NaN for "no limit", then no column
RADIUS = 23
TYPE_1_RESERVE = 24
TYPE_2_RESERVE = 25
LIMITS = 26

Vector = tuple[float, float, float]


@compiled
def _plane(x: float, y: float, g: Array, i: int) -> tuple[float, float]:
    return x * g[i, 3] + y * g[i, 4] - g[i, 0], y * g[i, 3] - x * g[i, 4]


@compiled
def _nearest_angle(x: float, y: float, z: float, g: Array, i: int) -> float:
    p, v = _plane(x, y, g, i)
    upper = g[i, 1]
    k = (p * p + v * v + z * z + (upper * upper - g[i, 2] * g[i, 2])) / (2.0 * upper)
    q = math.sqrt(max(p * p + z * z - k * k, 0.0))
    return math.atan2(-z * k - p * q, p * k - z * q)


@compiled
def _forearm(
    x: float, y: float, z: float, theta: float, g: Array, i: int
) -> tuple[float, float, float, float]:
    """The forearm's vector and jq of one arm."""
    cos, sin = math.cos(theta), math.sin(theta)
    radius = g[i, 0] + g[i, 1] * cos
    sx, sy, sz = x - radius * g[i, 3], y - radius * g[i, 4], z + g[i, 1] * sin
    return sx, sy, sz, -g[i, 1] * ((sx * g[i, 3] + sy * g[i, 4]) * sin + sz * cos)


@compiled
def _cross(ax: float, ay: float, az: float, bx: float, by: float, bz: float) -> Vector:
    return ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx


@compiled
def _stiffness(a: Array, b: Array, c: Array, tiny: float) -> float:
    px, py, pz = _cross(b[0], b[1], b[2], c[0], c[1], c[2])
    qx, qy, qz = _cross(c[0], c[1], c[2], a[0], a[1], a[2])
    rx, ry, rz = _cross(a[0], a[1], a[2], b[0], b[1], b[2])
    norm = px * px + py * py + pz * pz + qx * qx + qy * qy + qz * qz + rx * rx + ry * ry + rz * rz
    return (a[0] * px + a[1] * py + a[2] * pz) / max(math.sqrt(norm), tiny)


@compiled
def _unit(x: float, y: float, z: float, tiny: float) -> Vector:
    length = max(math.sqrt(x * x + y * y + z * z), tiny)
    return x / length, y / length, z / length


@compiled
def _type_1(x: float, y: float, z: float, g: Array, i: int, jq: float) -> float:
    p, v = _plane(x, y, g, i)
    upper = g[i, 1]
    k = (p * p + v * v + z * z + (upper * upper - g[i, 2] * g[i, 2])) / (2.0 * upper)
    value = 1.0 - k * k / max(p * p + z * z, (g[4, LEAST_RHO] * upper) ** 2)
    return value if jq >= 0.0 else -abs(value)


@compiled
def joint_velocity(xyz: Array, theta: Array, velocity: Array, g: Array) -> Array:
    out = np.empty((xyz.shape[0], 3))
    for k in range(xyz.shape[0]):
        x, y, z = xyz[k, 0] - g[3, 0], xyz[k, 1] - g[3, 1], xyz[k, 2] - g[3, 2]
        for i in range(3):
            sx, sy, sz, jq = _forearm(x, y, z, theta[k, i], g, i)
            along = sx * velocity[k, 0] + sy * velocity[k, 1] + sz * velocity[k, 2]
            out[k, i] = along / jq
    return out


@compiled
def tip_velocity(xyz: Array, theta: Array, velocity: Array, g: Array) -> Array:
    out = np.empty((xyz.shape[0], 3))
    for k in range(xyz.shape[0]):
        x, y, z = xyz[k, 0] - g[3, 0], xyz[k, 1] - g[3, 1], xyz[k, 2] - g[3, 2]
        ax, ay, az, aq = _forearm(x, y, z, theta[k, 0], g, 0)
        bx, by, bz, bq = _forearm(x, y, z, theta[k, 1], g, 1)
        cx, cy, cz, cq = _forearm(x, y, z, theta[k, 2], g, 2)
        px, py, pz = _cross(bx, by, bz, cx, cy, cz)
        qx, qy, qz = _cross(cx, cy, cz, ax, ay, az)
        rx, ry, rz = _cross(ax, ay, az, bx, by, bz)
        det = ax * px + ay * py + az * pz
        aq, bq, cq = aq * velocity[k, 0] / det, bq * velocity[k, 1] / det, cq * velocity[k, 2] / det
        out[k, 0] = px * aq + qx * bq + rx * cq
        out[k, 1] = py * aq + qy * bq + ry * cq
        out[k, 2] = pz * aq + qz * bq + rz * cq
    return out


@compiled
def _workspace(row: Array, column: int, tip: Array, limits: Array) -> None:
    for axis in range(3):
        value = tip[(axis + 2) % 3]
        low, high = limits[BOX + 2 * axis], limits[BOX + 2 * axis + 1]
        if not math.isnan(low):
            row[column] = value - low + limits[ROUNDING]
            row[column + 1] = high - value + limits[ROUNDING]
            column += 2
    radius = limits[RADIUS]
    if not math.isnan(radius):
        square = tip[0] * tip[0] + tip[1] * tip[1]
        row[column] = (radius * radius - square) / (2.0 * radius) + limits[ROUNDING]


@compiled
def _margins_of(
    row: Array, tip: Array, theta: Array, g: Array, limits: Array, forearm: Array, couple: Array
) -> None:
    x, y, z = tip[0] - g[3, 0], tip[1] - g[3, 1], tip[2] - g[3, 2]
    rounding = limits[ROUNDING]
    for i in range(3):
        angle = theta[i]
        if math.isnan(angle):
            angle = _nearest_angle(x, y, z, g, i)
        sx, sy, sz, jq = _forearm(x, y, z, angle, g, i)
        ux, uy, uz = _unit(sx, sy, sz, g[4, TINY])
        forearm[i, 0], forearm[i, 1], forearm[i, 2] = ux, uy, uz
        tx, ty, tz = _cross(-g[i, 4], g[i, 3], 0.0, ux, uy, uz)
        couple[i, 0], couple[i, 1], couple[i, 2] = tx, ty, tz
        spare = _type_1(x, y, z, g, i, jq) - limits[TYPE_1_RESERVE]
        row[i] = spare * limits[TYPE_1_SCALE + i] + rounding
        _, v = _plane(x, y, g, i)
        most = limits[SIDEWAYS_MAX + i]
        row[5 + i] = (most * most - v * v) / (2.0 * most) + rounding
        scale = limits[JOINT_SCALE + i]
        row[8 + i] = (angle - limits[JOINT_MIN + i]) * scale + rounding
        row[11 + i] = (limits[JOINT_MAX + i] - angle) * scale + rounding
    held = -g[3, 3] * _stiffness(forearm[0], forearm[1], forearm[2], g[4, TINY])
    row[3] = (held - limits[TYPE_2_RESERVE]) * limits[TYPE_2_SCALE] + rounding
    held = g[3, 3] * _stiffness(couple[0], couple[1], couple[2], g[4, TINY])
    row[4] = (held - limits[TYPE_2_RESERVE]) * limits[TYPE_2_SCALE] + rounding
    _workspace(row, 14, tip, limits)


@compiled
def margins(xyz: Array, theta: Array, g: Array, limits: Array, columns: int) -> Array:
    out = np.empty((xyz.shape[0], columns))
    forearm = np.empty((3, 3))
    couple = np.empty((3, 3))
    for k in range(xyz.shape[0]):
        _margins_of(out[k], xyz[k], theta[k], g, limits, forearm, couple)
    return out
