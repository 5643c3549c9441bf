"""The rotary delta's inverse and forward for many poses: one loop without branches or calls.

Such a loop becomes vector instructions: a few poses at a time, some nanoseconds each. Its time is
that of the products and sums, so few of them matter more than anything else. What it cannot decide
(the last rounding at the edge of reach, points above the base, angles beyond half a turn) it leaves
NaN, and those poses alone are then done with care. `g` is that of `rotary_delta_compiled`, and as
there all that one compiled function calls stands in this file; but here points are the effector's
centre, and only `inverse` and `forward` know of the tool.

Half angles make it short. With p and K of `arm` the elbow's condition is p cos θ - z sin θ = K, so

    q² = z² - (K - p)(K + p),   tan(θ/2) = (K - p) / (q - z)     (elbow outside)

where below the base, z < 0, nothing cancels that matters and q - z > 0: half of any angle lies
between -90° and 90°, so there are no quadrants. And with C = 2 sin(θ/2)

    L cos θ = L - (L/2) C²,   L sin θ = (L/2) C · 2 cos(θ/2)

and for |θ| up to 180° one polynomial serves for each half: no turns, no signs.

The polynomials are minimax fits (Remez exchange at 50 digits) in the square s of their argument,
errors below 2e-17: (2 atan(t/2) / t - 1) / s for t up to 2 tan(30°), relative; and, absolute,
(2 sin(r/2) / r - 1) / s and (2 cos(r/2) - 2 + s/4) / s² for r up to π.
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
HALF_TURN_SQUARED = 9.869604401089358
TAN_30 = 0.5773502691896257
TAN_60 = 1.7320508075688772

Pair = tuple[float, float]
Vector = tuple[float, float, float]
Reach = tuple[float, float, float, float, float, float, float]  # numbers of `_half`, for one arm
Swing = tuple[float, float, float, float]  # numbers of `_elbow`, for one arm
Squares = tuple[float, float, float]  # of the forearms: the first, and its excess over the others
Tolerances = tuple[float, float, float]  # handedness, and those of `_meet`


@compiled_loop
def _folded(rise: float, run: float) -> Pair:
    """The direction, mirrored to point upwards, and from 30° on turned down by 60°."""
    up = abs(rise)
    steep = up > TAN_30 * run
    return (up - TAN_60 * run if steep else up), (run + TAN_60 * up if steep else run)


@compiled_loop
def _unfolded(t: float, rise: float, run: float) -> float:
    """Twice the angle of a direction, `t` being twice the tangent of what was folded."""
    s = t * t
    u = 1.0898210445216835e-9 - 7.997492059314991e-11 * s
    u = u * s - 7.830930709532911e-9
    u = u * s + 4.187288030199427e-8
    u = u * s - 1.9722712718821033e-7
    u = u * s + 8.950231095519254e-7
    u = u * s - 4.067698900717806e-6
    u = u * s + 1.8779575379911672e-5
    u = u * s - 8.87782932628884e-5
    u = u * s + 0.0004340277594597546
    u = u * s - 0.002232142855428983
    u = u * s + 0.012499999999919074
    u = u * s - 0.083333333333332
    angle = (t * s) * u + t
    angle = angle + 2.0 / 3.0 * math.pi if abs(rise) > TAN_30 * run else angle
    return math.copysign(angle, rise)


@compiled_loop
def _halved(angle: float, s: float) -> Pair:
    """Twice the sine, and twice the cosine, of half an angle up to half a turn; `s`: its square."""
    u = 4.148096304455252e-20 * s - 4.664741778887083e-17
    u = u * s + 3.9206366788560313e-14
    u = u * s - 2.4464947858047773e-11
    u = u * s + 1.0764577815541791e-8
    u = u * s - 3.1001984126853066e-6
    u = u * s + 0.0005208333333333197
    u = u * s - 0.041666666666666664
    w = 1.4087326626268992e-18 * s - 1.3993695618784916e-15
    w = w * s + 1.0193648727059454e-12
    w = w * s - 5.382288489945431e-10
    w = w * s + 1.937624006701875e-7
    w = w * s - 4.3402777777593906e-5
    w = w * s + 0.005208333333333229
    return (angle * s) * u + angle, (w * s - 0.25) * s + 2.0


@compiled_loop
def _reach(g: Array, i: int) -> Reach:
    """The azimuth's cos and sin, and what K - p and K + p take of the point's square, of its way
    out along the azimuth, and besides."""
    offset, upper, fore = g[i, 0], g[i, 1], g[i, 2]
    ratio, k = offset / upper, (offset * offset + upper * upper - fore * fore) * (0.5 / upper)
    return g[i, 3], g[i, 4], 0.5 / upper, 1.0 + ratio, k + offset, 1.0 - ratio, k - offset


@compiled_loop
def _half(x: float, y: float, z: float, square: float, high: float, arm: Reach) -> Pair:
    """(rise, run) of half of one arm's angle; NaN out of reach by however little."""
    cos, sin, scale, minus_out, minus, plus_out, plus = arm
    out = x * cos + y * sin
    k_minus_p = (square * scale + minus) - out * minus_out
    k_plus_p = (square * scale + plus) + out * plus_out
    return k_minus_p, math.sqrt(high - k_minus_p * k_plus_p) - z


