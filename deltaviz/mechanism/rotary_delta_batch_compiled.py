"""The rotary delta's inverse and forward for many poses: one loop without branches or calls.

Such a loop becomes vector instructions: a few poses at a time, some nanoseconds each. What it
cannot decide (the last rounding at the edge of reach, angles of many turns) it leaves NaN, and
those poses alone are then done with care. `g` is that of `rotary_delta_compiled`, and as there
all that one compiled function calls stands in this file.

The polynomials are minimax fits (Remez exchange at 40 digits) in the square s of their argument,
relative errors below 3e-17: (atan t / t - 1) / s for t up to tan(π/8), (sin r / r - 1) / s and
(cos r - 1 + s/2) / s² for r up to π/2.
"""

from __future__ import annotations

import math

import numpy as np

from deltaviz.mechanism.arrays import Array
from deltaviz.mechanism.compiled import compiled_loop

# Columns of the last row of `g`; as in `rotary_delta_compiled`.
EDGE = 0
MEET = 1
UNDETERMINED = 2

BLOCK = 1024  # poses that stay in the processor's cache between the two passes over them
MANY_TURNS = 1e5  # rad; up to there π times the half turns is exact in its first part
PI_HIGH = 3.1415926534682512  # π's first 33 bits
PI_LOW = 1.2154201013012384e-10  # and the rest
TO_WHOLE = 6755399441055744.0  # 1.5 * 2^52: adding and taking it off again rounds to nearest
TAN_22_5 = 0.41421356237309503

Pair = tuple[float, float]
Vector = tuple[float, float, float]
Arm = tuple[float, float, float, float, float]  # a row of `g`
Numbers = tuple[Arm, Arm, Arm]
Tolerances = tuple[float, float, float]  # handedness, and those of `_meet`


@compiled_loop
def _folded(y: float, x: float) -> Pair:
    """(rise, run) whose ratio is at most tan(π/8), of a direction turned by eighths of a turn."""
    longer, shorter = max(abs(x), abs(y)), min(abs(x), abs(y))
    beyond = shorter > TAN_22_5 * longer
    rise = shorter - longer if beyond else shorter
    run = shorter + longer if beyond else longer
    return rise, (run if run > 0.0 else 1.0)


@compiled_loop
def _unfolded(t: float, y: float, x: float) -> float:
    """atan2(y, x), `t` being the ratio of what was folded."""
    width, height = abs(x), abs(y)
    beyond = min(width, height) > TAN_22_5 * max(width, height)
    s = t * t
    u = 0.039274509619208741815 - 0.019226711654827683098 * s
    u = u * s - 0.050870162038215501946
    u = u * s + 0.058584659831793806522
    u = u * s - 0.066645502363700951137
    u = u * s + 0.076921861282444802611
    u = u * s - 0.090909047135736060401
    u = u * s + 0.11111111018844813817
    u = u * s - 0.14285714284714839852
    u = u * s + 0.19999999999995772992
    u = u * s - 0.33333333333333330378
    angle = (t * s) * u + t
    angle = angle + 0.25 * math.pi if beyond else angle
    angle = 0.5 * math.pi - angle if height > width else angle
    angle = math.pi - angle if x < 0.0 else angle
    return math.copysign(angle, y)


@compiled_loop
def _sin_cos(angle: float) -> tuple[float, float]:
    turns = (angle * (1.0 / math.pi) + TO_WHOLE) - TO_WHOLE
    r = (angle - turns * PI_HIGH) - turns * PI_LOW
    s = r * r
    u = 2.7314514160985291075e-15 * s - 7.6439709198111054248e-13
    u = u * s + 1.605897733525740998e-10
    u = u * s - 2.5052107617407524843e-8
    u = u * s + 2.7557319219167026738e-6
    u = u * s - 0.0001984126984125499036
    u = u * s + 0.0083333333333333158959
    u = u * s - 0.16666666666666666633
    sine = (r * s) * u + r
    w = 4.6464535345859871093e-14 * s - 1.1466253642572866892e-11
    w = w * s + 2.0876681599512714159e-9
    w = w * s - 2.7557318573915257658e-7
    w = w * s + 0.000024801587298916903607
    w = w * s - 0.0013888888888884774582
    w = w * s + 0.041666666666666656318
    cosine = (s * s) * w + (1.0 - 0.5 * s)
    half = 0.5 * turns
    odd = half != (half + TO_WHOLE) - TO_WHOLE
    return (-sine if odd else sine), (-cosine if odd else cosine)


