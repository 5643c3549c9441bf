"""How near a robot's own parts come to each other: found by looking, not proved."""

from __future__ import annotations

import itertools
from dataclasses import dataclass, replace

import numpy as np

from deltaviz.mechanism.arrays import Array
from deltaviz.robots.robot import Robot
from deltaviz.robots.workspace.cells import hull
from deltaviz.robots.workspace.collisions import Part
from deltaviz.robots.workspace.field import Grid, sample
from deltaviz.robots.workspace.limits import Limit
from deltaviz.robots.workspace.margins import Margins

CELLS = 60  # along the longest side
CLOSEST = 20  # places from where a nearer one is looked for
LAST_STEP = 0.01  # mm


@dataclass(frozen=True)
class Nearest:
    """`gap` mm between two `parts` with the tool tip at `point`; negative, they overlap."""

    gap: float
    point: Array
    parts: tuple[Part, Part]


def nearest_parts(robot: Robot, limits: Limit = Limit.ALL) -> Nearest | None:
    """The smallest gap over all points that keep the other limits. None if the robot file tells
    no thicknesses, or nothing is within reach."""
    with_gaps = Margins.of(robot, limits | Limit.COLLISIONS)
    margins = replace(with_gaps, collisions=None)
    box = hull(margins)
    if box is None or with_gaps.collisions is None:
        return None
    field = sample(margins, Grid.around(box, float(box.size.max()) / CELLS))
    points = field.grid.low + field.grid.cell * np.argwhere(field.value >= 0)
    if not len(points):
        return None
    gap, _ = with_gaps.gaps(points)
    points = points[np.argsort(gap)[:CLOSEST]]
    step = field.grid.cell
    ways = np.array(list(itertools.product((-1.0, 0.0, 1.0), repeat=with_gaps.dimensions)))
    while step > LAST_STEP:
        tried = points[:, None] + step * ways
        gap, _ = with_gaps.gaps(tried.reshape(-1, with_gaps.dimensions))
        legal = margins.least(tried) >= 0
        gap = np.where(legal, gap.reshape(legal.shape), np.inf)
        best = gap.argmin(axis=1)
        moved = tried[np.arange(len(points)), best]
        step = step / 2 if (moved == points).all() else step
        points = moved
    gap, pair = with_gaps.gaps(points)
    nearest = int(gap.argmin())
    parts = with_gaps.parts(int(pair[nearest]))
    assert parts is not None
    return Nearest(float(gap[nearest]), points[nearest], parts)
