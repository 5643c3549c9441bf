"""What happens to those who take the sources' formulas as they are printed."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from deltaviz import load_robot
from deltaviz.mechanism import FiveBar, RotaryDelta
from deltaviz.mechanism.published import elbow_centres, legs_of

JOINTS_DEG = (-45.0, 90.0)
COUNT = 100_000
ROUNDED_TAN30 = 0.57735

TUTORIAL = {"upper_arm": 112.0, "forearm": 232.0, "azimuths_deg": (-90.0, 30.0, 150.0)}
F, E = 457.3, 115.0


def drawn(
    joints: int = 3, *, seed: int = 0, within_deg: tuple[float, float] = JOINTS_DEG
) -> np.ndarray:
    """(n, joints) rad, evenly within -45° to 90°."""
    low, high = np.radians(within_deg)
    return np.random.default_rng(seed).uniform(low, high, (COUNT, joints))


def tutorial() -> RotaryDelta:
    return RotaryDelta.from_sides(f=F, e=E, upper_arm=112, forearm=232)


def middle_term() -> str:
    robot, theta = tutorial(), drawn()
    apart = _apart(_tutorial_forward(robot, theta, printed=True), robot.forward(theta))
    return f"median {np.nanmedian(apart):.0f} mm off"


def rounded_tan30() -> tuple[float, float, int]:
    """(median mm missed, the same with the exact tangent, reachable points called out of reach)."""
    robot, theta = tutorial(), drawn()
    xyz = robot.forward(theta)
    xyz = xyz[(robot.jq(xyz, theta) > 0).all(axis=-1)]
    radii = {"base_radius": F / 2 * ROUNDED_TAN30, "effector_radius": E / 2 * ROUNDED_TAN30}
    rounded = RotaryDelta(**radii, **TUTORIAL).inverse(xyz)
    missed = _apart(robot.forward(rounded), xyz)
    exact = _apart(robot.forward(robot.inverse(xyz)), xyz)
    lost = int(np.isnan(missed).sum())
    return float(np.nanmedian(missed)), float(np.median(exact)), lost


def share_inside() -> float:
    """Of the tutorial's angles: with an elbow inside, so that they do not come back."""
    robot, theta = tutorial(), drawn()
    return float((robot.jq(robot.forward(theta), theta) < 0).any(axis=-1).mean())


def equation_12(seed: int = 0) -> float:
    """Median mm that the vector triple product, bracketed from the left, puts P off."""
    robot, theta = _zheng(), drawn(seed=seed)
    printed = _circumcentre(robot, theta, across=lambda a, b, c: np.cross(np.cross(a, b), c))
    return float(np.nanmedian(_apart(printed, robot.forward(theta))))


def equation_15() -> float:
    """Median mm between the lower solution and the upper one that its sign gives."""
    robot, theta = _zheng(), drawn()
    return float(np.median(_apart(_circumcentre(robot, theta, side=-1), robot.forward(theta))))


def unsigned_middle() -> float:
    """mm, for the stm32 robot at (42°, 42°, 90°)."""
    robot, theta = _stm32(), np.radians([[42.0, 42.0, 90.0]])
    return float(_apart(_circumcentre(robot, theta, signed=False), robot.forward(theta))[0])


def smaller_angle() -> float:
    """Share of poses in which the smaller of the two angles puts at least one elbow inside."""
    robot, theta = _zheng(), drawn()
    x, y, z = np.moveaxis(robot.forward(theta), -1, 0)
    both = [[arm.angle(x, y, z, inside=inside) for inside in (False, True)] for arm in robot.arms]
    return float(np.any([inside < outside for outside, inside in both], axis=0).mean())


def half_angle_digits() -> float:
    """Worst degrees that the textbook's root is off a billionth of a mm beside A = 0, which is
    where the other elbow would stand at 180°."""
    robot = _zheng()
    upper, fore = robot.upper_arm[0], robot.forearm[0]
    turn = np.radians(np.linspace(-110, -50, 1001))
    p = -upper + (fore + 1e-9) * np.cos(turn)
    z = (fore + 1e-9) * np.sin(turn)
    k = (p**2 + z**2 + upper**2 - fore**2) / (2 * upper)
    root = np.sqrt(p**2 + z**2 - k**2)
    textbook = 2 * np.arctan2(-z - root, k + p)
    steady = 2 * np.arctan2(k - p, root - z)
    return float(np.degrees(_turned(textbook - steady).max()))


def of_scan(within_deg: tuple[float, float] | None = None) -> np.ndarray:
    """(m, 3) mm: the STM32 library's scan, or of it what joints within these limits reach."""
    from source_tables.stm32 import scan

    xyz, theta = scan(_stm32())
    if within_deg is None:
        return xyz
    low, high = np.radians(within_deg)
    return xyz[((theta >= low) & (theta <= high)).all(axis=-1)]


def of_angles(low_deg: float, high_deg: float) -> np.ndarray:
    """(m, 3) mm: where angles drawn evenly lead the STM32 robot, all its elbows outside."""
    robot = _stm32()
    theta = drawn(within_deg=(low_deg, high_deg))
    xyz = robot.forward(theta)
    return xyz[(robot.jq(xyz, theta) > 0).all(axis=-1)]


