"""A robot's workspace: what it reaches, how far, what fits inside, and how well it moves there."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from deltaviz.mechanism.arrays import Array
from deltaviz.robots.robot import Robot
from deltaviz.robots.workspace.boundary import Boundary
from deltaviz.robots.workspace.cells import Box, hull
from deltaviz.robots.workspace.empty import why_empty
from deltaviz.robots.workspace.extent import ReachAtHeight, extents, reach_at
from deltaviz.robots.workspace.field import Field, Grid, sample
from deltaviz.robots.workspace.fit import Fit, fit
from deltaviz.robots.workspace.inscribed import Body, largest
from deltaviz.robots.workspace.levels import levels
from deltaviz.robots.workspace.limits import Limit, not_considered
from deltaviz.robots.workspace.margins import Margins
from deltaviz.robots.workspace.quality import Quality, quality
from deltaviz.robots.workspace.shapes import Belt, Cuboid, Cylinder, Shape
from deltaviz.robots.workspace.sketch import Wanted
from deltaviz.robots.workspace.stems import Stem
from deltaviz.robots.workspace.stretch import Stretch, stretch

if TYPE_CHECKING:
    from matplotlib.figure import Figure

QUALITY_POINTS = 20_000
COUNTED = 40  # cells along the longest side, by which its size is guessed
HEIGHTS = 12
TOLERANCE = 1.0  # mm, without a wish
TOLERANCES = 150  # in a forearm, at least


def own_tolerance(robot: Robot) -> float:
    """How near the boundary of a robot's workspace is to the true one without a wish, mm: finer
    where a robot is so small that TOLERANCE would blur it."""
    return min(TOLERANCE, max(robot.mechanism.forearm) / TOLERANCES)


class Empty(ValueError):
    """Asked of a workspace that holds nothing; says why it is empty."""


@dataclass(frozen=True)
class Inscribed:
    """The largest shape that fits, as is proved; proved too: none has more than `most`: diameter
    or first side (mm) where a height was asked for, else volume (mm³; mm² in a plane)."""

    shape: Cylinder | Cuboid
    most: float


@dataclass(frozen=True)
class Workspace:
    """The set of tool tips that keep `limits`, in mm. What is asked for is computed then, and kept.

    `tolerance` is the boundary's; extents and what fits are found to a quarter of it.
    """

    robot: Robot
    limits: Limit = Limit.MACHINE
    tolerance: float = TOLERANCE
    threads: int = 1

    @cached_property
    def margins(self) -> Margins:
        return Margins.of(self.robot, self.limits)

    @property
    def considered(self) -> Limit:
        """Of `limits` those that count for this robot."""
        out = self.limits | Limit.REACH
        for limit in self.not_considered:
            out &= ~limit
        return out

    @property
    def not_considered(self) -> dict[Limit, str]:
        """The others, and why."""
        return not_considered(self.robot, self.limits)

    @cached_property
    def reason(self) -> str | None:
        """Why it is empty; None if it is not."""
        if self._hull is not None and len(self.boundary.faces):
            return None
        return why_empty(self.robot, self.limits) or "Nothing within reach was found."

    @property
    def empty(self) -> bool:
        return self.reason is not None

    @cached_property
    def boundary(self) -> Boundary:
        """Within `tolerance` of the true one, as its `deviation` tells."""
        *_, last = levels(self.robot, self.limits, tolerance=self.tolerance, threads=self.threads)
        return last

    @property
    def volume(self) -> float:
        """mm³ (mm² in a plane); off by at most the boundary's area times its deviation."""
        return self.boundary.volume

    @cached_property
    def extents(self) -> Box:
        """Each side at most a quarter of the tolerance inside the true one, as is proved."""
        found = extents(self.margins, self.box, tolerance=self.fine)
        if found is None:
            raise Empty(self.reason)
        return found

    @property
    def box(self) -> Box:
        """Proved to hold all of the workspace. Raises Empty."""
        if self._hull is None:
            raise Empty(self.reason)
        return self._hull

    @property
    def fine(self) -> float:
        return self.tolerance / 4

    def field(self, cell: float) -> Field:
        """Margins at the nodes of a grid, at whole multiples of `cell` mm."""
        return sample(self.margins, Grid.around(self.box, cell), threads=self.threads)

    def reach(self, heights: Sequence[float] | None = None) -> list[ReachAtHeight]:
        """How far around the vertical line through the origin, at heights (mm) or at round ones."""
        if heights is None:
            heights = round_heights(float(self.extents.low[-1]), float(self.extents.high[-1]))
        return reach_at(self.margins, self.box, heights, tolerance=self.fine)

    def largest_cylinder(
        self,
        *,
        height: float | None = None,
        floor: float | None = None,
        centre: Sequence[float] | None = (0.0, 0.0),
    ) -> Inscribed | None:
        """Upright, about the vertical line through `centre` (x, y), or with None about any.

        With `height` the widest of that height, else that of the largest volume; with `floor` it
        stands there (z). None if nothing fits.
        """
        if self.margins.dimensions == 2:
            raise ValueError("in a plane there are no cylinders; ask for a box")
        body = self._largest(Stem(2, (0, 1)), height, floor, centre)
        if body is None:
            return None
        shape = Cylinder(
            2 * body.thickness, body.end - body.start, body.start, tuple(body.centre.tolist())
        )
        return Inscribed(shape, 2 * body.bound if height is not None else math.pi * body.bound)

    def largest_box(
        self,
        *,
        height: float | None = None,
        floor: float | None = None,
        centre: Sequence[float] | None = None,
        aspect: float = 1.0,
    ) -> Inscribed | None:
        """Sides along the axes, the one along y `aspect` times that along x; else as
        `largest_cylinder`. In a plane a rectangle."""
        across = tuple(range(self.margins.dimensions - 1))
        sides = (1.0, aspect)[: len(across)]
        if centre is not None:
            centre = tuple(centre)[: len(across)]
        body = self._largest(
            Stem(self.margins.dimensions - 1, across, sides), height, floor, centre
        )
        if body is None:
            return None
        size = tuple(2 * side * body.thickness for side in sides)
        shape = Cuboid(size, body.end - body.start, body.start, tuple(body.centre.tolist()))
        area = math.prod(2 * side for side in sides)
        return Inscribed(shape, 2 * body.bound if height is not None else area * body.bound)

    def fit(self, shape: Shape) -> Fit:
        """Whether a shape in its place fits, by how much, and what decides where."""
        return fit(self.margins, shape, tolerance=self.fine)

    def serve(self, belt: Belt) -> Stretch:
        """Which stretch of a belt is within reach over its whole width."""
        return stretch(self.margins, self.box, belt, tolerance=self.fine)

    def quality(self, points: ArrayLike | None = None) -> Quality:
        """Of tool tips (..., d), or of the grid points that `inside` gives."""
        return quality(self.robot, self.inside() if points is None else points)

    def inside(self, count: int = QUALITY_POINTS) -> Array:
        """About `count` grid points of the workspace, (n, d). Raises Empty."""
        dimensions = self.margins.dimensions
        coarse = self.field(float(self.box.size.max()) / COUNTED)
        size = (coarse.value >= 0).sum() * coarse.grid.cell**dimensions
        if not size:
            raise Empty(self.reason)
        field = self.field(float(size / count) ** (1 / dimensions))
        return field.grid.low + field.grid.cell * np.argwhere(field.value >= 0)

    def plot(self, path: str | None = None, *, colour: str | None = None) -> Figure:
        """The boundary in space and along the axes, or sections coloured by a measure of
        `Quality`; written to `path` if that is given. Needs matplotlib."""
        from deltaviz.robots.workspace.plot import plot

        return plot(self, path, colour=colour)

    @cached_property
    def _hull(self) -> Box | None:
        return hull(self.margins)

    def _largest(
        self,
        stem: Stem,
        height: float | None,
        floor: float | None,
        centre: Sequence[float] | None,
    ) -> Body | None:
        if self._hull is None:
            return None
        place = None if centre is None else np.array(centre, dtype=np.float64)
        return largest(self.margins, self._hull, stem, Wanted(height, floor, place), self.fine)


def round_heights(low: float, high: float, count: int = HEIGHTS) -> list[float]:
    """About `count` multiples of a round step between two heights, from the top."""
    least = (high - low) / count
    power = 10.0 ** math.floor(math.log10(least)) if least > 0 else 1.0
    step = next(n * power for n in (1, 2, 5, 10) if n * power >= least)
    first, last = math.ceil(low / step), math.floor(high / step)
    return [step * n for n in range(last, first - 1, -1)]