@compiled_loop
def _numbers(g: Array) -> Numbers:
    """What `g` says of each arm, as numbers that stay in registers."""
    return (
        (g[0, 0], g[0, 1], g[0, 2], g[0, 3], g[0, 4]),
        (g[1, 0], g[1, 1], g[1, 2], g[1, 3], g[1, 4]),
        (g[2, 0], g[2, 1], g[2, 2], g[2, 3], g[2, 4]),
    )


@compiled_loop
def _tool(g: Array) -> Vector:
    return g[3, 0], g[3, 1], g[3, 2]


@compiled_loop
def _direction(x: float, y: float, z: float, arm: Arm) -> Pair:
    """(sin, cos) of one arm's angle times ρ²; NaN where out of reach by however little."""
    offset, upper, fore, cos, sin = arm
    p = x * cos + y * sin - offset
    v = y * cos - x * sin
    rho = p * p + z * z
    k = (rho + (v * v + (upper * upper - fore * fore))) * (0.5 / upper)
    q = math.sqrt(rho - k * k)
    return -z * k - p * q, p * k - z * q


@compiled_loop
def _angles(point: Vector, tool: Vector, arms: Numbers) -> Vector:
    """One division for all three ratios: it takes as long as a dozen products."""
    x, y, z = point[0] - tool[0], point[1] - tool[1], point[2] - tool[2]
    sin_a, cos_a = _direction(x, y, z, arms[0])
    sin_b, cos_b = _direction(x, y, z, arms[1])
    sin_c, cos_c = _direction(x, y, z, arms[2])
    rise_a, run_a = _folded(sin_a, cos_a)
    rise_b, run_b = _folded(sin_b, cos_b)
    rise_c, run_c = _folded(sin_c, cos_c)
    inverted = 1.0 / (run_a * run_b * run_c)
    a = _unfolded(rise_a * (run_b * run_c * inverted), sin_a, cos_a)
    b = _unfolded(rise_b * (run_a * run_c * inverted), sin_b, cos_b)
    c = _unfolded(rise_c * (run_a * run_b * inverted), sin_c, cos_c)
    spoilt = (a + b + c) * 0.0
    return a + spoilt, b + spoilt, c + spoilt


@compiled_loop
def _arm_angle_with_care(x: float, y: float, z: float, arm: Arm, tolerance: float) -> float:
    """Beyond the edge of reach by no more than rounding: the edge's own angle."""
    offset, upper, fore, cos, sin = arm
    p = x * cos + y * sin - offset
    v = y * cos - x * sin
    square = p * p + v * v + z * z
    k = (square + (upper * upper - fore * fore)) / (2.0 * upper)
    root = p * p + z * z - k * k
    if not root >= -tolerance * abs(k) * (square + upper * upper + fore * fore) / upper:
        return math.nan
    q = math.sqrt(max(root, 0.0))
    return math.atan2(-z * k - p * q, p * k - z * q)


@compiled_loop
def _angles_with_care(point: Vector, tool: Vector, arms: Numbers, tolerance: float) -> Vector:
    x, y, z = point[0] - tool[0], point[1] - tool[1], point[2] - tool[2]
    a = _arm_angle_with_care(x, y, z, arms[0], tolerance)
    b = _arm_angle_with_care(x, y, z, arms[1], tolerance)
    c = _arm_angle_with_care(x, y, z, arms[2], tolerance)
    spoilt = (a + b + c) * 0.0
    return a + spoilt, b + spoilt, c + spoilt


# The loops below run over slices, from 0: where an index might be negative, numba adds branches.