def lean_ignored(xyz: np.ndarray, *, planar: bool) -> tuple[float, float]:
    """(median, worst) degrees of the STM32 library's rule of cosines at these places: with its
    forearm's whole length, or else with its distance not planar."""
    robot = _stm32()
    theta = robot.inverse(xyz)
    apart: list[np.ndarray] = []
    for i, leg in enumerate(legs_of(robot)):
        out, side, up = leg.seen(xyz)
        out = out + leg.effector - leg.base
        distance = np.hypot(out, up) if planar else np.sqrt(out**2 + up**2 + side**2)
        fore = leg.fore**2 if planar else leg.fore**2 - side**2
        cosine = (distance**2 + leg.upper**2 - fore) / (2 * leg.upper * distance)
        angle = np.arctan2(-up, out) - np.arccos(np.clip(cosine, -1, 1))
        apart.append(_turned(angle - theta[:, i]))
    return float(np.degrees(np.median(apart))), float(np.degrees(np.max(apart)))


def platform_ignored(*, zone: bool = False) -> float:
    """Worst degrees, for the preset fivebar within -45° to 90°, or all over its zone."""
    fivebar = load_robot("fivebar")
    robot, (x, z) = fivebar.mechanism, (fivebar.zone.x, fivebar.zone.z)
    assert isinstance(robot, FiveBar)
    assert x is not None
    sides = (np.linspace(*side, 201) for side in (x, z))
    grid = np.stack(np.meshgrid(*sides), axis=-1).reshape(-1, 2)
    xz = grid if zone else robot.forward(drawn(2))
    without = FiveBar(
        base_half=robot.base_half, platform_half=0, upper_arm=robot.upper_arm, forearm=robot.forearm
    )
    return float(np.degrees(np.nanmax(_turned(without.inverse(xz) - robot.inverse(xz)))))


def plus_square() -> str:
    """The planar documentation's θ1 with +L2²."""
    robot = load_robot("fivebar").mechanism
    assert isinstance(robot, FiveBar)
    xz = robot.forward(drawn(2))
    leg = legs_of(robot)[1]
    out, _, up = leg.seen(xz)
    out = out + leg.effector - leg.base
    distance = np.hypot(out, up)
    cosine = (distance**2 + leg.upper**2 + leg.fore**2) / (2 * leg.upper * distance)
    return f"no angle at all in {np.mean(np.abs(cosine) > 1):.0%} of the poses"


def _tutorial_forward(robot: RotaryDelta, theta: np.ndarray, *, printed: bool) -> np.ndarray:
    """Spheres subtracted in the frame whose first arm stands at x = 0."""
    d1, d2, d3 = np.moveaxis(elbow_centres(legs_of(robot), theta), -2, 0)
    y1, z1 = d1[:, 1], d1[:, 2]
    w1, w2, w3 = ((d**2).sum(axis=-1) for d in (d1, d2, d3))
    (x2, y2, z2), (x3, y3, z3) = d2.T, d3.T
    det = (y2 - y1) * x3 - (y3 - y1) * x2
    a1 = ((z2 - z1) * (y3 - y1) - (z3 - z1) * (y2 - y1)) / det
    a2 = (-(z2 - z1) * x3 + (z3 - z1) * x2) / det
    b1 = -((w2 - w1) * (y3 - y1) - (w3 - w1) * (y2 - y1)) / (2 * det)
    b2 = ((w2 - w1) * x3 - (w3 - w1) * x2) / (2 * det)
    a = a1**2 + a2**2 + 1
    half_b = a1 + a2 * (b2 - y1) if printed else a1 * b1 + a2 * (b2 - y1) - z1
    c = (b2 - y1) ** 2 + b1**2 + z1**2 - robot.forearm[0] ** 2
    with np.errstate(invalid="ignore"):
        z = (-half_b - np.sqrt(half_b**2 - a * c)) / a
    return np.stack((a1 * z + b1, a2 * z + b2, z), axis=-1)


def _circumcentre(
    robot: RotaryDelta,
    theta: np.ndarray,
    *,
    across: Callable[..., np.ndarray] = lambda a, b, c: np.cross(a, np.cross(b, c)),
    side: int = 1,
    signed: bool = True,
) -> np.ndarray:
    """Equations 9 to 15 for arms that stand counter-clockwise, with what may go wrong."""
    d1, d2, d3 = np.moveaxis(elbow_centres(legs_of(robot), theta), -2, 0)
    d12, d23, d13 = d2 - d1, d3 - d2, d3 - d1
    normal = np.cross(d23, d13)
    radius = _long(d12) * _long(d23) * _long(d13) / (2 * _long(normal))
    middle = np.sqrt(radius**2 - _long(d12) ** 2 / 4)
    if signed:
        middle = middle * np.sign((d13 * d23).sum(axis=-1, keepdims=True))
    way = across(d12, d23, d13)
    centre = (d1 + d2) / 2 + middle * way / _long(way)
    height = np.sqrt(robot.forearm[0] ** 2 - radius**2)
    return centre + side * height * normal / _long(normal)


def _zheng() -> RotaryDelta:
    return RotaryDelta(base_radius=260, effector_radius=50, upper_arm=360, forearm=900)


def _stm32() -> RotaryDelta:
    return RotaryDelta(base_radius=115, effector_radius=75, upper_arm=125, forearm=338)


def _long(vectors: np.ndarray) -> np.ndarray:
    return np.linalg.norm(vectors, axis=-1, keepdims=True)


def _apart(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.linalg.norm(a - b, axis=-1)


def _turned(difference: np.ndarray) -> np.ndarray:
    return np.abs(np.remainder(difference + np.pi, 2 * np.pi) - np.pi)
