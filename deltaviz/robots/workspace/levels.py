"""A workspace's boundary, coarse at once and then finer: to follow a hand on a slider."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from deltaviz.robots.robot import Robot
from deltaviz.robots.workspace.boundary import Boundary, march
from deltaviz.robots.workspace.cells import hull
from deltaviz.robots.workspace.field import Grid, sample
from deltaviz.robots.workspace.limits import Limit
from deltaviz.robots.workspace.margins import Margins
from deltaviz.robots.workspace.refine import refine

COARSE = 36  # cells along the longest side
FINE = 80
ROUGH, ROUGH_SLACK = 24, 0.05  # cells, and share of the box that may be in vain
CELLS_PER_TOLERANCE = 16  # of the last level: a finer tolerance wants a finer grid
MOST_NODES = 8_000_000
ATTEMPTS = 2  # with half the cell each, where thin corners keep the mesh from the tolerance


def levels(
    robot: Robot, limits: Limit = Limit.MACHINE, *, tolerance: float = 1.0, threads: int = 1
) -> Iterator[Boundary]:
    """First a coarse boundary, within some hundredths of a second; then the same refined; then
    one within `tolerance` mm of the true one, as its `deviation` tells. Each is whole, and has no
    vertices if the workspace is empty. Stop asking and no more is computed.
    """
    margins = Margins.of(robot, limits)
    box = hull(margins)
    if box is None:
        yield nothing(margins, tolerance)
        return
    size = float(box.size.max())
    coarse = march(margins, sample(margins, Grid.around(box, size / COARSE), threads=threads))
    yield coarse
    yield refine(margins, coarse, max(tolerance, size / 500))
    cell = min(size / FINE, CELLS_PER_TOLERANCE * tolerance)
    smallest = float(np.prod(box.size) / MOST_NODES) ** (1 / len(box.size))
    for attempt in range(1, ATTEMPTS + 1):
        grid = Grid.around(box, max(cell, smallest))
        fine = refine(margins, march(margins, sample(margins, grid, threads=threads)), tolerance)
        if fine.deviation <= tolerance or cell <= smallest or attempt == ATTEMPTS:
            yield fine
            return
        cell /= 2


def rough(robot: Robot, limits: Limit = Limit.MACHINE) -> Boundary:
    """A coarse boundary in one to three hundredths of a second, for a hand that moves."""
    margins = Margins.of(robot, limits)
    box = hull(margins, slack=ROUGH_SLACK)
    if box is None:
        return nothing(margins, 1.0)
    return march(margins, sample(margins, Grid.around(box, float(box.size.max()) / ROUGH)))


def nothing(margins: Margins, cell: float) -> Boundary:
    """The boundary of an empty workspace."""
    return Boundary(
        vertices=np.empty((0, margins.dimensions)),
        faces=np.empty((0, margins.dimensions), np.int64),
        limits=np.empty(0, np.uint8),
        names=margins.names,
        cell=cell,
        deviation=0.0,
    )
