"""Does a robot's kinematics lead back to where it began, and do other methods say the same?"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from deltaviz.mechanism import FiveBar, RotaryDelta
from deltaviz.mechanism.arrays import Array
from deltaviz.mechanism.published import (
    circles_eliminated,
    cosine_rule,
    elbow_line,
    half_angle,
    legs_of,
    newton,
    spheres_eliminated,
    tetrahedron,
)

if TYPE_CHECKING:
    from deltaviz.mechanism.published.legs import Legs
    from deltaviz.robots.robot import Robot

LENGTH_TOLERANCE = 1e-9  # mm
ANGLE_TOLERANCE = 1e-9  # degrees; at 1 m it is 2e-8 mm
SLOPE_TOLERANCE = 1e-6  # of the largest entry: what central differences can tell
DIFFERENCE = 1e-4  # rad, to either side

MOST_ROUNDS = 200  # of drawing angles, until enough of them are legal

Method = Callable[["Legs", Array], Array]

INVERSES: tuple[tuple[str, Method], ...] = (
    ("tangent of the half angle (Zheng and Chen)", half_angle),
    ("the elbow's line (Trossen)", elbow_line),
    ("rule of cosines (STM32 library, planar robot)", cosine_rule),
)
SPATIAL_FORWARDS: tuple[tuple[str, Method], ...] = (
    ("tetrahedron by circumcentre (Zheng and Chen)", tetrahedron),
    ("spheres eliminated (Trossen)", spheres_eliminated),
    ("Newton on the constraints (STM32 library)", newton),
)
PLANAR_FORWARDS: tuple[tuple[str, Method], ...] = (
    ("circles eliminated", circles_eliminated),
    ("Newton on the constraints", newton),
)


@dataclass(frozen=True, slots=True)
class Check:
    """One comparison over all poses: differences in `unit`, NaN if one side has no solution.

    `not_for` says why a method does not apply to this robot; the numbers are then NaN.
    """

    what: str
    method: str
    unit: str
    tolerance: float
    worst: float
    median: float
    not_for: str | None = None

    @property
    def agrees(self) -> bool:
        return self.not_for is not None or self.worst <= self.tolerance  # NaN disagrees


@dataclass(frozen=True, slots=True)
class Branches:
    """What becomes of `tried` sets of angles within the joint limits: shares of them.

    `closes`: the inverse of the forward gives them back. `elbow_inside`: it gives another set,
    with every elbow outside. `apart`: the forearms cannot meet.
    """

    tried: int
    closes: float
    elbow_inside: float
    apart: float


@dataclass(frozen=True, slots=True)
class Verification:
    """`poses` legal ones, drawn by `seed`; none if the robot has none."""

    robot: str
    poses: int
    seed: int
    checks: tuple[Check, ...]
    branches: Branches

    @property
    def agrees(self) -> bool:
        return self.poses > 0 and all(check.agrees for check in self.checks)


def verify(robot: Robot, *, poses: int = 20_000, seed: int = 0) -> Verification:
    """Raises TypeError for a mechanism that the sources do not have."""
    mechanism = robot.mechanism
    if not isinstance(mechanism, RotaryDelta | FiveBar):
        raise TypeError(f"{type(mechanism).__name__}: no other method is known to verify it by")
    rng = np.random.default_rng(seed)
    theta = _legal_angles(robot, poses, rng)
    checks = tuple(_checks(robot, mechanism, theta)) if len(theta) else ()
    branches = _branches(robot, rng.uniform(*_joint_limits(robot), (poses, mechanism.joints)))
    return Verification(robot.name, len(theta), seed, checks, branches)


def _joint_limits(robot: Robot) -> tuple[tuple[float, ...], tuple[float, ...]]:
    arms = robot.mechanism.joints
    return robot.joints.min[:arms], robot.joints.max[:arms]


def _legal_angles(robot: Robot, count: int, rng: np.random.Generator) -> Array:
    """(m, arms) rad, m <= count: of poses inside every limit of the robot."""
    mechanism, ready = robot.mechanism, robot.homing.ready[robot.mechanism.joints :]
    found: list[Array] = [np.empty((0, mechanism.joints))]
    for _ in range(MOST_ROUNDS):
        theta = rng.uniform(*_joint_limits(robot), (count, mechanism.joints))
        joints = np.concatenate((theta, np.broadcast_to(ready, (count, len(ready)))), axis=-1)
        tip = robot.forward(joints)
        margins = robot.margins(tip, joints)  # NaN, which is not legal, where forearms are apart
        found.append(theta[(margins >= 0).all(axis=-1)])
        if sum(map(len, found)) >= count:
            break
    return np.concatenate(found)[:count]


def _checks(robot: Robot, mechanism: RotaryDelta | FiveBar, theta: Array) -> Iterator[Check]:
    xyz = mechanism.forward(theta)
    back = mechanism.inverse(xyz)
    yield _lengths("forward(inverse(p)) - p", "", mechanism.forward(back) - xyz)
    yield _angles("inverse(forward(θ)) - θ", "", back - theta)

    kernel, offset = mechanism.kernel(robot.bounds), np.asarray(robot.tool_offset)
    tips = np.ascontiguousarray(xyz + offset)
    loop = "the control loop's compiled code"
    yield _angles("inverse", loop, kernel.inverse(tips) - back)
    yield _lengths("forward", loop, kernel.forward(theta) - offset - xyz)

    legs = legs_of(mechanism)
    for name, inverse in INVERSES:
        yield _angles("inverse", name, inverse(legs, xyz) - back)
    for name, forward in PLANAR_FORWARDS if mechanism.joints == 2 else SPATIAL_FORWARDS:
        try:
            yield _lengths("forward", name, forward(legs, theta) - xyz)
        except ValueError as error:
            nan = float("nan")
            yield Check("forward", name, "mm", LENGTH_TOLERANCE, nan, nan, str(error))
    yield _slopes("Jacobian", "differences of the forward", mechanism, theta)


def _lengths(what: str, method: str, difference: Array) -> Check:
    apart = np.sqrt((difference**2).sum(axis=-1))
    return _check(what, method, "mm", LENGTH_TOLERANCE, apart)


def _angles(what: str, method: str, difference: Array) -> Check:
    turned = np.abs(np.remainder(difference + np.pi, 2 * np.pi) - np.pi).max(axis=-1)
    return _check(what, method, "°", ANGLE_TOLERANCE, np.degrees(turned))


def _slopes(what: str, method: str, mechanism: RotaryDelta | FiveBar, theta: Array) -> Check:
    jacobian = mechanism.jacobian(theta)
    columns = [
        (mechanism.forward(theta + step) - mechanism.forward(theta - step)) / (2 * DIFFERENCE)
        for step in DIFFERENCE * np.eye(mechanism.joints)
    ]
    apart = np.abs(np.stack(columns, axis=-1) - jacobian).max(axis=(-2, -1))
    largest = np.abs(jacobian).max(axis=(-2, -1))
    return _check(what, method, "of 1", SLOPE_TOLERANCE, apart / largest)


def _check(what: str, method: str, unit: str, tolerance: float, apart: Array) -> Check:
    return Check(what, method, unit, tolerance, float(apart.max()), float(np.median(apart)))


def _branches(robot: Robot, theta: Array) -> Branches:
    mechanism = robot.mechanism
    xyz = mechanism.forward(theta)
    met = np.isfinite(xyz).all(axis=-1)
    apart = np.remainder(mechanism.inverse(xyz[met]) - theta[met] + np.pi, 2 * np.pi) - np.pi
    closes = int((np.abs(apart).max(axis=-1) < 1e-6).sum())  # rad; at an elbow's turning point
    tried, meeting = len(theta), int(met.sum())  # the angle is only determined to 3e-8
    return Branches(tried, closes / tried, (meeting - closes) / tried, 1 - meeting / tried)