@compiled_loop
def inverse_rows(xyz: Array, theta: Array, g: Array) -> None:
    """`xyz` and `theta` are rows of three, flattened: so the loop knows that they are dense."""
    arms, tool, tolerance = _numbers(g), _tool(g), g[4, EDGE]
    for start in range(0, xyz.size, 3 * BLOCK):
        points, angles = xyz[start : start + 3 * BLOCK], theta[start : start + 3 * BLOCK]
        lost = 0
        for k in range(points.size // 3):
            point = points[3 * k], points[3 * k + 1], points[3 * k + 2]
            a, b, c = _angles(point, tool, arms)
            lost += math.isnan(a)
            angles[3 * k], angles[3 * k + 1], angles[3 * k + 2] = a, b, c
        for k in range(points.size // 3 if lost else 0):
            if math.isnan(angles[3 * k]):
                point = points[3 * k], points[3 * k + 1], points[3 * k + 2]
                a, b, c = _angles_with_care(point, tool, arms, tolerance)
                angles[3 * k], angles[3 * k + 1], angles[3 * k + 2] = a, b, c


@compiled_loop
def inverse_arrays(x: Array, y: Array, z: Array, a: Array, b: Array, c: Array, g: Array) -> None:
    """Each coordinate and each joint in an array of its own."""
    arms, tool, tolerance = _numbers(g), _tool(g), g[4, EDGE]
    for start in range(0, x.size, BLOCK):
        px, py, pz = x[start : start + BLOCK], y[start : start + BLOCK], z[start : start + BLOCK]
        ta, tb, tc = a[start : start + BLOCK], b[start : start + BLOCK], c[start : start + BLOCK]
        lost = 0
        for k in range(px.size):
            angle_a, angle_b, angle_c = _angles((px[k], py[k], pz[k]), tool, arms)
            lost += math.isnan(angle_a)
            ta[k], tb[k], tc[k] = angle_a, angle_b, angle_c
        for k in range(px.size if lost else 0):
            if math.isnan(ta[k]):
                point = px[k], py[k], pz[k]
                ta[k], tb[k], tc[k] = _angles_with_care(point, tool, arms, tolerance)


@compiled_loop
def _elbow(sine: float, cosine: float, arm: Arm) -> Vector:
    offset, upper, _, cos, sin = arm
    radius = offset + upper * cosine
    return radius * cos, radius * sin, -upper * sine


@compiled_loop
def _cross(ax: float, ay: float, az: float, bx: float, by: float, bz: float) -> Vector:
    return ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx


@compiled_loop
def _meet(one: Vector, two: Vector, three: Vector, arms: Numbers, t: Tolerances) -> Vector:
    """Where the forearms meet below the elbows; NaN where they miss by more than `t` allows."""
    handedness, undetermined, least = t
    dx, dy, dz = one
    ax, ay, az = two[0] - dx, two[1] - dy, two[2] - dz
    bx, by, bz = three[0] - dx, three[1] - dy, three[2] - dz
    l1, l2, l3 = arms[0][2] * arms[0][2], arms[1][2] * arms[1][2], arms[2][2] * arms[2][2]
    nx, ny, nz = _cross(ax, ay, az, bx, by, bz)
    square = nx * nx + ny * ny + nz * nz
    inverted = 1.0 / square
    a_square = az * az + (ay * ay + (ax * ax + (l1 - l2)))
    b_square = bz * bz + (by * by + (bx * bx + (l1 - l3)))
    ex, ey = a_square * bx - b_square * ax, a_square * by - b_square * ay
    ez = a_square * bz - b_square * az
    wx, wy, wz = _cross(ex, ey, ez, nx, ny, nz)  # of length |e| |n|: e lies in the elbows' plane
    height = l1 - (ex * ex + ey * ey + ez * ez) * (0.25 * inverted)
    if least > 0.0 and height < 0.0:
        size = (ax * ax + ay * ay + az * az) * (bx * bx + by * by + bz * bz)
        height = 0.0 if height >= -least * l1 * size * inverted else height
    h = handedness * math.sqrt(height * inverted)
    h = h if square > undetermined else math.nan
    w = 0.5 * inverted
    return (dx + wx * w) - nx * h, (dy + wy * w) - ny * h, (dz + wz * w) - nz * h


@compiled_loop
def _point(pose: Vector, tool: Vector, arms: Numbers, t: Tolerances) -> Vector:
    a, b, c = pose
    sine, cosine = _sin_cos(a)
    one = _elbow(sine, cosine, arms[0])
    sine, cosine = _sin_cos(b)
    two = _elbow(sine, cosine, arms[1])
    sine, cosine = _sin_cos(c)
    three = _elbow(sine, cosine, arms[2])
    x, y, z = _meet(one, two, three, arms, (t[0], t[1], 0.0))
    x = x if abs(a) + abs(b) + abs(c) < MANY_TURNS else math.nan
    return x + tool[0], y + tool[1], z + tool[2]


@compiled_loop
def _point_with_care(pose: Vector, tool: Vector, arms: Numbers, t: Tolerances) -> Vector:
    a, b, c = pose
    one = _elbow(math.sin(a), math.cos(a), arms[0])
    two = _elbow(math.sin(b), math.cos(b), arms[1])
    three = _elbow(math.sin(c), math.cos(c), arms[2])
    x, y, z = _meet(one, two, three, arms, t)
    return x + tool[0], y + tool[1], z + tool[2]


@compiled_loop
def _tolerances(g: Array) -> Tolerances:
    undetermined = g[4, UNDETERMINED] * g[0, 2] * g[0, 2]
    return g[3, 3], undetermined * undetermined, g[4, MEET]


@compiled_loop
def forward_rows(theta: Array, xyz: Array, g: Array) -> None:
    """`theta` and `xyz` are rows of three, flattened."""
    arms, tool, tolerances = _numbers(g), _tool(g), _tolerances(g)
    for start in range(0, theta.size, 3 * BLOCK):
        angles, points = theta[start : start + 3 * BLOCK], xyz[start : start + 3 * BLOCK]
        lost = 0
        for k in range(angles.size // 3):
            pose = angles[3 * k], angles[3 * k + 1], angles[3 * k + 2]
            x, y, z = _point(pose, tool, arms, tolerances)
            lost += math.isnan(x)
            points[3 * k], points[3 * k + 1], points[3 * k + 2] = x, y, z
        for k in range(angles.size // 3 if lost else 0):
            if math.isnan(points[3 * k]):
                pose = angles[3 * k], angles[3 * k + 1], angles[3 * k + 2]
                x, y, z = _point_with_care(pose, tool, arms, tolerances)
                points[3 * k], points[3 * k + 1], points[3 * k + 2] = x, y, z


@compiled_loop
def forward_arrays(a: Array, b: Array, c: Array, x: Array, y: Array, z: Array, g: Array) -> None:
    """Each joint and each coordinate in an array of its own."""
    arms, tool, tolerances = _numbers(g), _tool(g), _tolerances(g)
    for start in range(0, a.size, BLOCK):
        ta, tb, tc = a[start : start + BLOCK], b[start : start + BLOCK], c[start : start + BLOCK]
        px, py, pz = x[start : start + BLOCK], y[start : start + BLOCK], z[start : start + BLOCK]
        lost = 0
        for k in range(ta.size):
            point_x, point_y, point_z = _point((ta[k], tb[k], tc[k]), tool, arms, tolerances)
            lost += math.isnan(point_x)
            px[k], py[k], pz[k] = point_x, point_y, point_z
        for k in range(ta.size if lost else 0):
            if math.isnan(px[k]):
                pose = ta[k], tb[k], tc[k]
                px[k], py[k], pz[k] = _point_with_care(pose, tool, arms, tolerances)


@compiled_loop
def inverse(xyz: Array, g: Array) -> Array:
    """(N, 3) to (N, 3)."""
    theta = np.empty((xyz.shape[0], 3))
    inverse_rows(xyz.reshape(-1), theta.reshape(-1), g)
    return theta


@compiled_loop
def forward(theta: Array, g: Array) -> Array:
    """(N, 3) to (N, 3)."""
    xyz = np.empty((theta.shape[0], 3))
    forward_rows(theta.reshape(-1), xyz.reshape(-1), g)
    return xyz