@compiled_loop
def _angles(point: Vector, one: Reach, two: Reach, three: Reach) -> Vector:
    """One division for all three ratios: it takes as long as a dozen products. So one NaN makes
    all three NaN."""
    x, y, z = point
    high = z * z if z < 0.0 else math.nan
    square = x * x + (y * y + high)
    rise_a, run_a = _half(x, y, z, square, high, one)
    rise_b, run_b = _half(x, y, z, square, high, two)
    rise_c, run_c = _half(x, y, z, square, high, three)
    up_a, along_a = _folded(rise_a, run_a)
    up_b, along_b = _folded(rise_b, run_b)
    up_c, along_c = _folded(rise_c, run_c)
    inverted = 2.0 / (along_a * along_b * along_c)
    a = _unfolded(up_a * (along_b * along_c * inverted), rise_a, run_a)
    b = _unfolded(up_b * (along_a * along_c * inverted), rise_b, run_b)
    c = _unfolded(up_c * (along_a * along_b * inverted), rise_c, run_c)
    return a, b, c


@compiled_loop
def _arm_angle_with_care(x: float, y: float, z: float, g: Array, i: int) -> float:
    """Beyond the edge of reach by no more than rounding: the edge's own angle."""
    upper, fore, tolerance = g[i, 1], g[i, 2], g[4, EDGE]
    p = x * g[i, 3] + y * g[i, 4] - g[i, 0]
    v = y * g[i, 3] - x * g[i, 4]
    square = p * p + v * v + z * z
    k = (square + (upper * upper - fore * fore)) / (2.0 * upper)
    root = p * p + z * z - k * k
    if not root >= -tolerance * abs(k) * (square + upper * upper + fore * fore) / upper:
        return math.nan
    q = math.sqrt(max(root, 0.0))
    return math.atan2(-z * k - p * q, p * k - z * q)


@compiled_loop
def _angles_with_care(point: Vector, g: Array) -> Vector:
    x, y, z = point
    a = _arm_angle_with_care(x, y, z, g, 0)
    b = _arm_angle_with_care(x, y, z, g, 1)
    c = _arm_angle_with_care(x, y, z, g, 2)
    spoilt = (a + b + c) * 0.0
    return a + spoilt, b + spoilt, c + spoilt


# The loops below run over slices, from 0: where an index might be negative, numba adds branches.


