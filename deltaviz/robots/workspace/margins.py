"""How far tool tips are from the limits of a robot's workspace, and from which."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from deltaviz.mechanism import FiveBar, RotaryDelta, stiffness
from deltaviz.mechanism.arrays import Array, rows
from deltaviz.mechanism.bounds import ROUNDING
from deltaviz.mechanism.margin import Margin, MarginKind
from deltaviz.robots.robot import Robot
from deltaviz.robots.workspace import margins_compiled as compiled
from deltaviz.robots.workspace.collisions import Collisions, Part
from deltaviz.robots.workspace.limits import Limit


@dataclass(frozen=True)
class Margins:
    """The limits of one robot, for points by the million.

    A point belongs to the workspace where all its margins are at least 0. They are mm: exact
    distances from what limits arms, joints, ball joints and zone, about distances from the
    singularities' reserves. Points are tool tips (..., d), d = 2 for a robot in a plane.

    `names` are those of `margins_compiled`'s columns, then one for each pair of parts that could
    touch.
    """

    dimensions: int
    names: tuple[Margin, ...]
    arms: Array
    rest: Array
    off: Array
    collisions: Collisions | None

    @classmethod
    def of(cls, robot: Robot, limits: Limit = Limit.MACHINE) -> Margins:
        collisions = Collisions.of(robot) if Limit.COLLISIONS in limits else None
        pairs = 0 if collisions is None else len(collisions.pairs)
        return cls(
            dimensions=len(robot.tool_offset),
            names=(*_names(robot.mechanism.joints), *[Margin(MarginKind.COLLISION)] * pairs),
            arms=_arms(robot),
            rest=_rest(robot, limits),
            off=_off(robot, limits | Limit.REACH),
            collisions=collisions,
        )

    def least(self, points: ArrayLike) -> Array:
        """(..., d) to (...): the smallest margin, negative outside the workspace."""
        return self.nearest(points)[0]

    def nearest(self, points: ArrayLike) -> tuple[Array, NDArray[np.uint8]]:
        """(..., d) to the smallest margin and the index of its name, (...) each."""
        flat, shape = self._flat(points)
        value, code = np.empty(len(flat)), np.empty(len(flat), np.uint8)
        compiled.least(flat, self.arms, self.rest, self.off, value, code)
        inside = value >= 0
        gap, pair = self.gaps(flat[inside])
        closer = gap < value[inside]
        code[inside] = np.where(closer, pair, code[inside])
        value[inside] = np.where(closer, gap, value[inside])
        return value.reshape(shape), code.reshape(shape)

    def some(self, points: Array, which: NDArray[np.intp]) -> Array:
        """(n, d) and (n, k) indices of names, to those margins (n, k); infinite where a limit
        does not count."""
        flat, _ = self._flat(points)
        out = np.empty((len(flat), len(self.off)))
        compiled.every(flat, self.arms, self.rest, self.off, out)
        pairs = which - len(self.off)
        found = np.take_along_axis(out, np.where(pairs < 0, which, 0), axis=-1)
        if self.collisions is not None and (pairs >= 0).any():
            for column in range(which.shape[1]):
                gap = self.collisions.gaps(flat, pairs[:, column], self.arms, self.rest)
                found[:, column] = np.where(pairs[:, column] >= 0, gap, found[:, column])
        return found

    def gaps(self, xyz: Array) -> tuple[Array, NDArray[np.intp]]:
        """Tool tips (n, d), or (n, 3) for every robot, to the gap between the two parts that are
        nearest to touching, and the index of its name, (n,) each; infinite where collisions do
        not count."""
        if self.collisions is None or not len(xyz):
            return np.full(len(xyz), math.inf), np.zeros(len(xyz), np.intp)
        xyz = xyz if xyz.shape[1] == 3 else self._flat(xyz)[0]
        gap, _, pair = self.collisions.bounds(xyz, np.zeros(len(xyz)), self.arms, self.rest)
        return gap, pair + len(self.off)

    def parts(self, name: int) -> tuple[Part, Part] | None:
        """Which two parts the collision with this index of a name is between."""
        if self.collisions is None or name < len(self.off):
            return None
        return self.collisions.names(name - len(self.off))

    def bounds(self, points: ArrayLike, radius: ArrayLike) -> tuple[Array, Array]:
        """(lower, upper), (...) each, of balls around points: `lower` >= 0 proves that all of the
        ball lies within the workspace, `upper` < 0 that all of it lies outside."""
        flat, shape = self._flat(points)
        radii = np.ascontiguousarray(np.broadcast_to(radius, shape), dtype=np.float64).reshape(-1)
        lower, upper = np.empty(len(flat)), np.empty(len(flat))
        compiled.bounds(flat, radii, self.arms, self.rest, self.off, lower, upper)
        if self.collisions is not None:
            open_ = lower >= 0  # the others are not proved to be inside anyway
            low, high, _ = self.collisions.bounds(flat[open_], radii[open_], self.arms, self.rest)
            lower[open_] = np.minimum(lower[open_], low)
            upper[open_] = np.minimum(upper[open_], high)
        return lower.reshape(shape), upper.reshape(shape)

    def _flat(self, points: ArrayLike) -> tuple[Array, tuple[int, ...]]:
        """In three coordinates whatever the robot's: y is 0 in a plane."""
        tips = rows(points, self.dimensions, "points")
        flat = np.ascontiguousarray(tips.reshape(-1, self.dimensions))
        if self.dimensions == 2:
            flat = np.stack((flat[:, 0], np.zeros(len(flat)), flat[:, 1]), axis=-1)
        return flat, tips.shape[:-1]


