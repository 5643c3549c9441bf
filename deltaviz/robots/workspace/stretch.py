"""How long a stretch of a belt a robot serves over the belt's whole width."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deltaviz.mechanism.arrays import Array
from deltaviz.robots.workspace.cells import Box
from deltaviz.robots.workspace.clearances import clearances
from deltaviz.robots.workspace.inscribed import largest
from deltaviz.robots.workspace.margins import Margins
from deltaviz.robots.workspace.search import Seek, search
from deltaviz.robots.workspace.shapes import Belt
from deltaviz.robots.workspace.sketch import Wanted
from deltaviz.robots.workspace.stems import FAR, Stem, Within

PLACES = 400
RAYS = 2
ROUNDS = 6
FINER = 3
LEAST = 1.0  # mm: a shorter stretch is none


@dataclass(frozen=True)
class Stretch:
    """`start`..`end` along the belt is served over its whole width and height, as is proved; None
    if nothing is. `widest`: the widest belt in its place that a millimetre's stretch is served of,
    mm; infinite in a plane."""

    belt: Belt
    start: float | None
    end: float | None
    widest: float

    @property
    def length(self) -> float:
        return 0.0 if self.start is None or self.end is None else self.end - self.start

    @property
    def fits(self) -> bool:
        return self.length >= max(self.belt.stretch, LEAST)


def stretch(margins: Margins, box: Box, belt: Belt, *, tolerance: float = 0.5) -> Stretch:
    """`box` must hold the workspace; ends are found within about `tolerance` mm."""
    around = Box(box.low.copy(), box.high.copy())
    around.low[-1], around.high[-1] = belt.floor, belt.floor + belt.height
    across = tuple(a for a in range(margins.dimensions - 1) if a != belt.axis)
    stem, centre = Stem(belt.axis, across), np.full(len(across), belt.offset)
    widest = math.inf
    if across:
        body = largest(margins, around, stem, Wanted(length=LEAST, centre=centre), tolerance / 4)
        widest = 0.0 if body is None else 2 * body.thickness
    ends = _served(margins, around, stem, centre, belt.width / 2, tolerance)
    return Stretch(belt, *(ends or (None, None)), widest=widest)


def _served(
    margins: Margins, box: Box, stem: Stem, centre: Array, thickness: float, tolerance: float
) -> tuple[float, float] | None:
    """The longest run of places at which the whole width is free, shrunk to what is proved."""
    if thickness > stem.most(box, centre):
        return None
    places = np.linspace(box.low[stem.axis], box.high[stem.axis], PLACES)
    for _ in range(ROUNDS):
        run = None
        for _ in range(FINER):  # the run ends somewhere between its last place and the next
            known = clearances(margins, stem, box, centre, places, RAYS)
            run = _longest(places, known.taken >= thickness)
            if run is None:
                return None
            places = _between_more(places, run)
        assert run is not None
        start, end = run
        region = Box(box.low.copy(), box.high.copy())
        across = list(stem.across)
        region.low[stem.axis], region.high[stem.axis] = start, end
        region.low[across], region.high[across] = centre - thickness, centre + thickness
        inside = Within(stem, centre, start, end, FAR)
        deep = search(margins, region, inside, Seek.OUTSIDE, tolerance=tolerance / 8, above=0.0)
        by = max(0.0, deep.bound)
        if deep.point is None or by <= tolerance:
            return (start + by, end - by) if end - start > 2 * by else None
        # Look again, closer to where the run really ends.
        place = float(deep.point[stem.axis])
        near = np.linspace(-1.0, 1.0, 41) * (places[1] - places[0])
        places = np.unique(np.concatenate((places, place + near)))
    return None


def _between_more(places: Array, run: tuple[float, float]) -> Array:
    """With more places just beyond either end of a run."""
    first, last = np.searchsorted(places, run)
    before, after = places[max(first - 1, 0)], places[min(last + 1, len(places) - 1)]
    more = np.linspace(before, run[0], 12), np.linspace(run[1], after, 12)
    return np.unique(np.concatenate((places, *more)))


def _longest(places: Array, free: NDArray[np.bool_]) -> tuple[float, float] | None:
    """(start, end) of the longest run of places that are free."""
    best: tuple[float, float] | None = None
    edges = np.flatnonzero(np.diff(np.concatenate(((False,), free, (False,)))))
    for first, after in edges.reshape(-1, 2):
        start, end = float(places[first]), float(places[after - 1])
        if end > start and (best is None or end - start > best[1] - best[0]):
            best = (start, end)
    return best