@compiled_loop
def inverse_rows(xyz: Array, theta: Array, g: Array) -> None:
    """`xyz` and `theta` are rows of three, flattened: so the loop knows that they are dense."""
    one, two, three = _reach(g, 0), _reach(g, 1), _reach(g, 2)
    for start in range(0, xyz.size, 3 * BLOCK):
        points, angles = xyz[start : start + 3 * BLOCK], theta[start : start + 3 * BLOCK]
        lost = 0
        for k in range(points.size // 3):
            point = points[3 * k], points[3 * k + 1], points[3 * k + 2]
            a, b, c = _angles(point, one, two, three)
            lost += math.isnan(a)
            angles[3 * k], angles[3 * k + 1], angles[3 * k + 2] = a, b, c
        for k in range(points.size // 3 if lost else 0):
            if math.isnan(angles[3 * k]):
                point = points[3 * k], points[3 * k + 1], points[3 * k + 2]
                a, b, c = _angles_with_care(point, g)
                angles[3 * k], angles[3 * k + 1], angles[3 * k + 2] = a, b, c


@compiled_loop
def inverse_arrays(x: Array, y: Array, z: Array, a: Array, b: Array, c: Array, g: Array) -> None:
    """Each coordinate and each joint in an array of its own."""
    one, two, three = _reach(g, 0), _reach(g, 1), _reach(g, 2)
    for start in range(0, x.size, BLOCK):
        px, py, pz = x[start : start + BLOCK], y[start : start + BLOCK], z[start : start + BLOCK]
        ta, tb, tc = a[start : start + BLOCK], b[start : start + BLOCK], c[start : start + BLOCK]
        lost = 0
        for k in range(px.size):
            angle_a, angle_b, angle_c = _angles((px[k], py[k], pz[k]), one, two, three)
            lost += math.isnan(angle_a)
            ta[k], tb[k], tc[k] = angle_a, angle_b, angle_c
        for k in range(px.size if lost else 0):
            if math.isnan(ta[k]):
                point = px[k], py[k], pz[k]
                ta[k], tb[k], tc[k] = _angles_with_care(point, g)


@compiled_loop
def _swing(g: Array, i: int) -> Swing:
    """The elbow's distance from the centre at angle 0, minus half the upper arm, cos and sin of
    the azimuth."""
    return g[i, 0] + g[i, 1], -0.5 * g[i, 1], g[i, 3], g[i, 4]


@compiled_loop
def _squares(g: Array) -> Squares:
    square = g[0, 2] * g[0, 2]
    return square, square - g[1, 2] * g[1, 2], square - g[2, 2] * g[2, 2]


@compiled_loop
def _elbow(angle: float, square: float, swing: Swing) -> Vector:
    farthest, minus_half_upper, cos, sin = swing
    chord, double_cosine = _halved(angle, square)
    drop = minus_half_upper * chord
    radius = farthest + drop * chord
    return radius * cos, radius * sin, drop * double_cosine


@compiled_loop
def _cross(ax: float, ay: float, az: float, bx: float, by: float, bz: float) -> Vector:
    return ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx


@compiled_loop
def _meet(one: Vector, two: Vector, three: Vector, fore: Squares, t: Tolerances) -> Vector:
    """Where the forearms meet below the elbows; NaN where they miss by more than `t` allows."""
    handedness, undetermined, least = t
    dx, dy, dz = one
    ax, ay, az = two[0] - dx, two[1] - dy, two[2] - dz
    bx, by, bz = three[0] - dx, three[1] - dy, three[2] - dz
    l1, above_2, above_3 = fore
    nx, ny, nz = _cross(ax, ay, az, bx, by, bz)
    square = nx * nx + ny * ny + nz * nz
    quarter = 0.25 / square
    a_square = az * az + (ay * ay + (ax * ax + above_2))
    b_square = bz * bz + (by * by + (bx * bx + above_3))
    ex, ey = a_square * bx - b_square * ax, a_square * by - b_square * ay
    ez = a_square * bz - b_square * az
    wx, wy, wz = _cross(ex, ey, ez, nx, ny, nz)  # of length |e| |n|: e lies in the elbows' plane
    height = l1 - (ex * ex + ey * ey + ez * ez) * quarter
    if least > 0.0 and height < 0.0:
        size = (ax * ax + ay * ay + az * az) * (bx * bx + by * by + bz * bz)
        height = 0.0 if height >= -4.0 * least * l1 * size * quarter else height
    h = 2.0 * handedness * math.sqrt(height * quarter)
    h = h if square > undetermined else math.nan
    w = 2.0 * quarter
    return (dx + wx * w) - nx * h, (dy + wy * w) - ny * h, (dz + wz * w) - nz * h


@compiled_loop
def _point(
    pose: Vector, one: Swing, two: Swing, three: Swing, fore: Squares, t: Tolerances
) -> Vector:
    a, b, c = pose
    aa, bb, cc = a * a, b * b, c * c
    elbows = _elbow(a, aa, one), _elbow(b, bb, two), _elbow(c, cc, three)
    x, y, z = _meet(elbows[0], elbows[1], elbows[2], fore, (t[0], t[1], 0.0))
    x = x if max(max(aa, bb), cc) <= HALF_TURN_SQUARED else math.nan
    return x, y, z


@compiled_loop
def _elbow_with_care(angle: float, g: Array, i: int) -> Vector:
    radius = g[i, 0] + g[i, 1] * math.cos(angle)
    return radius * g[i, 3], radius * g[i, 4], -g[i, 1] * math.sin(angle)


@compiled_loop
def _point_with_care(pose: Vector, g: Array) -> Vector:
    one = _elbow_with_care(pose[0], g, 0)
    two = _elbow_with_care(pose[1], g, 1)
    three = _elbow_with_care(pose[2], g, 2)
    return _meet(one, two, three, _squares(g), _tolerances(g))


@compiled_loop
def _tolerances(g: Array) -> Tolerances:
    undetermined = g[4, UNDETERMINED] * g[0, 2] * g[0, 2]
    return g[3, 3], undetermined * undetermined, g[4, MEET]


@compiled_loop
def forward_rows(theta: Array, xyz: Array, g: Array) -> None:
    """`theta` and `xyz` are rows of three, flattened."""
    one, two, three = _swing(g, 0), _swing(g, 1), _swing(g, 2)
    fore, tolerances = _squares(g), _tolerances(g)
    for start in range(0, theta.size, 3 * BLOCK):
        angles, points = theta[start : start + 3 * BLOCK], xyz[start : start + 3 * BLOCK]
        lost = 0
        for k in range(angles.size // 3):
            pose = angles[3 * k], angles[3 * k + 1], angles[3 * k + 2]
            x, y, z = _point(pose, one, two, three, fore, tolerances)
            lost += math.isnan(x)
            points[3 * k], points[3 * k + 1], points[3 * k + 2] = x, y, z
        for k in range(angles.size // 3 if lost else 0):
            if math.isnan(points[3 * k]):
                pose = angles[3 * k], angles[3 * k + 1], angles[3 * k + 2]
                x, y, z = _point_with_care(pose, g)
                points[3 * k], points[3 * k + 1], points[3 * k + 2] = x, y, z


@compiled_loop
def forward_arrays(a: Array, b: Array, c: Array, x: Array, y: Array, z: Array, g: Array) -> None:
    """Each joint and each coordinate in an array of its own."""
    one, two, three = _swing(g, 0), _swing(g, 1), _swing(g, 2)
    fore, tolerances = _squares(g), _tolerances(g)
    for start in range(0, a.size, BLOCK):
        ta, tb, tc = a[start : start + BLOCK], b[start : start + BLOCK], c[start : start + BLOCK]
        px, py, pz = x[start : start + BLOCK], y[start : start + BLOCK], z[start : start + BLOCK]
        lost = 0
        for k in range(ta.size):
            pose = ta[k], tb[k], tc[k]
            point = _point(pose, one, two, three, fore, tolerances)
            lost += math.isnan(point[0])
            px[k], py[k], pz[k] = point
        for k in range(ta.size if lost else 0):
            if math.isnan(px[k]):
                pose = ta[k], tb[k], tc[k]
                px[k], py[k], pz[k] = _point_with_care(pose, g)


@compiled_loop
def inverse(xyz: Array, g: Array) -> Array:
    """(N, 3) of the tool tip to (N, 3)."""
    theta = np.empty((xyz.shape[0], 3))
    inverse_rows((xyz - g[3, :3]).reshape(-1), theta.reshape(-1), g)
    return theta


@compiled_loop
def forward(theta: Array, g: Array) -> Array:
    """(N, 3) to (N, 3) of the tool tip."""
    xyz = np.empty((theta.shape[0], 3))
    forward_rows(theta.reshape(-1), xyz.reshape(-1), g)
    xyz += g[3, :3]
    return xyz
