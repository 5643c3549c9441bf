"""The rotary delta's arithmetic compiled for the control loop: a few poses, no overhead.

All compiled functions stand in this one file, because numba's cache notices changes of the file
that a function stands in, and not of those that it calls.

`g` has 4 rows of 5: for each arm (offset, upper_arm, forearm, cos, sin of its azimuth), then
(tool offset x, y, z, handedness, 0). `limits` is a structure of numbers, see `LIMITS`. The
formulas are those of `arm`, `rotary_delta` and `stiffness`; tests hold them together.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from deltaviz.mechanism.arm import EDGE_ROUNDING, EPS
from deltaviz.mechanism.rotary_delta import UNDETERMINED
from deltaviz.mechanism.stiffness import TINY, TYPE_1_RESERVE, TYPE_2_RESERVE

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
LIMITS = 24


@njit(cache=True, error_model="numpy")
def _plane(x, y, g, i):
    return x * g[i, 3] + y * g[i, 4] - g[i, 0], y * g[i, 3] - x * g[i, 4]


@njit(cache=True, error_model="numpy")
def _angle(x, y, z, g, i, clamp):
    p, v = _plane(x, y, g, i)
    upper = g[i, 1]
    point = p * p + v * v + z * z
    k = (point + (upper * upper - g[i, 2] * g[i, 2])) / (2.0 * upper)
    square = p * p + z * z - k * k
    if square < 0.0:
        edge = EDGE_ROUNDING * abs(k) * (point + upper * upper + g[i, 2] * g[i, 2]) / upper
        if not clamp and square < -edge:
            return math.nan
        square = 0.0
    q = math.sqrt(square)
    return math.atan2(-z * k - p * q, p * k - z * q)


@njit(cache=True, error_model="numpy")
def _forearm(x, y, z, theta, g, i):
    """The forearm's vector and jq of one arm."""
    cos, sin = math.cos(theta), math.sin(theta)
    radius = g[i, 0] + g[i, 1] * cos
    sx, sy, sz = x - radius * g[i, 3], y - radius * g[i, 4], z + g[i, 1] * sin
    return sx, sy, sz, -g[i, 1] * ((sx * g[i, 3] + sy * g[i, 4]) * sin + sz * cos)


@njit(cache=True, error_model="numpy")
def _cross(ax, ay, az, bx, by, bz):
    return ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx


@njit(cache=True, error_model="numpy")
def _elbow(theta, g, i):
    radius = g[i, 0] + g[i, 1] * math.cos(theta)
    return radius * g[i, 3], radius * g[i, 4], -g[i, 1] * math.sin(theta)


@njit(cache=True, error_model="numpy")
def _meet(t0, t1, t2, g):
    dx, dy, dz = _elbow(t0, g, 0)
    ax, ay, az = _elbow(t1, g, 1)
    bx, by, bz = _elbow(t2, g, 2)
    ax, ay, az = ax - dx, ay - dy, az - dz
    bx, by, bz = bx - dx, by - dy, bz - dz
    nx, ny, nz = _cross(ax, ay, az, bx, by, bz)
    square = nx * nx + ny * ny + nz * nz
    l1, l2, l3 = g[0, 2] * g[0, 2], g[1, 2] * g[1, 2], g[2, 2] * g[2, 2]
    if not square > (UNDETERMINED * l1) ** 2:
        return math.nan, math.nan, math.nan
    along_a = (ax * ax + ay * ay + az * az + (l1 - l2)) / (2.0 * square)
    along_b = (bx * bx + by * by + bz * bz + (l1 - l3)) / (2.0 * square)
    ux, uy, uz = _cross(bx, by, bz, nx, ny, nz)
    vx, vy, vz = _cross(nx, ny, nz, ax, ay, az)
    wx, wy, wz = (
        along_a * ux + along_b * vx,
        along_a * uy + along_b * vy,
        along_a * uz + along_b * vz,
    )
    height = l1 - (wx * wx + wy * wy + wz * wz)
    if height < 0.0:
        if height < -16.0 * EPS * l1:
            return math.nan, math.nan, math.nan
        height = 0.0
    h = g[3, 3] * math.sqrt(height / square)
    return dx + wx - nx * h, dy + wy - ny * h, dz + wz - nz * h


@njit(cache=True, error_model="numpy")
def _stiffness(a, b, c):
    px, py, pz = _cross(b[0], b[1], b[2], c[0], c[1], c[2])
    qx, qy, qz = _cross(c[0], c[1], c[2], a[0], a[1], a[2])
    rx, ry, rz = _cross(a[0], a[1], a[2], b[0], b[1], b[2])
    norm = px * px + py * py + pz * pz + qx * qx + qy * qy + qz * qz + rx * rx + ry * ry + rz * rz
    return (a[0] * px + a[1] * py + a[2] * pz) / max(math.sqrt(norm), TINY)


