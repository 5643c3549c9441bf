"""How far points are from each limit, in mm: exact distances wherever the limit has one.

An arm reaches a point whose distances from the elbow's circle, nearest and farthest, lie on
either side of the forearm's length. It stands at a limit of its joint where the point lies on the
sphere of that length around the elbow's centre, on the half of it that belongs to elbows outside.
So the walls of a workspace are tori, half spheres and planes, and the distances to them change by
at most 1 mm per mm. The singularities' margins do not; for them a bound on their slope comes from

    |dD/dP| <= l/q,   q² = ρ² - K² = (l² - near²)(far² - l²) / 4L²

where `near` and `far` are the two distances from the elbow's circle.

A row of `arms`: see `OFFSET` and so on. `rest`: see `TOOL` and so on. Margins stand in columns,
first each kind for all arms: FAR, NEAR, LOW, HIGH, LEAN, SPARE; then TYPE_2, COUPLES, and seven of
the zone. `off` is infinite for those that do not count. All that one compiled function calls
stands in this file: see `rotary_delta_compiled`.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from deltaviz.mechanism.arrays import Array
from deltaviz.mechanism.compiled import compiled_loop

# Columns of `arms`.
OFFSET = 0
UPPER = 1
FORE = 2
COS = 3
SIN = 4
COS_LOW = 5  # of the lower joint limit
SIN_LOW = 6
COS_HIGH = 7
SIN_HIGH = 8
COS_BEYOND = 9  # of the direction farthest from both limits
SIN_BEYOND = 10
WIDE = 11  # 1 if the joint may turn more than half a turn
SIDEWAYS = 12  # most that the forearm may lean out of the arm's plane
TYPE_1_SCALE = 13
ARM_NUMBERS = 14

# Indices into `rest`.
TOOL = 0  # three
HANDEDNESS = 3
TYPE_2_SCALE = 4
TYPE_1_RESERVE = 5
TYPE_2_RESERVE = 6
ROUNDING = 7
ZONE = 8  # z, x, y: low and high
RADIUS = 14
REST = 15

KINDS = 6  # of margin that each arm has
BLOCK = 128  # points whose margins stay in the nearest cache
TINY = 1e-12

Pair = tuple[float, float]
Vector = tuple[float, float, float]
ArmNumbers = tuple[
    float, float, float, float, float, float, float, float, float, float, float, float, float, float
]
Codes = NDArray[np.uint8]


@compiled_loop
def _numbers(arms: Array, i: int) -> ArmNumbers:
    a = arms[i]
    return (a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7], a[8], a[9], a[10], a[11], a[12], a[13])


@compiled_loop
def _half_sphere(p: float, v: float, z: float, cos: float, sin: float, a: ArmNumbers) -> float:
    """Distance from the half sphere of elbows outside around the elbow at one joint limit."""
    outward, down = p - a[UPPER] * cos, z + a[UPPER] * sin
    ahead = -outward * sin - down * cos  # along the way that the elbow moves with its angle
    square = outward * outward + v * v + down * down
    behind = max(-ahead, 0.0)
    radius = math.sqrt(max(square - behind * behind, 0.0))
    return math.sqrt((radius - a[FORE]) * (radius - a[FORE]) + behind * behind)


@compiled_loop
def _joint_margins(p: float, v: float, z: float, cos: float, sin: float, a: ArmNumbers) -> Pair:
    """From the lower and the upper limit; the one that is broken is negative."""
    above_low = sin * a[COS_LOW] - cos * a[SIN_LOW] >= 0.0
    below_high = cos * a[SIN_HIGH] - sin * a[COS_HIGH] >= 0.0
    legal = (above_low or below_high) if a[WIDE] > 0.0 else (above_low and below_high)
    past_high = sin * a[COS_BEYOND] - cos * a[SIN_BEYOND] < 0.0
    low = _half_sphere(p, v, z, a[COS_LOW], a[SIN_LOW], a)
    high = _half_sphere(p, v, z, a[COS_HIGH], a[SIN_HIGH], a)
    return (
        low if (legal or past_high) else -low,
        -high if (past_high and not legal) else high,
    )


@compiled_loop
def _arm_plane(x: float, y: float, a: ArmNumbers) -> Pair:
    return x * a[COS] + y * a[SIN] - a[OFFSET], y * a[COS] - x * a[SIN]


@compiled_loop
def _circle_distances(rho: float, v: float, a: ArmNumbers) -> Pair:
    """From the elbow's circle: nearest and farthest."""
    inner, outer = rho - a[UPPER], rho + a[UPPER]
    return math.sqrt(inner * inner + v * v), math.sqrt(outer * outer + v * v)


