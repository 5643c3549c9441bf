"""The extreme point of a workspace, or of what it lacks: found by halving boxes, with proof.

A box is dropped when all of it is proved to be of the wrong kind, or when nothing in it can be
better than a point already found. What is left at the end bounds what might have been missed.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum
from typing import Protocol

import numpy as np

from deltaviz.mechanism.arrays import Array
from deltaviz.robots.workspace.cells import Box, Cells
from deltaviz.robots.workspace.margins import Margins

BUDGET = 2_000_000  # boxes at once before a search gives up on its tolerance
FIRST = 8  # boxes along the longest side at the beginning


class Seek(Enum):
    INSIDE = "inside the workspace"
    OUTSIDE = "outside the workspace"


class Gain(Protocol):
    """What is to be as large as possible."""

    def value(self, points: Array) -> Array:
        """(n, d) to (n,)."""
        ...

    def best(self, cells: Cells) -> Array:
        """The point of each cell with the largest value, (n, d)."""
        ...


@dataclass(frozen=True)
class Found:
    """The best `point` found and its `value`; proved: nothing exceeds `bound`.

    Both are -inf, and there is no point, where it is proved that none exists; if only `value` is,
    none was found before the search gave up.
    """

    value: float
    bound: float
    point: Array | None

    @property
    def exists(self) -> bool:
        return self.point is not None


def search(
    margins: Margins,
    box: Box,
    gain: Gain,
    seek: Seek,
    *,
    tolerance: float,
    above: float = -math.inf,
    budget: int = BUDGET,
) -> Found:
    """The point of the box of the kind sought that has the largest gain, to `tolerance`.

    With `above`, nothing below it is looked for.
    """
    if box.empty:
        return Found(-math.inf, -math.inf, None)
    cells = Cells.of(box, max(float(box.size.max()), tolerance) / FIRST)
    value, point, given_up = -math.inf, None, -math.inf
    while len(cells):
        best = gain.best(cells)
        upper = gain.value(best)
        worth = upper > max(value + tolerance, above)
        cells, best, upper = cells[worth], best[worth], upper[worth]
        if not len(cells):
            break
        inside, outside = cells.judge(margins)
        right, wrong = (inside, outside) if seek is Seek.INSIDE else (outside, inside)
        open_ = ~(right | wrong)
        legal = margins.least(cells.centres[open_]) >= 0
        hits = cells.centres[open_][legal == (seek is Seek.INSIDE)]
        for points in (best[right], hits):
            value, point = _better(gain, points, value, point)
        if open_.sum() * 2 ** cells.centres.shape[1] > budget:
            given_up = max(given_up, float(upper[open_].max()))
            break
        cells = cells[open_].halved()
    bound = max(value + tolerance if point is not None else -math.inf, given_up)
    return Found(value, max(bound, above), point)


def _better(
    gain: Gain, points: Array, value: float, point: Array | None
) -> tuple[float, Array | None]:
    if not len(points):
        return value, point
    values = gain.value(points)
    first = int(values.argmax())
    return (float(values[first]), points[first]) if values[first] > value else (value, point)


@dataclass(frozen=True)
class Along:
    """The distance in a direction given by the axis and +1 or -1."""

    axis: int
    sign: float

    def value(self, points: Array) -> Array:
        return self.sign * points[:, self.axis]

    def best(self, cells: Cells) -> Array:
        points = cells.centres.copy()
        points[:, self.axis] += self.sign * cells.half[self.axis]
        return points


@dataclass(frozen=True)
class Outward:
    """The distance from a vertical line, `centre` (d - 1,)."""

    centre: Array

    def value(self, points: Array) -> Array:
        return np.linalg.norm(points[:, :-1] - self.centre, axis=-1)

    def best(self, cells: Cells) -> Array:
        points = cells.centres.copy()
        points[:, :-1] += np.where(points[:, :-1] < self.centre, -1.0, 1.0) * cells.half[:-1]
        return points


@dataclass(frozen=True)
class Inward:
    """The distance from a vertical line, counted negative: largest on it."""

    centre: Array

    def value(self, points: Array) -> Array:
        return -np.linalg.norm(points[:, :-1] - self.centre, axis=-1)

    def best(self, cells: Cells) -> Array:
        points = cells.centres.copy()
        low, high = points[:, :-1] - cells.half[:-1], points[:, :-1] + cells.half[:-1]
        points[:, :-1] = np.clip(self.centre, low, high)
        return points
