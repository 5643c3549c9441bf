"""Distances between the parts of a robot, each a capsule: a line with a radius.

A row of `capsules` is two ends and a radius; an end is what it is fixed to (`BASE`, `EFFECTOR`, or
`ELBOW` + arm) and its place from there: from the base's centre, the effector's, or the elbow
moved inward by the effector's radius. `pairs` names the capsules that must not touch. `arms` and
`rest` are those of `margins_compiled`; all that one compiled function calls stands in this file.

While the effector moves by 1 mm, an elbow moves by at most l/q, see `margins_compiled`; so how
fast two capsules come nearer is bounded.

That bound is too wide for a rod and its own upper arm, which are near each other everywhere. They
hang on one elbow, h apart: their lines pass each other at a distance of h q/√(q² + v²), which
bounds it from below; and one turns against the other by at most (1 + l/q)/l + (l/q)/L a mm, which
bounds how far the place where they are nearest moves.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from deltaviz.mechanism.arrays import Array
from deltaviz.mechanism.compiled import compiled_loop

BASE = 0
EFFECTOR = 1
ELBOW = 2

# Columns of `capsules`.
FROM = 0  # fixed to, x, y, z
TO = 4
RADIUS = 8
CAPSULE = 9

# As in `margins_compiled`.
OFFSET = 0
UPPER = 1
FORE = 2
COS = 3
SIN = 4
TOOL = 0
ROUNDING = 7

# Columns of `pairs`.
HINGED = 2  # 1 for an upper arm and its own rod, in this order

# Rows of `elbows`: x, y, z, and over a ball
SPEED = 3  # at most l/q
LEAST_Q = 4
MOST_V = 5
ELBOW_ROWS = 6

TINY = 1e-12
BLOCK = 64  # points whose capsules stay in the nearest cache


@compiled_loop
def _elbows(points: Array, radius: Array, size: int, arms: Array, i: int, out: Array) -> None:
    """Rows x, y, z; a bound on how the elbow moves while the effector moves by 1 within a ball,
    infinite where the arm does not reach all of it; and the least q and largest v there."""
    offset, upper, fore = arms[i, OFFSET], arms[i, UPPER], arms[i, FORE]
    cos, sin = arms[i, COS], arms[i, SIN]
    xs, ys, zs = points[0], points[1], points[2]
    ex, ey, ez, speed = out[0], out[1], out[2], out[SPEED]
    least_q, most_v = out[LEAST_Q], out[MOST_V]
    for j in range(size):
        z = zs[j]
        p = xs[j] * cos + ys[j] * sin - offset
        v = ys[j] * cos - xs[j] * sin
        rho = math.sqrt(p * p + z * z)
        k = (rho * rho + v * v + (upper * upper - fore * fore)) * (0.5 / upper)
        q = math.sqrt(max(rho * rho - k * k, 0.0))
        scale = 1.0 / max(rho * max(rho, abs(k)), TINY)
        outward = offset + upper * (p * k - z * q) * scale
        ex[j], ey[j], ez[j] = outward * cos, outward * sin, upper * (z * k + p * q) * scale
        inner, outer = rho - upper, rho + upper
        nearest = math.sqrt(inner * inner + v * v) + radius[j]
        farthest = math.sqrt(outer * outer + v * v) - radius[j]
        square = (fore * fore - nearest * nearest) * (farthest * farthest - fore * fore)
        reaches = nearest < fore and farthest > fore
        least = math.sqrt(max(square, TINY)) / (2.0 * upper)
        speed[j] = fore / least if reaches else math.inf
        least_q[j] = least if reaches else 0.0
        most_v[j] = abs(v) + radius[j]


@compiled_loop
def _place(end: Array, points: Array, size: int, elbows: Array, out: Array) -> None:
    """Rows x, y, z of one end of a capsule, and how fast it may move."""
    to = int(end[0])
    for axis in range(3):
        row, fixed = out[axis], end[1 + axis]
        for j in range(size):
            row[j] = fixed
        if to == EFFECTOR:
            moved = points[axis]
            for j in range(size):
                row[j] += moved[j]
        elif to >= ELBOW:
            moved = elbows[to - ELBOW, axis]
            for j in range(size):
                row[j] += moved[j]
    speed = out[3]
    for j in range(size):
        speed[j] = 0.0 if to == BASE else 1.0
    if to >= ELBOW:
        moved = elbows[to - ELBOW, SPEED]
        for j in range(size):
            speed[j] = moved[j]


@compiled_loop
def _segment_distance(
    ax: float, ay: float, az: float, bx: float, by: float, bz: float,
    cx: float, cy: float, cz: float, dx: float, dy: float, dz: float,
) -> tuple[float, float]:  # fmt: skip
    """Of the line segments a-b and c-d, and which share of the second lies before its nearest
    point."""
    ux, uy, uz, vx, vy, vz = bx - ax, by - ay, bz - az, dx - cx, dy - cy, dz - cz
    wx, wy, wz = ax - cx, ay - cy, az - cz
    uu, vv = ux * ux + uy * uy + uz * uz, vx * vx + vy * vy + vz * vz
    uv, uw = ux * vx + uy * vy + uz * vz, ux * wx + uy * wy + uz * wz
    vw = vx * wx + vy * wy + vz * wz
    across = uu * vv - uv * uv
    crossing = across > 1e-12 * uu * vv  # else they are parallel, and any s will do
    s = (uv * vw - vv * uw) / (across if crossing else 1.0)
    s = min(max(s if crossing else 0.0, 0.0), 1.0)
    t = min(max((uv * s + vw) / vv, 0.0), 1.0)
    s = min(max((uv * t - uw) / uu, 0.0), 1.0)  # another only where t was cut off
    x, y, z = wx + s * ux - t * vx, wy + s * uy - t * vy, wz + s * uz - t * vz
    return math.sqrt(x * x + y * y + z * z), t


@compiled_loop
def _pair(
    ends: Array, a: int, b: int, gap: float, radius: Array, size: int, n: int,
    nearer: Array, farther: Array, lower: Array, upper: Array, least: Array,
    which: NDArray[np.int64],
) -> None:  # fmt: skip
    """Takes one pair of capsules into the bounds of a block; `nearer` and `farther` bound their
    distance too, the second by how much a share of the second's length adds."""
    one, two = ends[2 * a], ends[2 * a + 1]
    three, four = ends[2 * b], ends[2 * b + 1]
    ax, ay, az, bx, by, bz = one[0], one[1], one[2], two[0], two[1], two[2]
    cx, cy, cz, dx, dy, dz = three[0], three[1], three[2], four[0], four[1], four[2]
    speed_a, speed_b, speed_c, speed_d = one[3], two[3], three[3], four[3]
    for j in range(size):
        distance, share = _segment_distance(
            ax[j], ay[j], az[j], bx[j], by[j], bz[j], cx[j], cy[j], cz[j], dx[j], dy[j], dz[j]
        )
        distance += gap
        change = max(speed_a[j], speed_b[j]) + max(speed_c[j], speed_d[j])
        change = radius[j] * change if radius[j] > 0.0 else 0.0
        lower[j] = min(lower[j], max(distance - change, gap + nearer[j]))
        upper[j] = min(upper[j], distance + min(change, share * farther[j]))
        less = distance < least[j]
        which[j] = n if less else which[j]
        least[j] = distance if less else least[j]