def _names(arms: int) -> tuple[Margin, ...]:
    """In the order of `margins_compiled`'s columns."""
    kinds = MarginKind
    of_arms = (
        kinds.TYPE_1,  # the point too far away from an arm
        kinds.TYPE_1,  # too near
        kinds.JOINT_MIN,
        kinds.JOINT_MAX,
        kinds.BALL_JOINT,
        kinds.TYPE_1,  # its reserve
    )
    zone = (kinds.Z_MIN, kinds.Z_MAX, kinds.X_MIN, kinds.X_MAX, kinds.Y_MIN, kinds.Y_MAX)
    return (
        *(Margin(kind, arm) for kind in of_arms for arm in range(arms)),
        *map(Margin, (kinds.TYPE_2, kinds.PARALLELOGRAM, *zone, kinds.RADIUS)),
    )


def _armed(robot: Robot) -> RotaryDelta | FiveBar:
    mechanism = robot.mechanism
    if not isinstance(mechanism, RotaryDelta | FiveBar):
        raise TypeError(f"{robot.name}: the workspace of a {type(mechanism).__name__} is not known")
    return mechanism


def _arms(robot: Robot) -> Array:
    mechanism, lean = _armed(robot), robot.joints.ball_joint_max
    out = np.empty((mechanism.joints, compiled.ARM_NUMBERS))
    for i, arm in enumerate(mechanism.arms):
        low, high = robot.joints.min[i], robot.joints.max[i]
        beyond = (low + high) / 2 + math.pi
        out[i] = (
            arm.offset,
            arm.upper_arm,
            arm.forearm,
            arm.cos,
            arm.sin,
            *(
                function(angle)
                for angle in (low, high, beyond)
                for function in (math.cos, math.sin)
            ),
            float(high - low > math.pi),
            math.inf if lean is None else arm.forearm * math.sin(lean),
            mechanism.type_1_scale[i],
        )
    return out


def _rest(robot: Robot, limits: Limit) -> Array:
    reserves = (stiffness.TYPE_1_RESERVE, stiffness.TYPE_2_RESERVE)
    mechanism, zone, tool = _armed(robot), robot.zone, robot.tool_offset
    unbounded = (-math.inf, math.inf)
    return np.array(
        (
            *(tool if len(tool) == 3 else (tool[0], 0.0, tool[1])),
            mechanism.handedness,
            mechanism.type_2_scale,
            *(reserves if Limit.SINGULARITIES in limits else (0.0, 0.0)),
            ROUNDING,
            *zone.z,
            *(zone.x or unbounded),
            *(zone.y or unbounded),
            math.inf if zone.radius is None else zone.radius,
        )
    )


def _off(robot: Robot, limits: Limit) -> Array:
    """0 for each margin that counts, infinite for the others."""
    arms = robot.mechanism.joints
    of_arms = (
        Limit.REACH,
        Limit.REACH,
        Limit.JOINTS,
        Limit.JOINTS,
        Limit.BALL_JOINTS,
        Limit.SINGULARITIES,
    )
    needed = [limit for limit in of_arms for _ in range(arms)]
    needed += [Limit.REACH, Limit.SINGULARITIES, *[Limit.ZONE] * 7]
    return np.array([0.0 if limit in limits else math.inf for limit in needed])