@compiled_loop
def _elbow_angle(p: float, v: float, z: float, rho: float, a: ArmNumbers) -> Vector:
    """(cos, sin) with the elbow outside, or the nearest to reaching; and K."""
    k = (rho * rho + v * v + (a[UPPER] * a[UPPER] - a[FORE] * a[FORE])) * (0.5 / a[UPPER])
    q = math.sqrt(max(rho * rho - k * k, 0.0))
    scale = 1.0 / max(rho * max(rho, abs(k)), TINY)
    return (p * k - z * q) * scale, -(z * k + p * q) * scale, k


@compiled_loop
def _forearm(p: float, v: float, z: float, cos: float, sin: float, a: ArmNumbers) -> Vector:
    """The forearm's direction in the base's frame, a unit vector."""
    outward, down = p - a[UPPER] * cos, z + a[UPPER] * sin
    scale = 1.0 / max(math.sqrt(outward * outward + v * v + down * down), TINY)
    x = outward * a[COS] - v * a[SIN]
    y = outward * a[SIN] + v * a[COS]
    return x * scale, y * scale, down * scale


@compiled_loop
def _type_1(rho: float, k: float, a: ArmNumbers, reserve: float) -> float:
    square = max(rho * rho, TINY)
    return (1.0 - k * k / square - reserve) * a[TYPE_1_SCALE]


@compiled_loop
def _arm_margins(
    points: Array, size: int, arms: Array, rest: Array, i: int, out: Array, forearm: Array
) -> None:
    count = arms.shape[0]
    a, reserve = _numbers(arms, i), rest[TYPE_1_RESERVE]
    xs, ys, zs = points[0], points[1], points[2]
    far, near = out[i], out[count + i]
    low, high = out[2 * count + i], out[3 * count + i]
    lean, spare = out[4 * count + i], out[5 * count + i]
    ux, uy, uz = forearm[3 * i], forearm[3 * i + 1], forearm[3 * i + 2]
    for j in range(size):
        z = zs[j]
        p, v = _arm_plane(xs[j], ys[j], a)
        rho = math.sqrt(p * p + z * z)
        nearest, farthest = _circle_distances(rho, v, a)
        cos, sin, k = _elbow_angle(p, v, z, rho, a)
        far[j] = a[FORE] - nearest
        near[j] = farthest - a[FORE]
        low[j], high[j] = _joint_margins(p, v, z, cos, sin, a)
        lean[j] = a[SIDEWAYS] - abs(v)
        spare[j] = _type_1(rho, k, a, reserve)
        ux[j], uy[j], uz[j] = _forearm(p, v, z, cos, sin, a)


@compiled_loop
def _cross(ax: float, ay: float, az: float, bx: float, by: float, bz: float) -> Vector:
    return ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx


@compiled_loop
def _firmness(
    ax: float, ay: float, az: float,
    bx: float, by: float, bz: float,
    cx: float, cy: float, cz: float,
) -> float:  # fmt: skip
    """det / ‖adj‖ of three rows: see `stiffness`."""
    px, py, pz = _cross(bx, by, bz, cx, cy, cz)
    qx, qy, qz = _cross(cx, cy, cz, ax, ay, az)
    rx, ry, rz = _cross(ax, ay, az, bx, by, bz)
    norm = px * px + py * py + pz * pz + qx * qx + qy * qy + qz * qz
    norm = math.sqrt(norm + rx * rx + ry * ry + rz * rz)
    return (ax * px + ay * py + az * pz) / max(norm, TINY)