@compiled_loop
def _hinge(
    elbow: Array, upper: float, fore: float, apart: float, radius: Array, size: int,
    nearer: Array, farther: Array,
) -> None:  # fmt: skip
    """What `_pair` needs of an upper arm and its own rod."""
    speed, least_q, most_v = elbow[SPEED], elbow[LEAST_Q], elbow[MOST_V]
    for j in range(size):
        q, v, r = least_q[j], most_v[j], radius[j]
        nearer[j] = apart * q / math.sqrt(max(q * q + v * v, TINY)) if r > 0.0 else -math.inf
        farther[j] = r * (1.0 + speed[j] * (1.0 + fore / upper)) if r > 0.0 else math.inf


@compiled_loop
def _far_apart(size: int, nearer: Array, farther: Array) -> None:
    for j in range(size):
        nearer[j], farther[j] = -math.inf, math.inf


@compiled_loop
def collisions(
    xyz: Array, radius: Array, arms: Array, rest: Array, capsules: Array,
    pairs: NDArray[np.int64], lower: Array, upper: Array, which: NDArray[np.int64],
) -> None:  # fmt: skip
    """Bounds of the least gap between two capsules, mm, in balls around tool tips: equal where
    `radius` is 0. `which` pair it is, at the centre. `lower` is -inf where an arm does not reach
    all of a ball, `upper` then inf."""
    points = np.empty((3, BLOCK))
    elbows = np.empty((arms.shape[0], ELBOW_ROWS, BLOCK))
    ends = np.empty((2 * capsules.shape[0], 4, BLOCK))
    least, nearer, farther = np.empty(BLOCK), np.empty(BLOCK), np.empty(BLOCK)
    for start in range(0, xyz.shape[0], BLOCK):
        size = min(BLOCK, xyz.shape[0] - start)
        r = radius[start : start + size]
        low, high, found = (
            lower[start : start + size],
            upper[start : start + size],
            which[start : start + size],
        )
        for j in range(size):
            for axis in range(3):
                points[axis, j] = xyz[start + j, axis] - rest[TOOL + axis]
            low[j], high[j], least[j], found[j] = math.inf, math.inf, math.inf, -1
        for i in range(arms.shape[0]):
            _elbows(points, r, size, arms, i, elbows[i])
        for c in range(capsules.shape[0]):
            _place(capsules[c, FROM:TO], points, size, elbows, ends[2 * c])
            _place(capsules[c, TO:RADIUS], points, size, elbows, ends[2 * c + 1])
        for n in range(pairs.shape[0]):
            a, b = pairs[n, 0], pairs[n, 1]
            gap = rest[ROUNDING] - capsules[a, RADIUS] - capsules[b, RADIUS]
            if pairs[n, HINGED] == 1:
                apart, i = 0.0, int(capsules[b, FROM]) - ELBOW
                for axis in range(1, 4):
                    side = capsules[b, FROM + axis] - capsules[a, TO + axis]
                    apart += side * side
                arm = arms[i]
                _hinge(elbows[i], arm[UPPER], arm[FORE], math.sqrt(apart), r, size, nearer, farther)
            else:
                _far_apart(size, nearer, farther)
            _pair(ends, a, b, gap, r, size, n, nearer, farther, low, high, least, found)


