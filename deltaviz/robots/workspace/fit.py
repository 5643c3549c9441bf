"""Whether a shape in its place lies within a workspace, and if not, by how much and where."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from deltaviz.mechanism.arrays import Array
from deltaviz.mechanism.margin import Margin
from deltaviz.robots.workspace.cells import Box
from deltaviz.robots.workspace.margins import Margins
from deltaviz.robots.workspace.search import Seek, search
from deltaviz.robots.workspace.shapes import Depth, Shape

SAMPLES = 200_000  # points in which the unreached part is counted


@dataclass(frozen=True)
class Fit:
    """`clearance` mm: how much the shape could grow on all sides; negative, how much it would have
    to shrink. Proved: it lies between `clearance` and `clearance - uncertain`.

    `where` is the point that decides and `limit` what ends the workspace there; None when nothing
    does within the shape's own size. `unreached` is the share of the shape that lies outside.
    """

    shape: Shape
    clearance: float
    uncertain: float
    where: Array | None
    limit: Margin | None
    unreached: float

    @property
    def fits(self) -> bool:
        return self.clearance - self.uncertain >= 0.0


def fit(margins: Margins, shape: Shape, *, tolerance: float = 0.1) -> Fit:
    """Proved to `tolerance` mm: the search halves boxes until none could hold a deeper point of
    what is out of reach."""
    box = shape.box
    around = float(box.size.max()) / 2
    region = Box(box.low - around, box.high + around)
    deepest = search(margins, region, Depth(shape), Seek.OUTSIDE, tolerance=tolerance)
    if deepest.point is None:
        return Fit(shape, around, 0.0, None, None, 0.0)
    _, code = margins.nearest(deepest.point)
    return Fit(
        shape,
        clearance=-deepest.value,
        uncertain=deepest.bound - deepest.value,
        where=deepest.point,
        limit=margins.names[int(code)],
        unreached=_unreached(margins, shape) if deepest.bound > 0 else 0.0,
    )


def _unreached(margins: Margins, shape: Shape) -> float:
    """By counting on a grid."""
    box = shape.box
    sides = np.maximum(box.size, 1e-9)
    step = (np.prod(sides[box.size > 0]) / SAMPLES) ** (1 / max(1, (box.size > 0).sum()))
    axes = [
        low + (np.arange(n) + 0.5) * (side / n)
        for low, side, n in (
            (low, side, max(1, round(side / step)))
            for low, side in zip(box.low, box.size, strict=True)
        )
    ]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, len(axes))
    points = points[shape.depth(points) >= 0]
    return float((margins.least(points) < 0).mean()) if len(points) else 0.0