@compiled_loop
def _firmness_margins(
    forearm: Array, size: int, arms: Array, rest: Array, type_2: Array, couples: Array
) -> None:
    """How firmly the forearms hold the effector's place, and its orientation."""
    f, reserve, scale = forearm, rest[TYPE_2_RESERVE], rest[TYPE_2_SCALE]
    if arms.shape[0] == 2:
        for j in range(size):
            held = -(f[0, j] * f[5, j] - f[2, j] * f[3, j]) / math.sqrt(2.0)
            type_2[j] = (held - reserve) * scale
            couples[j] = math.inf
        return
    hand = rest[HANDEDNESS]
    c0, s0, c1, s1 = arms[0, COS], arms[0, SIN], arms[1, COS], arms[1, SIN]
    c2, s2 = arms[2, COS], arms[2, SIN]
    for j in range(size):
        ax, ay, az = f[0, j], f[1, j], f[2, j]
        bx, by, bz = f[3, j], f[4, j], f[5, j]
        cx, cy, cz = f[6, j], f[7, j], f[8, j]
        type_2[j] = (-hand * _firmness(ax, ay, az, bx, by, bz, cx, cy, cz) - reserve) * scale
        ax, ay, az = _cross(-s0, c0, 0.0, ax, ay, az)
        bx, by, bz = _cross(-s1, c1, 0.0, bx, by, bz)
        cx, cy, cz = _cross(-s2, c2, 0.0, cx, cy, cz)
        couples[j] = (hand * _firmness(ax, ay, az, bx, by, bz, cx, cy, cz) - reserve) * scale


@compiled_loop
def _zone_margins(points: Array, size: int, rest: Array, out: Array) -> None:
    """Of the tool tip: `points` are the effector's centre."""
    tx, ty, tz = rest[TOOL], rest[TOOL + 1], rest[TOOL + 2]
    xs, ys, zs = points[0], points[1], points[2]
    z0, z1, x0, x1, y0, y1 = out[0], out[1], out[2], out[3], out[4], out[5]
    radius = out[6]
    for j in range(size):
        x, y, z = xs[j] + tx, ys[j] + ty, zs[j] + tz
        z0[j], z1[j] = z - rest[ZONE], rest[ZONE + 1] - z
        x0[j], x1[j] = x - rest[ZONE + 2], rest[ZONE + 3] - x
        y0[j], y1[j] = y - rest[ZONE + 4], rest[ZONE + 5] - y
        radius[j] = rest[RADIUS] - math.sqrt(x * x + y * y)


@compiled_loop
def _margins(
    points: Array, size: int, arms: Array, rest: Array, out: Array, forearm: Array
) -> None:
    """All margins of one block: `points` (3, BLOCK), `out` (columns, BLOCK)."""
    count = arms.shape[0]
    for i in range(count):
        _arm_margins(points, size, arms, rest, i, out, forearm)
    start = KINDS * count
    _firmness_margins(forearm, size, arms, rest, out[start], out[start + 1])
    _zone_margins(points, size, rest, out[start + 2 :])


@compiled_loop
def _least(
    margins: Array, size: int, off: Array, rounding: float, value: Array, code: Codes
) -> None:
    for j in range(size):
        value[j] = math.inf
    for column in range(off.size):
        if off[column] == 0.0:
            margin = margins[column]
            for j in range(size):
                less = margin[j] + rounding < value[j]
                value[j] = margin[j] + rounding if less else value[j]
                code[j] = np.uint8(column) if less else code[j]


@compiled_loop
def least(xyz: Array, arms: Array, rest: Array, off: Array, value: Array, code: Codes) -> None:
    """The smallest margin of each tool tip (N, 3), and which column it stands in."""
    points, found = np.empty((3, BLOCK)), np.empty(BLOCK)
    margins = np.empty((off.size, BLOCK))
    forearm = np.empty((3 * arms.shape[0], BLOCK))
    codes = np.empty(BLOCK, np.uint8)
    for start in range(0, xyz.shape[0], BLOCK):
        size = min(BLOCK, xyz.shape[0] - start)
        for j in range(size):
            for axis in range(3):
                points[axis, j] = xyz[start + j, axis] - rest[TOOL + axis]
        _margins(points, size, arms, rest, margins, forearm)
        _least(margins, size, off, rest[ROUNDING], found, codes)
        for j in range(size):
            value[start + j] = found[j]
            code[start + j] = codes[j]


