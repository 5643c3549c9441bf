"""How long a stretch of a belt a robot serves over the belt's whole width."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deltaviz.mechanism.arrays import Array
from deltaviz.mechanism.margin import Margin
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
ROUNDING = 1e-9
SEEN = 41  # points along each side of what ends a stretch


@dataclass(frozen=True)
class Stretch:
    """`start`..`end` along the belt is served over its whole width and height, as is proved; None
    if nothing is.

    A belt in its place that is `widest` mm wide is served for a millimetre's stretch about
    `widest_at`, as is proved too, and none wider than `none_wider`; infinite in a plane.
    `limits`: what ends the reach before `start` and after `end`; if nothing is served, to either
    side of the widest. None where it goes on.
    """

    belt: Belt
    start: float | None
    end: float | None
    widest: float
    none_wider: float
    widest_at: float | None
    limits: tuple[Margin | None, Margin | None]

    @property
    def length(self) -> float:
        return 0.0 if self.start is None or self.end is None else self.end - self.start

    @property
    def fits(self) -> bool:
        return self.length >= max(self.belt.stretch, LEAST - ROUNDING)

    @property
    def may_fit(self) -> bool:
        """Nor is it proved that nothing is served."""
        return self.start is None and self.widest < self.belt.width <= self.none_wider


def stretch(margins: Margins, box: Box, belt: Belt, *, tolerance: float = 0.5) -> Stretch:
    """`box` must hold the workspace; ends are found within about `tolerance` mm."""
    around = Box(box.low.copy(), box.high.copy())
    around.low[-1], around.high[-1] = belt.floor, belt.floor + belt.height
    across = tuple(a for a in range(margins.dimensions - 1) if a != belt.axis)
    stem, centre = Stem(belt.axis, across), np.full(len(across), belt.offset)
    body = None
    if across:
        body = largest(margins, around, stem, Wanted(length=LEAST, centre=centre), tolerance / 4)
    ends = _served(margins, around, stem, centre, belt.width / 2, tolerance)
    if body is not None and 2 * body.thickness >= belt.width and (
        ends is None or ends[1] - ends[0] < LEAST
    ):  # fmt: skip
        ends = body.start, body.end
    seen = _Beside(margins, around, stem, centre, 2 * tolerance)
    if ends is not None:
        limits = seen.beyond_ends(ends, belt.width / 2)
    elif body is not None:
        limits = seen.beyond_sides((body.start, body.end), body.bound)
    else:
        limits = None, None
    return Stretch(
        belt,
        *(ends or (None, None)),
        widest=(0.0 if body is None else 2 * body.thickness) if across else math.inf,
        none_wider=(0.0 if body is None else 2 * body.bound) if across else math.inf,
        widest_at=None if body is None else (body.start + body.end) / 2,
        limits=limits,
    )


@dataclass(frozen=True)
class _Beside:
    """What ends the reach a little, `by` mm, beyond a stretch."""

    margins: Margins
    box: Box
    stem: Stem
    centre: Array
    by: float

    def beyond_ends(
        self, ends: tuple[float, float], half: float
    ) -> tuple[Margin | None, Margin | None]:
        start, end = ends[0] - self.by, ends[1] + self.by
        aside = (-half, half)
        return self._limit((start, start), aside), self._limit((end, end), aside)

    def beyond_sides(
        self, ends: tuple[float, float], half: float
    ) -> tuple[Margin | None, Margin | None]:
        out = half + self.by
        return self._limit(ends, (-out, -out)), self._limit(ends, (out, out))

    def _limit(self, along: tuple[float, float], aside: tuple[float, float]) -> Margin | None:
        low, high = self.box.low.copy(), self.box.high.copy()
        low[self.stem.axis], high[self.stem.axis] = along
        across = list(self.stem.across)
        low[across], high[across] = self.centre + aside[0], self.centre + aside[1]
        axes = [np.linspace(a, b, SEEN if b > a else 1) for a, b in zip(low, high, strict=True)]
        points = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, len(axes))
        margin, code = self.margins.nearest(points)
        worst = int(margin.argmin())
        return self.margins.names[int(code[worst])] if margin[worst] < 0 else None


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
