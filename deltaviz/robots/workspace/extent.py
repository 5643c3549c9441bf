"""How far a workspace extends: along the axes, and around the vertical line at each height."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from deltaviz.robots.workspace.cells import Box
from deltaviz.robots.workspace.margins import Margins
from deltaviz.robots.workspace.search import Along, Inward, Outward, Seek, search


@dataclass(frozen=True)
class ReachAtHeight:
    """Distances from the vertical line through the base's centre at one height, mm.

    `farthest`: of any point. `all_around`: the largest disc around the line that is reached
    whole; 0 where the line itself is out of reach. `nearest`: of any point, 0 on the line. None
    where nothing is reached.
    """

    z: float
    farthest: float | None
    all_around: float
    nearest: float | None


def extents(margins: Margins, box: Box, *, tolerance: float) -> Box | None:
    """The smallest axis-parallel box around the workspace, each side found within `tolerance` mm
    of the true one, from within; None if nothing is reached."""
    low, high = [], []
    for axis in range(margins.dimensions):
        lowest = search(margins, box, Along(axis, -1.0), Seek.INSIDE, tolerance=tolerance)
        highest = search(margins, box, Along(axis, 1.0), Seek.INSIDE, tolerance=tolerance)
        if not (lowest.exists and highest.exists):
            return None
        low.append(-lowest.value)
        high.append(highest.value)
    return Box(np.array(low), np.array(high))


def reach_at(
    margins: Margins, box: Box, heights: Sequence[float], *, tolerance: float
) -> list[ReachAtHeight]:
    """Each distance found within `tolerance` mm; `box` must hold the workspace."""
    return [_at_height(margins, box, float(z), tolerance) for z in heights]


def _at_height(margins: Margins, box: Box, z: float, tolerance: float) -> ReachAtHeight:
    slice_ = Box(np.append(box.low[:-1], z), np.append(box.high[:-1], z))
    centre = np.zeros(margins.dimensions - 1)
    farthest = search(margins, slice_, Outward(centre), Seek.INSIDE, tolerance=tolerance)
    if not farthest.exists:
        return ReachAtHeight(z, None, 0.0, None)
    nearest = search(margins, slice_, Inward(centre), Seek.INSIDE, tolerance=tolerance)
    gap = search(margins, slice_, Inward(centre), Seek.OUTSIDE, tolerance=tolerance)
    edge = min(float(np.abs([box.low[:-1], box.high[:-1]]).min()), farthest.value)
    return ReachAtHeight(
        z,
        farthest=farthest.value,
        all_around=max(0.0, -gap.bound) if gap.exists else edge,
        nearest=-nearest.value if nearest.exists else None,
    )