@compiled_loop
def every(xyz: Array, arms: Array, rest: Array, off: Array, out: Array) -> None:
    """All margins of each tool tip, (N, columns); infinite those that do not count."""
    points = np.empty((3, BLOCK))
    margins = np.empty((off.size, BLOCK))
    forearm = np.empty((3 * arms.shape[0], BLOCK))
    for start in range(0, xyz.shape[0], BLOCK):
        size = min(BLOCK, xyz.shape[0] - start)
        for j in range(size):
            for axis in range(3):
                points[axis, j] = xyz[start + j, axis] - rest[TOOL + axis]
        _margins(points, size, arms, rest, margins, forearm)
        for column in range(off.size):
            for j in range(size):
                out[start + j, column] = margins[column, j] + off[column] + rest[ROUNDING]


@compiled_loop
def field(
    x: Array, y: Array, z: Array, arms: Array, rest: Array, off: Array,
    value: NDArray[np.float32], code: Codes,
) -> None:  # fmt: skip
    """As `least`, at the nodes of a grid: `value` and `code` (len(x), len(y), len(z))."""
    points, found = np.empty((3, BLOCK)), np.empty(BLOCK)
    margins = np.empty((off.size, BLOCK))
    forearm = np.empty((3 * arms.shape[0], BLOCK))
    codes = np.empty(BLOCK, np.uint8)
    for ix in range(x.size):
        for iy in range(y.size):
            for start in range(0, z.size, BLOCK):
                size = min(BLOCK, z.size - start)
                for j in range(size):
                    points[0, j] = x[ix] - rest[TOOL]
                    points[1, j] = y[iy] - rest[TOOL + 1]
                    points[2, j] = z[start + j] - rest[TOOL + 2]
                _margins(points, size, arms, rest, margins, forearm)
                _least(margins, size, off, rest[ROUNDING], found, codes)
                for j in range(size):
                    value[ix, iy, start + j] = found[j]
                    code[ix, iy, start + j] = codes[j]


@compiled_loop
def _from_limits(p: float, z: float, sign: float, a: ArmNumbers) -> float:
    """Distance from the half planes, bounded by the motor axis, in which an arm at one of its
    joint's limits lies; with `sign` -1 in which its opposite lies.

    Out of an arm's reach its angle is taken for the nearest to reaching, which turns past a limit
    nowhere but there.
    """
    least = math.inf
    for limit in range(2):
        cos, sin = a[COS_LOW + 2 * limit] * sign, a[SIN_LOW + 2 * limit] * sign
        along = p * cos - z * sin
        across = abs(p * sin + z * cos)
        least = min(least, across if along > 0.0 else math.sqrt(p * p + z * z))
    return least


@compiled_loop
def _elbow_change(rho: float, v: float, r: float, a: ArmNumbers) -> float:
    """How far the elbow may be anywhere in a ball from where it is at its centre, as far as the
    arm reaches; where it does not reach the centre, from the nearest to reaching.

    θ is the direction of the point from the shoulder less arccos K/ρ, which stays bounded where
    the arm is straight or folded. K/ρ = (ρ + A/ρ) / 2L with A = v² + L² - l².
    """
    twice, extra = 2.0 * a[UPPER], a[UPPER] * a[UPPER] - a[FORE] * a[FORE]
    narrow, wide = rho - r, rho + r
    if narrow <= 0.0:
        return twice
    inner = max(abs(v) - r, 0.0)
    least, most = inner * inner + extra, (abs(v) + r) * (abs(v) + r) + extra
    high = max(narrow + most / narrow, wide + most / wide) / twice
    turn = min(max(math.sqrt(max(least, 0.0)), narrow), wide)  # where ρ + A/ρ is least
    low = (turn + least / turn) / twice
    here = math.acos(min(max((rho + (v * v + extra) / rho) / twice, -1.0), 1.0))
    opened = math.acos(min(max(low, -1.0), 1.0)) - here
    closed = here - math.acos(min(max(high, -1.0), 1.0))
    return a[UPPER] * (math.asin(min(r / rho, 1.0)) + max(opened, closed))