@njit(cache=True, error_model="numpy")
def _unit(x, y, z):
    length = max(math.sqrt(x * x + y * y + z * z), TINY)
    return x / length, y / length, z / length


@njit(cache=True, error_model="numpy")
def _type_1(x, y, z, g, i, jq):
    p, v = _plane(x, y, g, i)
    upper = g[i, 1]
    k = (p * p + v * v + z * z + (upper * upper - g[i, 2] * g[i, 2])) / (2.0 * upper)
    value = 1.0 - k * k / max(p * p + z * z, (1e-3 * upper) ** 2)
    return value if jq >= 0.0 else -abs(value)


@njit(cache=True, error_model="numpy")
def inverse(xyz, g):
    out = np.empty((xyz.shape[0], 3))
    for k in range(xyz.shape[0]):
        x, y, z = xyz[k, 0] - g[3, 0], xyz[k, 1] - g[3, 1], xyz[k, 2] - g[3, 2]
        a = _angle(x, y, z, g, 0, False)
        b = _angle(x, y, z, g, 1, False)
        c = _angle(x, y, z, g, 2, False)
        if math.isnan(a + b + c):
            a = b = c = math.nan
        out[k, 0], out[k, 1], out[k, 2] = a, b, c
    return out


@njit(cache=True, error_model="numpy")
def forward(theta, g):
    out = np.empty((theta.shape[0], 3))
    for k in range(theta.shape[0]):
        x, y, z = _meet(theta[k, 0], theta[k, 1], theta[k, 2], g)
        out[k, 0], out[k, 1], out[k, 2] = x + g[3, 0], y + g[3, 1], z + g[3, 2]
    return out


@njit(cache=True, error_model="numpy")
def joint_velocity(xyz, theta, velocity, g):
    out = np.empty((xyz.shape[0], 3))
    for k in range(xyz.shape[0]):
        x, y, z = xyz[k, 0] - g[3, 0], xyz[k, 1] - g[3, 1], xyz[k, 2] - g[3, 2]
        for i in range(3):
            sx, sy, sz, jq = _forearm(x, y, z, theta[k, i], g, i)
            along = sx * velocity[k, 0] + sy * velocity[k, 1] + sz * velocity[k, 2]
            out[k, i] = along / jq
    return out


@njit(cache=True, error_model="numpy")
def tip_velocity(xyz, theta, velocity, g):
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


@njit(cache=True, error_model="numpy")
def _workspace(row, column, tip, limits):
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


@njit(cache=True, error_model="numpy")
def _margins_of(row, tip, theta, g, limits, forearm, couple):
    x, y, z = tip[0] - g[3, 0], tip[1] - g[3, 1], tip[2] - g[3, 2]
    rounding = limits[ROUNDING]
    for i in range(3):
        angle = theta[i]
        if math.isnan(angle):
            angle = _angle(x, y, z, g, i, True)
        sx, sy, sz, jq = _forearm(x, y, z, angle, g, i)
        ux, uy, uz = _unit(sx, sy, sz)
        forearm[i, 0], forearm[i, 1], forearm[i, 2] = ux, uy, uz
        tx, ty, tz = _cross(-g[i, 4], g[i, 3], 0.0, ux, uy, uz)
        couple[i, 0], couple[i, 1], couple[i, 2] = tx, ty, tz
        spare = _type_1(x, y, z, g, i, jq) - TYPE_1_RESERVE
        row[i] = spare * limits[TYPE_1_SCALE + i] + rounding
        _, v = _plane(x, y, g, i)
        most = limits[SIDEWAYS_MAX + i]
        row[5 + i] = (most * most - v * v) / (2.0 * most) + rounding
        scale = limits[JOINT_SCALE + i]
        row[8 + i] = (angle - limits[JOINT_MIN + i]) * scale + rounding
        row[11 + i] = (limits[JOINT_MAX + i] - angle) * scale + rounding
    held = -g[3, 3] * _stiffness(forearm[0], forearm[1], forearm[2])
    row[3] = (held - TYPE_2_RESERVE) * limits[TYPE_2_SCALE] + rounding
    held = g[3, 3] * _stiffness(couple[0], couple[1], couple[2])
    row[4] = (held - TYPE_2_RESERVE) * limits[TYPE_2_SCALE] + rounding
    _workspace(row, 14, tip, limits)


@njit(cache=True, error_model="numpy")
def margins(xyz, theta, g, limits, columns):
    out = np.empty((xyz.shape[0], columns))
    forearm = np.empty((3, 3))
    couple = np.empty((3, 3))
    for k in range(xyz.shape[0]):
        _margins_of(out[k], xyz[k], theta[k], g, limits, forearm, couple)
    return out
