"""Where a robot loses control: the surfaces on which it is singular, near its workspace.

The workspace keeps a reserve from them, so they are looked for in all that the arms can reach.
Type 1: an arm is straight or folded, and there its reach ends; so this surface is the end of what
the arms reach together. Type 2: the forearms do not hold the effector.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum, auto
from itertools import islice

import numpy as np

from deltaviz.mechanism import FiveBar, RotaryDelta
from deltaviz.mechanism.arrays import Array
from deltaviz.robots.robot import Robot
from deltaviz.robots.workspace.boundary import Boundary, Faces, level_set
from deltaviz.robots.workspace.cells import hull
from deltaviz.robots.workspace.field import Grid
from deltaviz.robots.workspace.levels import levels
from deltaviz.robots.workspace.limits import Limit
from deltaviz.robots.workspace.margins import Margins
from deltaviz.robots.workspace.meshes import clipped, distance, halved
from deltaviz.robots.workspace.quality import type_2

NEAR = 0.15  # of the workspace's longest side: a surface farther from it is left out
CELLS = {3: 56, 2: 250}  # along that side, by the number of coordinates
ZERO = 1e-6  # what the measure may be on its surface: mm for type 1, a share for type 2
_STEPS = 6  # of Newton's method, from where the level set was found
_APART = 1e-3  # mm between the points that a slope is taken from
_ROUNDS, _TRIES, _STARTS = 10, 24, 20  # of the search for the point nearest to the workspace

Measure = Callable[[Array], Array]


class Kind(Enum):
    TYPE_1 = auto()
    TYPE_2 = auto()


@dataclass(frozen=True)
class Singular:
    """What of one kind's surface lies within `near` mm of the workspace or inside it.

    `vertices` (n, d) mm lie on it; `faces` (m, d) are triangles, or line segments in a plane.
    `distance` (mm) is how near it comes to the workspace, 0 if it enters; None if there is none.
    """

    vertices: Array
    faces: Faces
    distance: float | None
    near: float


@dataclass(frozen=True)
class _Search:
    """One kind of one robot. `measure` of tool tips (..., d) is 0 where singular, `reached` (...)
    at least 0 where the arms reach."""

    measure: Measure
    reached: Measure
    margins: Margins
    boundary: Boundary
    near: float

    def onto(self, points: Array, most: float) -> tuple[Array, Array, Array]:
        """Points moved along the slope to where the measure is 0, at most `most` mm a step; then
        a number at least 0 where they belong to what is looked for, and their distances from the
        workspace (mm), 0 inside."""
        for _ in range(_STEPS if len(points) else 0):
            points = points + _newton(self.measure, points, most)
        apart = self._apart(points)
        found = np.where(np.abs(self.measure(points)) <= ZERO, self.near, -self.near)
        return points, np.minimum.reduce((self.near - apart, found, self.reached(points))), apart

    def nearest(self, points: Array, apart: Array, cell: float) -> float:
        """The least distance from the workspace, looked for around the vertices that have it."""
        chance = np.random.default_rng(0)
        for number in range(_ROUNDS):
            best = np.argsort(apart)[:_STARTS]
            points, apart = points[best], apart[best]
            steps = chance.normal(size=(_TRIES, *points.shape)) * cell / 2**number
            tried, kept, away = self.onto((points + steps).reshape(-1, points.shape[1]), cell)
            points = np.concatenate((points, tried[kept >= 0]))
            apart = np.concatenate((apart, away[kept >= 0]))
        return float(apart.min())

    def _apart(self, points: Array) -> Array:
        if not len(points):
            return np.empty(0)
        outside = distance(points, self.boundary.vertices, self.boundary.faces)
        return np.where(self.margins.least(points) >= 0, 0.0, outside)


def singular(robot: Robot, kind: Kind, *, limits: Limit = Limit.MACHINE) -> Singular | None:
    """None if the workspace is empty. Takes some seconds."""
    margins = Margins.of(robot, limits)
    box = hull(margins)
    if box is None:
        return None
    size = float(box.size.max())
    *_, boundary = islice(levels(robot, limits), 2)
    reached = _reached(robot)
    measure = reached if kind is Kind.TYPE_1 else _held(robot)
    within = _everywhere if kind is Kind.TYPE_1 else reached
    search = _Search(measure, within, margins, boundary, NEAR * size)
    grid = Grid.around(box.grown(NEAR), size / CELLS[margins.dimensions])
    index, faces = level_set(measure(np.stack(np.meshgrid(*grid.axes, indexing="ij"), axis=-1)))
    vertices, kept, apart = search.onto(grid.low + grid.cell * index, grid.cell)
    if kind is Kind.TYPE_2:  # which lies along the end of reach and is cut off by it
        vertices, faces = halved(vertices, faces[(kept[faces] > -grid.cell).any(axis=1)])
        vertices, kept, apart = search.onto(vertices, grid.cell / 2)
    distance = None
    if (kept >= 0).any():
        distance = search.nearest(vertices[kept >= 0], apart[kept >= 0], grid.cell)
    return Singular(*clipped(vertices, faces, kept), distance, search.near)


def _everywhere(tips: Array) -> Array:
    return np.full(tips.shape[:-1], np.inf)


def _reached(robot: Robot) -> Measure:
    """Way (mm) of tips (..., d) to where the first arm is straight or folded, negative beyond."""
    mechanism, offset = _armed(robot), np.asarray(robot.tool_offset)
    return lambda tips: -np.maximum(*mechanism.misses(tips - offset)).max(axis=-1)


def _held(robot: Robot) -> Measure:
    """How firmly the forearms hold the effector at tips (..., d); beyond reach, about."""
    mechanism, offset = _armed(robot), np.asarray(robot.tool_offset)
    return lambda tips: type_2(mechanism, tips - offset, mechanism.nearest_angles(tips - offset))


def _armed(robot: Robot) -> RotaryDelta | FiveBar:
    mechanism = robot.mechanism
    if not isinstance(mechanism, RotaryDelta | FiveBar):
        raise TypeError(f"{robot.name}: what a {type(mechanism).__name__} loses is not known")
    return mechanism


def _newton(measure: Measure, points: Array, most: float) -> Array:
    """The step (n, d) towards 0 along the slope."""
    axes = _APART * np.eye(points.shape[1])
    slope = np.stack([measure(points + axis) - measure(points - axis) for axis in axes], axis=-1)
    slope /= 2 * _APART
    square = np.maximum((slope * slope).sum(axis=-1, keepdims=True), 1e-30)
    step = -measure(points)[:, None] * slope / square
    length = np.linalg.norm(step, axis=-1, keepdims=True)
    return step * np.minimum(1.0, most / np.maximum(length, 1e-12))
