"""Flat things that lie level in a workspace, paper or a table's top: how much of them is reached.

They are about the robot's axis, lengths in mm; robots in a plane have none.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from deltaviz.mechanism.arrays import Array
from deltaviz.mechanism.margin import Margin
from deltaviz.robots.workspace.cells import Box
from deltaviz.robots.workspace.crossing import crossing
from deltaviz.robots.workspace.margins import Margins
from deltaviz.robots.workspace.search import Seek, search
from deltaviz.robots.workspace.shapes import Depth, Shape

Flags = NDArray[np.bool_]

NODES = 241  # along a sheet's longest side
FEW = 15  # the same, while a height is looked for
HEIGHTS = 49
JUST_OUTSIDE = 1e-3  # mm


class Sheet(Shape, Protocol):
    """A convex shape without height; `depth` is how far inside its outline."""

    @property
    def level(self) -> float: ...


@dataclass(frozen=True)
class Disc:
    diameter: float
    level: float

    @property
    def box(self) -> Box:
        radius = self.diameter / 2
        return Box(np.array((-radius, -radius, self.level)), np.array((radius, radius, self.level)))

    @property
    def volume(self) -> float:
        return 0.0

    def depth(self, points: Array) -> Array:
        return self.diameter / 2 - np.linalg.norm(points[:, :2], axis=-1)


@dataclass(frozen=True)
class Rectangle:
    """Its sides `size` lie along x and y."""

    size: tuple[float, float]
    level: float

    @property
    def box(self) -> Box:
        x, y = (side / 2 for side in self.size)
        return Box(np.array((-x, -y, self.level)), np.array((x, y, self.level)))

    @property
    def volume(self) -> float:
        return 0.0

    def depth(self, points: Array) -> Array:
        return (np.array(self.size) / 2 - np.abs(points[:, :2])).min(axis=-1)


@dataclass(frozen=True)
class Chart:
    """A sheet's points on a grid from edge to edge: `x` (n,), `y` (m,); their least margins
    (m, n), at least 0 within reach; which of them are `on` the sheet (m, n)."""

    level: float
    x: Array
    y: Array
    margin: Array
    on: Flags

    @classmethod
    def of(cls, margins: Margins, sheet: Sheet, nodes: int = NODES) -> Chart:
        box = sheet.box
        step = float(box.size.max()) / (nodes - 1)
        x, y = (
            np.linspace(low, high, max(2, round((high - low) / step) + 1))
            for low, high in zip(box.low[:2], box.high[:2], strict=True)
        )
        points = np.stack((*np.meshgrid(x, y), np.full((len(y), len(x)), sheet.level)), axis=-1)
        on = sheet.depth(points.reshape(-1, 3)).reshape(points.shape[:-1]) >= -1e-9
        return cls(sheet.level, x, y, margins.least(points), on)

    @property
    def steps(self) -> tuple[float, float]:
        return float(self.x[1] - self.x[0]), float(self.y[1] - self.y[0])

    @property
    def reached(self) -> Flags:
        return self.on & (self.margin >= 0)

    @property
    def share(self) -> float:
        """Of the sheet's area that is within reach; a node at the edge stands for half as much."""
        columns, rows = np.ones(len(self.x)), np.ones(len(self.y))
        columns[[0, -1]] = rows[[0, -1]] = 0.5
        weight = self.on * rows[:, None] * columns
        return float((weight * self.reached).sum() / weight.sum())

    def place(self, row: int, column: int) -> Array:
        return np.array((self.x[column], self.y[row], self.level))


@dataclass(frozen=True)
class Miss:
    """The point of a sheet that is farthest from what is within reach of it: `out` mm; there,
    `limit` ends the workspace."""

    point: Array
    out: float
    limit: Margin


def farthest(margins: Margins, chart: Chart) -> Miss | None:
    """None where all of a sheet is within reach, or nothing."""
    from scipy.ndimage import distance_transform_edt

    reached = chart.reached
    if not reached.any() or not (chart.on & ~reached).any():
        return None
    away, nearest = distance_transform_edt(
        ~reached, sampling=chart.steps[::-1], return_indices=True
    )  # type: ignore[misc]
    row, column = np.unravel_index(np.argmax(np.where(chart.on, away, -1.0)), away.shape)
    point = chart.place(int(row), int(column))
    inner = chart.place(*nearest[:, row, column].tolist())
    edge = crossing(margins, inner[None], point[None])[0]
    way = point - edge
    out = float(np.linalg.norm(way))
    _, code = margins.nearest(edge + way * min(1.0, JUST_OUTSIDE / max(out, JUST_OUTSIDE)))
    return Miss(point, out, margins.names[int(code)])


def spare(margins: Margins, sheet: Sheet, *, tolerance: float = 0.05) -> float:
    """By how much (mm) a sheet could grow on all sides, as is proved, to `tolerance`; negative if
    it would have to shrink. At most half its longest side."""
    box = sheet.box
    around = float(box.size.max()) / 2 * np.array((1.0, 1.0, 0.0))
    region = Box(box.low - around, box.high + around)
    deepest = search(margins, region, Depth(sheet), Seek.OUTSIDE, tolerance=tolerance)
    return float(around[0]) if deepest.point is None else -deepest.bound


def best_level(margins: Margins, box: Box, sheet_at: Callable[[float], Sheet]) -> float:
    """The height at which most of a sheet is within reach; of several, the middle one. `box` must
    hold the workspace."""
    levels = np.linspace(box.low[2], box.high[2], HEIGHTS)
    shares = np.array([Chart.of(margins, sheet_at(float(z)), FEW).share for z in levels])
    best = np.flatnonzero(shares >= shares.max() - 1e-9)
    return float(levels[best[len(best) // 2]])
