"""The rotary delta: three motors on the base, three parallelograms, one translating effector."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Self

import numpy as np
from numpy.typing import ArrayLike

from deltaviz.mechanism.arm import EPS, Arm, arm_angles, arm_misses, type_1_margins
from deltaviz.mechanism.arrays import Array, in_blocks, rows
from deltaviz.mechanism.bounds import Bounds
from deltaviz.mechanism.geometry import GeometryError, per_arm
from deltaviz.mechanism.kernel import Kernel
from deltaviz.mechanism.margin import Margin, MarginKind
from deltaviz.mechanism.stiffness import TYPE_1_RESERVE, TYPE_2_RESERVE, stiffness, unit
from deltaviz.mechanism.vectors import cross, cross_rows, dot, minus

if TYPE_CHECKING:
    from deltaviz.mechanism.rotary_delta_batch import RotaryDeltaBatch

MEET_ROUNDING = 16 * EPS  # of P's squared height over three elbows at right angles, in l²
UNDETERMINED = 1e-12  # elbow centres whose triangle is smaller than this, in squared forearms
MANY = 250_000  # poses from which the compiled loop is worth its second of importing numba
LEAST_SEPARATION = math.radians(1.0)  # of two arms' azimuths


@dataclass(frozen=True, init=False)
class RotaryDelta:
    """Geometry of a rotary delta; all lengths in mm, one number per arm.

    `base_radius`: centre to motor axis. `effector_radius`: effector's centre to the forearm's
    joint. `azimuths_deg`: directions of the motors, counter-clockwise from +x.
    """

    base_radius: tuple[float, ...]
    effector_radius: tuple[float, ...]
    upper_arm: tuple[float, ...]
    forearm: tuple[float, ...]
    azimuths_deg: tuple[float, ...]

    def __init__(
        self,
        *,
        base_radius: float | Sequence[float],
        effector_radius: float | Sequence[float],
        upper_arm: float | Sequence[float],
        forearm: float | Sequence[float],
        azimuths_deg: Sequence[float] = (0.0, 120.0, 240.0),
    ) -> None:
        """Each length is one number for all arms or one per arm.

        Raises GeometryError, naming the field, its value and the rule.
        """
        fields = {
            "base_radius": per_arm("base_radius", base_radius, arms=3, above=0.0),
            "effector_radius": per_arm("effector_radius", effector_radius, arms=3, above=0.0),
            "upper_arm": per_arm("upper_arm", upper_arm, arms=3, above=0.0),
            "forearm": per_arm("forearm", forearm, arms=3, above=0.0),
            "azimuths_deg": per_arm("azimuths_deg", azimuths_deg, arms=3),
        }
        for name, value in fields.items():
            object.__setattr__(self, name, value)
        self._check()

    @classmethod
    def from_sides(
        cls,
        *,
        f: float,
        e: float,
        upper_arm: float | Sequence[float],
        forearm: float | Sequence[float],
        azimuths_deg: Sequence[float] = (-90.0, 30.0, 150.0),
    ) -> Self:
        """From the sides of the base's and the effector's triangle (f and e, Trossen 2009)."""
        return cls(
            base_radius=per_arm("f", f, arms=3, above=0.0)[0] / (2 * math.sqrt(3)),
            effector_radius=per_arm("e", e, arms=3, above=0.0)[0] / (2 * math.sqrt(3)),
            upper_arm=upper_arm,
            forearm=forearm,
            azimuths_deg=azimuths_deg,
        )

    @property
    def joints(self) -> int:
        return 3

    @property
    def axes(self) -> tuple[str, ...]:
        return ("X", "Y", "Z")

    @property
    def margin_names(self) -> tuple[Margin, ...]:
        return (
            *(Margin(MarginKind.TYPE_1, arm) for arm in range(3)),
            Margin(MarginKind.TYPE_2),
            Margin(MarginKind.PARALLELOGRAM),
        )

    @cached_property
    def arms(self) -> tuple[Arm, ...]:
        return tuple(
            Arm(
                offset=self.base_radius[i] - self.effector_radius[i],
                upper_arm=self.upper_arm[i],
                forearm=self.forearm[i],
                azimuth=math.radians(self.azimuths_deg[i]),
            )
            for i in range(self.joints)
        )

    @cached_property
    def batch(self) -> RotaryDeltaBatch:
        """`inverse` and `forward` compiled for very many poses; the first use imports numba."""
        from deltaviz.mechanism.rotary_delta_batch import RotaryDeltaBatch

        return RotaryDeltaBatch(self)

    @cached_property
    def handedness(self) -> float:
        """+1 if the arms stand counter-clockwise in their order, else -1."""
        a, b, c = (arm.azimuth for arm in self.arms)
        return math.copysign(1.0, math.sin(b - a) + math.sin(c - b) + math.sin(a - c))

    def inverse(self, xyz: ArrayLike) -> Array:
        """Joint angles of effector positions, (..., 3) mm to (..., 3) rad, elbows outside.

        A row is NaN where any arm cannot reach. At the very edge of reach, where rounding
        decides, the edge's own angle is returned; it is determined only to about 3e-8 rad.
        """
        points = rows(xyz, 3, "xyz")
        if points.size >= 3 * MANY:
            return self.batch.inverse_rows(points)
        return in_blocks(self._solve, points)

    def nearest_angles(self, xyz: ArrayLike) -> Array:
        """As `inverse`, but an arm that cannot reach gets the angle that comes nearest."""
        return self._angles(rows(xyz, 3, "xyz"), clamp=True)

    @np.errstate(all="ignore")
    def forward(self, theta: ArrayLike) -> Array:
        """Effector positions of joint angles, (..., 3) rad to (..., 3) mm.

        Trilateration on the elbow centres moved inward by the effector's radius; of the two
        solutions the working one (det Jx < 0 with arms counter-clockwise: below the elbows).
        A row is NaN where the forearms cannot meet, or would meet in more than two points.
        """
        angles = rows(theta, 3, "theta")
        if angles.size >= 3 * MANY:
            return self.batch.forward_rows(angles)
        return in_blocks(lambda block: self._meet(self.elbows(block)), angles)

    @np.errstate(all="ignore")
    def jacobian(self, theta: ArrayLike) -> Array:
        """d xyz / d theta, (..., 3) rad to (..., 3, 3) mm/rad; NaN where `forward` is, and at
        type 2 singularities."""
        angles = rows(theta, 3, "theta")
        elbows = self.elbows(angles)
        forearms = self._meet(elbows)[..., None, :] - elbows
        jq = self._jq(forearms, angles)
        adjugate = cross_rows(forearms)
        det = (forearms[..., 0, :] * adjugate[..., 0, :]).sum(axis=-1)
        det = np.where(det == 0.0, np.nan, det)
        return np.swapaxes(adjugate * (jq / det[..., None])[..., None], -1, -2)

    @np.errstate(all="ignore")
    def elbows(self, theta: ArrayLike) -> Array:
        """Elbow centres moved inward by the effector's radius, (..., 3) rad to (..., 3, 3) mm."""
        angles = rows(theta, 3, "theta")
        out = np.empty((*angles.shape, 3))
        for i, arm in enumerate(self.arms):
            radius = arm.offset + arm.upper_arm * np.cos(angles[..., i])
            out[..., i, 2] = -arm.upper_arm * np.sin(angles[..., i])
            out[..., i, 0] = radius * arm.cos
            out[..., i, 1] = radius * arm.sin
        return out

    def jq(self, xyz: ArrayLike, theta: ArrayLike) -> Array:
        """(..., 3) mm²/rad: positive with the elbow outside, 0 at type 1 singularities."""
        angles = rows(theta, 3, "theta")
        return self._jq(rows(xyz, 3, "xyz")[..., None, :] - self.elbows(angles), angles)

    def det_jx(self, xyz: ArrayLike, theta: ArrayLike) -> Array:
        """(...) mm³: determinant of the forearm vectors, 0 at type 2 singularities, negative
        in the working assembly of arms that stand counter-clockwise."""
        forearms = rows(xyz, 3, "xyz")[..., None, :] - self.elbows(theta)
        return (forearms[..., 0, :] * cross_rows(forearms)[..., 0, :]).sum(axis=-1)

    def couples(self, xyz: ArrayLike, theta: ArrayLike) -> Array:
        """(..., 3, 3): t_i x S_i/|S_i|, the moments by which the parallelograms hold the
        effector's orientation; they do so unless these become linearly dependent."""
        forearms = unit(rows(xyz, 3, "xyz")[..., None, :] - self.elbows(theta))
        return np.cross(np.array([(-arm.sin, arm.cos, 0.0) for arm in self.arms]), forearms)

    def sideways(self, xyz: ArrayLike) -> Array:
        """(..., 3) mm: how far each forearm leans out of its arm's plane; its ball joints
        stand at asin(sideways / forearm)."""
        points = rows(xyz, 3, "xyz")
        planes = [arm.plane(points[..., 0], points[..., 1])[1] for arm in self.arms]
        return np.stack(planes, axis=-1)

    def misses(self, xyz: ArrayLike) -> tuple[Array, Array]:
        """(too far, too near), each (..., 3) mm: how far each arm is from reaching; negative
        where it reaches."""
        points = rows(xyz, 3, "xyz")
        return arm_misses(self.arms, points[..., 0], points[..., 1], points[..., 2])

    @np.errstate(all="ignore")
    def margins(self, xyz: ArrayLike, theta: ArrayLike) -> Array:
        """(..., 5) as `margin_names`; NaN angles are replaced by those nearest to reaching.

        The discriminants are normalised, lowered by their reserve (see `stiffness`) and scaled
        to about 1 per mm. An arm whose elbow is inside is beyond its type 1 margin.
        """
        points = rows(xyz, 3, "xyz")
        angles = rows(theta, 3, "theta")
        angles = np.where(np.isnan(angles), self.nearest_angles(points), angles)
        points, angles = np.broadcast_arrays(points, angles)
        x, y, z = points[..., 0], points[..., 1], points[..., 2]
        forearms = points[..., None, :] - self.elbows(angles)
        jq = self._jq(forearms, angles)
        type_1 = type_1_margins(self.arms, x, y, z, jq, reserve=TYPE_1_RESERVE)
        held = np.stack(
            (-stiffness(unit(forearms)), stiffness(self.couples(points, angles))), axis=-1
        )
        type_2 = (self.handedness * held - TYPE_2_RESERVE) * self.type_2_scale
        return np.concatenate((type_1, type_2), axis=-1)

    def kernel(self, bounds: Bounds) -> Kernel:
        """Compiled functions for the tool tip; numba is imported here, and not before."""
        from deltaviz.mechanism.rotary_delta_kernel import rotary_delta_kernel

        return rotary_delta_kernel(self, bounds)

    @property
    def joint_scale(self) -> tuple[float, ...]:
        """mm of travel per rad of each joint, about: the upper arms."""
        return self.upper_arm

    @property
    def type_1_scale(self) -> tuple[float, ...]:
        return tuple(arm.type_1_scale for arm in self.arms)

    @cached_property
    def type_2_scale(self) -> float:
        """mm per unit of stiffness where the forearms lie flat: l/√3."""
        return sum(self.forearm) / 3 / math.sqrt(3)

    def _solve(self, points: Array) -> Array:
        theta = self._angles(points, clamp=False)
        theta += theta.sum(axis=-1, keepdims=True) * 0.0  # one NaN makes the row NaN
        return theta

    def _angles(self, points: Array, *, clamp: bool) -> Array:
        x, y, z = points[..., 0], points[..., 1], points[..., 2]
        return arm_angles(self.arms, x, y, z, clamp=clamp)

    def _meet(self, elbows: Array) -> Array:
        one, two, three = (
            (elbows[..., i, 0], elbows[..., i, 1], elbows[..., i, 2]) for i in range(3)
        )
        a, b = minus(two, one), minus(three, one)
        n = cross(a, b)
        square = dot(n, n)
        l1, l2, l3 = (fore * fore for fore in self.forearm)
        a_square, b_square = dot(a, a), dot(b, b)
        along_a = (a_square + (l1 - l2)) / (2 * square)
        along_b = (b_square + (l1 - l3)) / (2 * square)
        across_b, across_a = cross(b, n), cross(n, a)
        w = tuple(along_a * p + along_b * q for p, q in zip(across_b, across_a, strict=True))
        height = l1 - dot(w, w)
        edge = MEET_ROUNDING * l1 * a_square * b_square / square
        height = np.where((height < 0) & (height >= -edge), 0.0, height)
        height = np.where(square > (UNDETERMINED * l1) ** 2, height, np.nan)
        h = self.handedness * np.sqrt(height / square)
        return np.stack([d + u - v * h for d, u, v in zip(one, w, n, strict=True)], axis=-1)

    def _jq(self, forearms: Array, theta: Array) -> Array:
        out = np.empty(np.broadcast_shapes(forearms.shape[:-1], theta.shape))
        for i, arm in enumerate(self.arms):
            outward = forearms[..., i, 0] * arm.cos + forearms[..., i, 1] * arm.sin
            turned = outward * np.sin(theta[..., i]) + forearms[..., i, 2] * np.cos(theta[..., i])
            out[..., i] = -arm.upper_arm * turned
        return out

    def _check(self) -> None:
        for i, arm in enumerate(self.arms):
            if arm.offset <= -arm.upper_arm:
                most = self.base_radius[i] + arm.upper_arm
                raise GeometryError(
                    "effector_radius",
                    self.effector_radius[i],
                    f"must be less than base_radius + upper_arm ({most:g}): the elbow of arm "
                    f"{i + 1} could never stand outside the effector's joint",
                )
            if abs(arm.offset) >= arm.upper_arm + arm.forearm:
                raise GeometryError(
                    "base_radius",
                    self.base_radius[i],
                    "must differ from effector_radius by less than upper_arm + forearm "
                    f"({arm.upper_arm + arm.forearm:g}): arm {i + 1} cannot close",
                )
            for other in self.arms[:i]:
                apart = abs(math.remainder(arm.azimuth - other.azimuth, 2 * math.pi))
                if apart < LEAST_SEPARATION:
                    raise GeometryError(
                        "azimuths_deg",
                        list(self.azimuths_deg),
                        "must be three directions at least 1° apart",
                    )