@compiled_loop
def _arm_bounds(
    x: float, y: float, z: float, r: float, arms: Array, rest: Array, off: Array, i: int,
    forearm: Array, found: Array,
) -> None:  # fmt: skip
    """Bounds of one arm's margins over a ball of radius `r`: see `bounds`.

    `found` is lower, upper, and the sum of the squares of how much the forearms' directions may
    change.
    """
    count = arms.shape[0]
    a = _numbers(arms, i)
    p, v = _arm_plane(x, y, a)
    rho = math.sqrt(p * p + z * z)
    nearest, farthest = _circle_distances(rho, v, a)
    far, near = a[FORE] - nearest, farthest - a[FORE]
    found[0] = min(found[0], far - r, near - r)
    found[1] = min(found[1], far + r, near + r)
    if off[4 * count + i] == 0.0:
        lean = a[SIDEWAYS] - abs(v)
        found[0], found[1] = min(found[0], lean - r), min(found[1], lean + r)
    cos, sin, _ = _elbow_angle(p, v, z, rho, a)
    if off[2 * count + i] == 0.0:
        low, high = _joint_margins(p, v, z, cos, sin, a)
        found[0] = min(found[0], low - r, high - r)
        if (far > r or _from_limits(p, z, 1.0, a) > r) and (
            near > r or _from_limits(p, z, -1.0, a) > r
        ):
            found[1] = min(found[1], low + r, high + r)
    square, twice = a[FORE] * a[FORE], 2.0 * a[UPPER]
    narrow, wide = max(rho - r, 0.0), rho + r
    if off[5 * count + i] == 0.0:
        inner, outer = max(nearest - r, 0.0), farthest + r
        most = (square - inner * inner) * (outer * outer - square) / (twice * twice)
        if most < narrow * narrow:
            reserve, scale = rest[TYPE_1_RESERVE], a[TYPE_1_SCALE]
            found[1] = min(found[1], (most / max(narrow * narrow, TINY) - reserve) * scale)
    change = _elbow_change(rho, v, r, a)
    if far > r and near > r:
        outer, inner = nearest + r, farthest - r
        least = math.sqrt((square - outer * outer) * (inner * inner - square)) / twice
        if off[5 * count + i] == 0.0:
            reserve, scale = rest[TYPE_1_RESERVE], a[TYPE_1_SCALE]
            found[0] = min(found[0], (least * least / (wide * wide) - reserve) * scale)
        change = min(change, r * a[FORE] / least)
    # A centre out of reach has a forearm of another length, which is then made a unit vector.
    change = (r + change) / a[FORE] * (1.0 if far >= 0.0 and near >= 0.0 else 2.0)
    found[2] += change * change
    ux, uy, uz = _forearm(p, v, z, cos, sin, a)
    forearm[3 * i, 0], forearm[3 * i + 1, 0], forearm[3 * i + 2, 0] = ux, uy, uz


@compiled_loop
def bounds(
    xyz: Array, radius: Array, arms: Array, rest: Array, off: Array, lower: Array, upper: Array
) -> None:
    """Of balls around tool tips: `lower` is not negative only if the whole ball lies within the
    workspace, `upper` is negative only if all of it lies outside."""
    count = arms.shape[0]
    point, found = np.empty((3, 1)), np.empty(3)
    forearm, firm, zone = np.empty((3 * count, 1)), np.empty((2, 1)), np.empty((7, 1))
    for k in range(xyz.shape[0]):
        r = radius[k]
        found[0], found[1], found[2] = math.inf, math.inf, 0.0
        for axis in range(3):
            point[axis, 0] = xyz[k, axis] - rest[TOOL + axis]
        for i in range(count):
            _arm_bounds(
                point[0, 0], point[1, 0], point[2, 0], r, arms, rest, off, i, forearm, found
            )
        _firmness_margins(forearm, 1, arms, rest, firm[0], firm[1])
        change = rest[TYPE_2_SCALE] * math.sqrt(found[2])
        for kind in range(2):
            if off[KINDS * count + kind] == 0.0:
                found[0] = min(found[0], firm[kind, 0] - change)
                found[1] = min(found[1], firm[kind, 0] + change)
        _zone_margins(point, 1, rest, zone)
        for column in range(7):
            if off[KINDS * count + 2 + column] == 0.0:
                found[0] = min(found[0], zone[column, 0] - r)
                found[1] = min(found[1], zone[column, 0] + r)
        lower[k], upper[k] = found[0] + rest[ROUNDING], found[1] + rest[ROUNDING]
