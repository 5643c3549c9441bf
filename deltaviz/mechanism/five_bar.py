"""The five-bar, or planar delta: two motors on the base, two forearms, a platform in their plane.

Two chains of a parallelogram each keep the platform level, so with its half width taken off the
base's, both forearms end in one point P, as the rotary delta's do. An arm is the delta's with
nothing sideways. With the elbow centres moved inward D_left and D_right, D = D_right - D_left,

    P = D_left + a D - (-D_z, D_x) √(l² - a² D²) / |D|,   a = (D² + l_left² - l_right²) / 2 D²
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from deltaviz.mechanism.arm import EPS, Arm, arm_angles, arm_misses, type_1_margins
from deltaviz.mechanism.arrays import Array, in_blocks, rows
from deltaviz.mechanism.bounds import Bounds
from deltaviz.mechanism.geometry import GeometryError, per_arm
from deltaviz.mechanism.kernel import Kernel
from deltaviz.mechanism.margin import Margin, MarginKind
from deltaviz.mechanism.stiffness import TYPE_1_RESERVE, TYPE_2_RESERVE, planar_stiffness, unit

MEET_ROUNDING = 16 * EPS  # of P's squared distance from the elbows' line, in l²
UNDETERMINED = 1e-12  # elbow centres nearer to each other than this, in forearms


@dataclass(frozen=True, init=False)
class FiveBar:
    """Geometry of a five-bar; all lengths in mm, one number per arm: (left, right).

    `base_half`: middle of the base to motor axis. `platform_half`: middle of the platform to the
    forearm's joint. Either may be 0. Coordinates are (x, z), x to the right and z up; angles are
    the delta's: 0 horizontal and outward, positive down.
    """

    base_half: tuple[float, ...]
    platform_half: tuple[float, ...]
    upper_arm: tuple[float, ...]
    forearm: tuple[float, ...]

    def __init__(
        self,
        *,
        base_half: float | Sequence[float],
        platform_half: float | Sequence[float],
        upper_arm: float | Sequence[float],
        forearm: float | Sequence[float],
    ) -> None:
        """Each length is one number for both arms or one per arm.

        Raises GeometryError, naming the field, its value and the rule.
        """
        fields = {
            "base_half": per_arm("base_half", base_half, arms=2, least=0.0),
            "platform_half": per_arm("platform_half", platform_half, arms=2, least=0.0),
            "upper_arm": per_arm("upper_arm", upper_arm, arms=2, above=0.0),
            "forearm": per_arm("forearm", forearm, arms=2, above=0.0),
        }
        for name, value in fields.items():
            object.__setattr__(self, name, value)
        self._check()

    @property
    def joints(self) -> int:
        return 2

    @property
    def axes(self) -> tuple[str, ...]:
        return ("X", "Z")

    @property
    def margin_names(self) -> tuple[Margin, ...]:
        return (*(Margin(MarginKind.TYPE_1, arm) for arm in range(2)), Margin(MarginKind.TYPE_2))

    @cached_property
    def arms(self) -> tuple[Arm, ...]:
        return tuple(
            Arm(
                offset=self.base_half[i] - self.platform_half[i],
                upper_arm=self.upper_arm[i],
                forearm=self.forearm[i],
                azimuth=azimuth,
            )
            for i, azimuth in enumerate((math.pi, 0.0))
        )

    @property
    def handedness(self) -> float:
        """The sign of type 2 margins, as the rotary delta's: here always 1."""
        return 1.0

    def inverse(self, xyz: ArrayLike) -> Array:
        """Joint angles of platform positions, (..., 2) mm to (..., 2) rad, both elbows outside.

        A row is NaN where an arm cannot reach. At the very edge of reach, where rounding
        decides, the edge's own angle is returned; it is determined only to about 3e-8 rad.
        """
        return in_blocks(self._solve, rows(xyz, 2, "xyz"))

    def solutions(self, xyz: ArrayLike) -> Array:
        """(..., 2, 2) rad: each arm's angle with the elbow outside, then with it inside.

        The four choices of a row per arm are the working modes; NaN for an arm out of reach.
        """
        x, y, z = _space(rows(xyz, 2, "xyz"))
        both = [arm_angles(self.arms, x, y, z, inside=inside) for inside in (False, True)]
        return np.stack(both, axis=-2)

    def nearest_angles(self, xyz: ArrayLike) -> Array:
        """As `inverse`, but an arm that cannot reach gets the angle that comes nearest."""
        return arm_angles(self.arms, *_space(rows(xyz, 2, "xyz")), clamp=True)

    def forward(self, theta: ArrayLike) -> Array:
        """Platform positions of joint angles, (..., 2) rad to (..., 2) mm, below the elbows.

        Of the two assemblies the working one: det Jx < 0. A row is NaN where the forearms
        cannot meet, or would meet everywhere.
        """
        return in_blocks(
            lambda block: self._meet(self.elbows(block), below=True), rows(theta, 2, "theta")
        )

    def assemblies(self, theta: ArrayLike) -> Array:
        """(..., 2, 2) mm: where the forearms meet below the elbows, then above."""
        elbows = self.elbows(theta)
        return np.stack([self._meet(elbows, below=below) for below in (True, False)], axis=-2)

    @np.errstate(all="ignore")
    def jacobian(self, theta: ArrayLike) -> Array:
        """d (x, z) / d theta, (..., 2) rad to (..., 2, 2) mm/rad; NaN where `forward` is, and
        at type 2 singularities."""
        angles = rows(theta, 2, "theta")
        elbows = self.elbows(angles)
        left, right = np.moveaxis(self._meet(elbows, below=True)[..., None, :] - elbows, -2, 0)
        jq = self._jq(np.stack((left, right), axis=-2), angles)
        det = left[..., 0] * right[..., 1] - left[..., 1] * right[..., 0]
        det = np.where(det == 0.0, np.nan, det)
        adjugate = np.stack(
            (
                np.stack((right[..., 1], -left[..., 1]), axis=-1),
                np.stack((-right[..., 0], left[..., 0]), axis=-1),
            ),
            axis=-2,
        )
        return adjugate * (jq / det[..., None])[..., None, :]

    @np.errstate(all="ignore")
    def elbows(self, theta: ArrayLike) -> Array:
        """Elbow centres moved inward by half the platform, (..., 2) rad to (..., 2, 2) mm."""
        angles = rows(theta, 2, "theta")
        out = np.empty((*angles.shape, 2))
        for i, arm in enumerate(self.arms):
            out[..., i, 0] = arm.cos * (arm.offset + arm.upper_arm * np.cos(angles[..., i]))
            out[..., i, 1] = -arm.upper_arm * np.sin(angles[..., i])
        return out

    def jq(self, xyz: ArrayLike, theta: ArrayLike) -> Array:
        """(..., 2) mm²/rad: positive with the elbow outside, 0 at type 1 singularities."""
        angles = rows(theta, 2, "theta")
        return self._jq(rows(xyz, 2, "xyz")[..., None, :] - self.elbows(angles), angles)

    def det_jx(self, xyz: ArrayLike, theta: ArrayLike) -> Array:
        """(...) mm²: determinant of the forearm vectors, 0 at type 2 singularities, negative in
        the working assembly."""
        left, right = np.moveaxis(rows(xyz, 2, "xyz")[..., None, :] - self.elbows(theta), -2, 0)
        return left[..., 0] * right[..., 1] - left[..., 1] * right[..., 0]

    def sideways(self, xyz: ArrayLike) -> Array:
        """(..., 0): nothing leans out of the plane."""
        return np.empty((*rows(xyz, 2, "xyz").shape[:-1], 0))

    def misses(self, xyz: ArrayLike) -> tuple[Array, Array]:
        """(too far, too near), each (..., 2) mm: how far each arm is from reaching; negative
        where it reaches."""
        return arm_misses(self.arms, *_space(rows(xyz, 2, "xyz")))

    @np.errstate(all="ignore")
    def margins(self, xyz: ArrayLike, theta: ArrayLike) -> Array:
        """(..., 3) as `margin_names`; NaN angles are replaced by those nearest to reaching.

        The discriminants are normalised, lowered by their reserve (see `stiffness`) and scaled
        to about 1 per mm. An arm whose elbow is inside is beyond its type 1 margin.
        """
        points = rows(xyz, 2, "xyz")
        angles = rows(theta, 2, "theta")
        angles = np.where(np.isnan(angles), self.nearest_angles(points), angles)
        points, angles = np.broadcast_arrays(points, angles)
        forearms = points[..., None, :] - self.elbows(angles)
        jq = self._jq(forearms, angles)
        type_1 = type_1_margins(self.arms, *_space(points), jq, reserve=TYPE_1_RESERVE)
        type_2 = (-planar_stiffness(unit(forearms)) - TYPE_2_RESERVE) * self.type_2_scale
        return np.concatenate((type_1, type_2[..., None]), axis=-1)

    def kernel(self, bounds: Bounds) -> Kernel:
        """Compiled functions for the tool tip; numba is imported here, and not before."""
        from deltaviz.mechanism.five_bar_kernel import five_bar_kernel

        return five_bar_kernel(self, bounds)

    @property
    def joint_scale(self) -> tuple[float, ...]:
        """mm of travel per rad of each joint, about: the upper arms."""
        return self.upper_arm

    @property
    def type_1_scale(self) -> tuple[float, ...]:
        return tuple(arm.type_1_scale for arm in self.arms)

    @cached_property
    def type_2_scale(self) -> float:
        """mm per unit of stiffness where the forearms lie flat: l/√2."""
        return sum(self.forearm) / 2 / math.sqrt(2)

    def _solve(self, points: Array) -> Array:
        theta = arm_angles(self.arms, *_space(points))
        theta += theta.sum(axis=-1, keepdims=True) * 0.0  # one NaN makes the row NaN
        return theta

    @np.errstate(all="ignore")
    def _meet(self, elbows: Array, *, below: bool) -> Array:
        left, right = elbows[..., 0, :], elbows[..., 1, :]
        d = right - left
        square = (d * d).sum(axis=-1)
        l1, l2 = (fore * fore for fore in self.forearm)
        along = (square + (l1 - l2)) / (2 * square)
        height = l1 - along * along * square
        height = np.where((height < 0) & (height >= -MEET_ROUNDING * (l1 + square)), 0.0, height)
        height = np.where(square > UNDETERMINED * UNDETERMINED * l1, height, np.nan)
        h = np.sqrt(height / square)[..., None] * (1.0 if below else -1.0)
        return left + along[..., None] * d - h * np.stack((-d[..., 1], d[..., 0]), axis=-1)

    def _jq(self, forearms: Array, theta: Array) -> Array:
        out = np.empty(np.broadcast_shapes(forearms.shape[:-1], theta.shape))
        for i, arm in enumerate(self.arms):
            outward = forearms[..., i, 0] * arm.cos
            turned = outward * np.sin(theta[..., i]) + forearms[..., i, 1] * np.cos(theta[..., i])
            out[..., i] = -arm.upper_arm * turned
        return out

    def _check(self) -> None:
        apart = sum(arm.offset for arm in self.arms)
        links = sum(self.upper_arm) + sum(self.forearm)
        if abs(apart) >= links:
            raise GeometryError(
                "base_half",
                list(self.base_half),
                f"must differ from platform_half by less than all arms together ({links:g}): "
                "the forearms cannot meet",
            )


def _space(points: Array) -> tuple[Array, Array, Array]:
    """(x, z) as the (x, y, z) that an arm takes."""
    x = points[..., 0]
    return x, np.zeros_like(x), points[..., 1]
