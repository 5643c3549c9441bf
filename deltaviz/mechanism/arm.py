"""One arm, seen in its own frame: out from the base, sideways, up.

With the effector's radius taken off the base's, the three forearms end in one point P; P's
outward distance from the motor axis is `p`, its sideways distance from the arm's plane `v`.
The elbow runs on a circle of radius L in that plane, where its distance l from P gives

    K = (p² + v² + z² + L² - l²) / 2L,   ρ² = p² + z²,   q = √(ρ² - K²)
    θ = atan2(-z K - p q, p K - z q)      (elbow outside; with -q: inside)

In the plane of a five-bar v is 0.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from deltaviz.mechanism.arrays import Array

EPS = float(np.finfo(np.float64).eps)
EDGE_ROUNDING = 4 * EPS  # of ρ² - K², relative to the sum of the squares that make K

LEAST_RHO = 1e-3  # of an upper arm: what ρ is taken for where it is smaller still


@dataclass(frozen=True, slots=True)
class Arm:
    """`offset` is base radius minus effector radius, `azimuth` in rad, lengths in mm."""

    offset: float
    upper_arm: float
    forearm: float
    azimuth: float

    @property
    def cos(self) -> float:
        return math.cos(self.azimuth)

    @property
    def sin(self) -> float:
        return math.sin(self.azimuth)

    def plane(self, x: Array, y: Array) -> tuple[Array, Array]:
        """(p, v) of points in the base's frame."""
        return x * self.cos + y * self.sin - self.offset, y * self.cos - x * self.sin

    @property
    def type_1_scale(self) -> float:
        """mm per unit of 1 - K²/ρ² at the outer edge of reach: L(L + l)/2l."""
        return self.upper_arm * (self.upper_arm + self.forearm) / (2 * self.forearm)

    def angle(
        self, x: Array, y: Array, z: Array, *, clamp: bool = False, inside: bool = False
    ) -> Array:
        """Angle with the elbow outside, or `inside`; NaN out of reach, or with `clamp` the
        nearest one."""
        p, v = self.plane(x, y)
        k, edge = self._k(p, v, z)
        square = p * p + z * z - k * k
        if clamp:
            square = np.maximum(square, 0.0)
        else:
            square = np.where((square < 0) & (square >= -edge), 0.0, square)
        q = -np.sqrt(square) if inside else np.sqrt(square)
        return np.arctan2(-z * k - p * q, p * k - z * q)

    def discriminant(self, x: Array, y: Array, z: Array) -> Array:
        """1 - K²/ρ²: the squared sine of the angle between upper arm and shoulder-to-P.

        Zero where the arm is straight or folded, negative out of reach.
        """
        p, v = self.plane(x, y)
        k, _ = self._k(p, v, z)
        square = np.maximum(p * p + z * z, (LEAST_RHO * self.upper_arm) ** 2)
        return 1.0 - k * k / square

    def miss(self, x: Array, y: Array, z: Array) -> tuple[Array, Array]:
        """(too far, too near) in mm: by how much the forearm is too short, or too long."""
        p, v = self.plane(x, y)
        rho = np.hypot(p, z)
        nearest = np.hypot(rho - self.upper_arm, v)
        farthest = np.hypot(rho + self.upper_arm, v)
        return nearest - self.forearm, self.forearm - farthest

    def _k(self, p: Array, v: Array, z: Array) -> tuple[Array, Array]:
        point = p * p + v * v + z * z
        upper, fore = self.upper_arm**2, self.forearm**2
        k = (point + (upper - fore)) / (2 * self.upper_arm)
        edge = EDGE_ROUNDING * np.abs(k) * (point + upper + fore) / self.upper_arm
        return k, edge


@np.errstate(all="ignore")
def arm_angles(
    arms: Sequence[Arm], x: Array, y: Array, z: Array, *, clamp: bool = False, inside: bool = False
) -> Array:
    """(..., n): each arm's angle."""
    each = [arm.angle(x, y, z, clamp=clamp, inside=inside) for arm in arms]
    return np.stack(each, axis=-1)


@np.errstate(all="ignore")
def arm_misses(arms: Sequence[Arm], x: Array, y: Array, z: Array) -> tuple[Array, Array]:
    """(too far, too near), each (..., n) mm."""
    each = [arm.miss(x, y, z) for arm in arms]
    far, near = ([both[side] for both in each] for side in (0, 1))
    return np.stack(far, axis=-1), np.stack(near, axis=-1)


@np.errstate(all="ignore")
def type_1_margins(
    arms: Sequence[Arm], x: Array, y: Array, z: Array, jq: Array, *, reserve: float
) -> Array:
    """(..., n), about mm: the discriminants less their reserve, negative with the elbow inside."""
    columns: list[Array] = []
    for i, arm in enumerate(arms):
        value = arm.discriminant(x, y, z)
        value = np.where(jq[..., i] >= 0.0, value, -np.abs(value))
        columns.append((value - reserve) * arm.type_1_scale)
    return np.stack(columns, axis=-1)
