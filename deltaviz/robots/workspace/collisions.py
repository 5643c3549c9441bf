"""The parts of a robot that must not touch each other, as capsules."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deltaviz.mechanism import FiveBar, RotaryDelta
from deltaviz.mechanism.arrays import Array
from deltaviz.robots.bodies import Bodies, PlanarBodies
from deltaviz.robots.robot import Robot
from deltaviz.robots.workspace import collisions_compiled as compiled
from deltaviz.robots.workspace.collisions_compiled import BASE, CAPSULE, EFFECTOR, ELBOW

WHOLE = ("base", "effector", "platform")


@dataclass(frozen=True)
class Part:
    """`arm` is 0-based; of base, effector and platform, which have one part for each arm."""

    name: str
    arm: int

    def __str__(self) -> str:
        return self.name if self.name in WHOLE else f"{self.name} of arm {self.arm + 1}"


Named = tuple[Part, list[float]]
End = tuple[int, Array]  # what it is fixed to, and its place from there


@dataclass(frozen=True)
class Collisions:
    """The gaps between a robot's parts as functions of its tool tip."""

    parts: tuple[Part, ...]
    capsules: Array
    pairs: NDArray[np.int64]

    @classmethod
    def of(cls, robot: Robot) -> Collisions | None:
        """None for a robot whose file tells no thicknesses."""
        match robot.mechanism, robot.bodies:
            case RotaryDelta() as mechanism, Bodies() as bodies:
                return cls._between(_capsules(mechanism, bodies), _apart)
            case FiveBar() as mechanism, PlanarBodies() as bodies:
                return cls._between(_planar_capsules(mechanism, bodies), _planar_apart(mechanism))
            case _:
                return None

    @classmethod
    def _between(cls, named: list[Named], apart: Callable[[Part, Part], bool]) -> Collisions:
        parts = tuple(part for part, _ in named)
        pairs = [
            (a, b, _hinged(parts[a], parts[b]))
            for a, b in itertools.combinations(range(len(parts)), 2)
            if apart(parts[a], parts[b])
        ]
        table = np.array(pairs, dtype=np.int64).reshape(-1, 3)
        return cls(parts, np.array([row for _, row in named]), table)

    def bounds(
        self, xyz: Array, radius: Array, arms: Array, rest: Array
    ) -> tuple[Array, Array, NDArray[np.int64]]:
        """(lower, upper) of the least gap in balls around tool tips, and which pair's it is."""
        lower, upper = np.empty(len(xyz)), np.empty(len(xyz))
        which = np.empty(len(xyz), np.int64)
        tables = arms, rest, self.capsules, self.pairs
        compiled.collisions(xyz, radius, *tables, lower, upper, which)
        return lower, upper, which

    def gaps(self, xyz: Array, pair: NDArray[np.int64], arms: Array, rest: Array) -> Array:
        """(n,) of one pair at each tool tip, infinite where its index is negative."""
        out = np.empty(len(xyz))
        compiled.gaps(xyz, pair, arms, rest, self.capsules, self.pairs, out)
        return out

    def names(self, pair: int) -> tuple[Part, Part]:
        first, second, _ = self.pairs[pair]
        return self.parts[first], self.parts[second]


def _capsules(mechanism: RotaryDelta, bodies: Bodies) -> list[Named]:
    """The base's and the effector's arms from the centre outward, the upper arms, and two rods a
    forearm."""
    out: list[Named] = []
    spacing = bodies.rod_spacing / 2
    for i, arm in enumerate(mechanism.arms):
        outward = np.array((arm.cos, arm.sin, 0.0))
        sideways = np.array((-arm.sin, arm.cos, 0.0))
        motor, wrist = mechanism.base_radius[i] * outward, mechanism.effector_radius[i] * outward
        centre = np.zeros(3)
        rows = [
            ("base", (BASE, centre), (BASE, motor), bodies.base_thickness / 2),
            ("effector", (EFFECTOR, centre), (EFFECTOR, wrist), bodies.effector_thickness / 2),
            ("upper arm", (BASE, motor), (ELBOW + i, wrist), bodies.upper_arm_diameter / 2),
        ]
        for side in (-spacing, spacing):
            beside = wrist + side * sideways
            rows.append(("rod", (ELBOW + i, beside), (EFFECTOR, beside), bodies.rod_diameter / 2))
        out += [_named(name, i, start, end, radius) for name, start, end, radius in rows]
    return out


def _planar_capsules(mechanism: FiveBar, bodies: PlanarBodies) -> list[Named]:
    """The base's and the platform's halves, the upper arms and the forearms."""
    out: list[Named] = []
    centre = np.zeros(3)
    for i, arm in enumerate(mechanism.arms):
        outward = np.array((arm.cos, 0.0, 0.0))
        motor, wrist = mechanism.base_half[i] * outward, mechanism.platform_half[i] * outward
        elbow = ELBOW + i, wrist
        out += [
            _named("upper arm", i, (BASE, motor), elbow, bodies.upper_arm_width / 2),
            _named("forearm", i, elbow, (EFFECTOR, wrist), bodies.forearm_width / 2),
        ]
        if mechanism.base_half[i]:
            out.append(_named("base", i, (BASE, centre), (BASE, motor), bodies.base_thickness / 2))
        if mechanism.platform_half[i]:
            start, end = (EFFECTOR, centre), (EFFECTOR, wrist)
            out.append(_named("platform", i, start, end, bodies.platform_thickness / 2))
    return out


def _named(name: str, arm: int, start: End, end: End, radius: float) -> Named:
    row = [float(start[0]), *start[1], float(end[0]), *end[1], radius]
    assert len(row) == CAPSULE
    return Part(name, arm), row


def _apart(one: Part, other: Part) -> bool:
    """Whether two parts could touch where they should not: not those that a joint joins."""
    names = {one.name, other.name}
    if one.name == other.name and one.name in WHOLE:
        return False
    return not (one.arm == other.arm and names == {"base", "upper arm"})


def _planar_apart(mechanism: FiveBar) -> Callable[[Part, Part], bool]:
    """As `_apart`. Arms that end in one joint, on a base or platform without width, it joins."""
    anyhow = [{"base", "forearm"}, {"base", "platform"}, {"platform", "upper arm"}]
    of_two_arms = [{"upper arm", "forearm"}]
    of_two_arms += [{"upper arm"}] if any(mechanism.base_half) else []
    of_two_arms += [{"forearm"}] if any(mechanism.platform_half) else []

    def apart(one: Part, other: Part) -> bool:
        names = {one.name, other.name}
        return names in anyhow or (names in of_two_arms and one.arm != other.arm)

    return apart


def _hinged(one: Part, other: Part) -> bool:
    return one.arm == other.arm and (one.name, other.name) == ("upper arm", "rod")