@compiled_loop
def gaps(
    xyz: Array, pair: NDArray[np.int64], arms: Array, rest: Array, capsules: Array,
    pairs: NDArray[np.int64], out: Array,
) -> None:  # fmt: skip
    """The gap of one pair at each tool tip, mm; infinite where `pair` is negative."""
    point, still = np.empty((3, 1)), np.zeros(1)
    elbows, ends = np.empty((arms.shape[0], ELBOW_ROWS, 1)), np.empty((4, 4, 1))
    for k in range(xyz.shape[0]):
        out[k] = math.inf
        if pair[k] >= 0:
            for axis in range(3):
                point[axis, 0] = xyz[k, axis] - rest[TOOL + axis]
            for i in range(arms.shape[0]):
                _elbows(point, still, 1, arms, i, elbows[i])
            out[k] = rest[ROUNDING]
            for side in range(2):
                capsule = capsules[pairs[pair[k], side]]
                _place(capsule[FROM:TO], point, 1, elbows, ends[2 * side])
                _place(capsule[TO:RADIUS], point, 1, elbows, ends[2 * side + 1])
                out[k] -= capsule[RADIUS]
            a, b, c, d = ends[0, :, 0], ends[1, :, 0], ends[2, :, 0], ends[3, :, 0]
            distance, _ = _segment_distance(
                a[0], a[1], a[2], b[0], b[1], b[2], c[0], c[1], c[2], d[0], d[1], d[2]
            )
            out[k] += distance
