"""The parts of a rotary delta that must not touch each other, as capsules."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deltaviz.mechanism import RotaryDelta
from deltaviz.mechanism.arrays import Array
from deltaviz.robots.bodies import Bodies
from deltaviz.robots.robot import Robot
from deltaviz.robots.workspace import collisions_compiled as compiled
from deltaviz.robots.workspace.collisions_compiled import BASE, CAPSULE, EFFECTOR, ELBOW

WHOLE = ("base", "effector")


@dataclass(frozen=True)
class Part:
    """`arm` is 0-based; of base and effector, which have one part for each arm."""

    name: str
    arm: int

    def __str__(self) -> str:
        return self.name if self.name in WHOLE else f"{self.name} of arm {self.arm + 1}"


@dataclass(frozen=True)
class Collisions:
    """The gaps between a robot's parts as functions of its tool tip."""

    parts: tuple[Part, ...]
    capsules: Array
    pairs: NDArray[np.int64]

    @classmethod
    def of(cls, robot: Robot) -> Collisions | None:
        """None for a robot whose file tells no thicknesses, or that is no rotary delta."""
        if robot.bodies is None or not isinstance(robot.mechanism, RotaryDelta):
            return None
        named = _capsules(robot.mechanism, robot.bodies)
        parts = tuple(part for part, _ in named)
        pairs = [
            (a, b, _hinged(parts[a], parts[b]))
            for a, b in itertools.combinations(range(len(parts)), 2)
            if _apart(parts[a], parts[b])
        ]
        return cls(parts, np.array([row for _, row in named]), np.array(pairs, dtype=np.int64))

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


Named = tuple[Part, list[float]]


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
        for name, (from_, start), (to, end), radius in rows:
            row = [float(from_), *start, float(to), *end, radius]
            assert len(row) == CAPSULE
            out.append((Part(name, i), row))
    return out


def _apart(one: Part, other: Part) -> bool:
    """Whether two parts could touch where they should not: not those that a joint joins."""
    names = {one.name, other.name}
    if one.name == other.name and one.name in WHOLE:
        return False
    return not (one.arm == other.arm and names == {"base", "upper arm"})


def _hinged(one: Part, other: Part) -> bool:
    return one.arm == other.arm and (one.name, other.name) == ("upper arm", "rod")
