"""The largest upright body within a workspace, and proof of how much larger none can be.

Rays from a line to points outside the workspace bound from above every body about it: none may
hold such a point. The best body between them is then searched for other points outside by
halving boxes, and shrunk until it is proved to hold none.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from deltaviz.mechanism.arrays import Array
from deltaviz.robots.workspace.cells import Box
from deltaviz.robots.workspace.clearances import Clearances, clearances
from deltaviz.robots.workspace.margins import Margins
from deltaviz.robots.workspace.places import places
from deltaviz.robots.workspace.search import Found, Seek, search
from deltaviz.robots.workspace.stems import Stem, Within

PLACES = 300  # along a line at the beginning
RAYS = 90  # from each
RAYS_IN_TURN = (90, 360, 360, 1440, 1440, 1440)
FINER = 12  # places put between those at either end of a body, time after time
ROUNDS = 5
STEP = 2  # tolerances: lines nearer than this are not told apart


@dataclass(frozen=True)
class Wanted:
    """What is given of a body: its length, where it starts, and where its line stands.

    What is None is to be chosen: so that the volume is largest, or with the length given the
    thickness.
    """

    length: float | None = None
    start: float | None = None
    centre: Array | None = None


@dataclass(frozen=True)
class Body:
    """Within the workspace, as is proved. Proved too is that no other is worth more than `bound`:
    is thicker, where the length was given, or else has a larger length times thickness to the
    power of the axes across."""

    centre: Array
    start: float
    end: float
    thickness: float
    bound: float
    touches: Array | None

    def worth(self, stem: Stem, wanted: Wanted) -> float:
        if wanted.length is not None:
            return self.thickness
        return (self.end - self.start) * self.thickness**stem.power


@dataclass(frozen=True)
class _Sketch:
    """A body between rays, with the places at its ends and those next to them; and what none
    about this line can be worth more than."""

    centre: Array
    start: float
    end: float
    thickness: float
    worth: float
    bound: float
    ends: tuple[tuple[float, float], ...]


def largest(
    margins: Margins, box: Box, stem: Stem, wanted: Wanted, tolerance: float
) -> Body | None:
    """`box` must hold the workspace. About a given line the bound is met within about
    `tolerance` mm; over all lines the bound is some hundredths wider. None if nothing fits."""
    if wanted.centre is not None:
        return _proved(margins, box, stem, wanted, wanted.centre, tolerance)
    # Collisions take long, and bind at few places: those lines are judged without.
    quick = replace(margins, collisions=None)
    starts, bound = places(quick, box, stem, wanted.length, wanted.start)
    best = max(
        (_glance(quick, box, stem, wanted, centre) for centre in starts),
        key=lambda sketch: sketch.worth,
    )
    step = float(box.size.max()) / 50
    while step > STEP * tolerance:
        tried = [
            _glance(quick, box, stem, wanted, best.centre + step * way)
            for way in _ways(len(stem.across))
        ]
        better = max(tried, key=lambda sketch: sketch.worth)
        if better.worth > best.worth:
            best = better
        else:
            step /= 2
    found = _proved(margins, box, stem, wanted, best.centre, tolerance)
    return None if found is None else replace(found, bound=max(bound, found.bound))


def _ways(dimensions: int) -> Iterator[Array]:
    for axis in range(dimensions):
        for sign in (1.0, -1.0):
            way = np.zeros(dimensions)
            way[axis] = sign
            yield way


def _glance(margins: Margins, box: Box, stem: Stem, wanted: Wanted, centre: Array) -> _Sketch:
    return _sketch(margins, box, stem, wanted, centre, rounds=2, rays=RAYS // 2, count=PLACES // 2)


def _proved(
    margins: Margins, box: Box, stem: Stem, wanted: Wanted, centre: Array, tolerance: float
) -> Body | None:
    """Sketches are shrunk on all sides that are free until they are proved to lie within; what
    the search by boxes finds joins what rays find, until it is no more than the tolerance.

    So a body of a given length is sketched that much longer.
    """
    whole = wanted.length is not None and wanted.start is not None
    spare = 0.0 if whole or wanted.length is None else 2 * tolerance
    best: Body | None = None
    bound = math.inf
    met = Clearances(np.empty(0), np.empty(0))
    for rays in RAYS_IN_TURN:
        sketch = _sketch(
            margins, box, stem, wanted, centre, rounds=ROUNDS, rays=rays, met=met, spare=spare
        )
        bound = min(bound, sketch.bound)
        if sketch.thickness <= 0 or sketch.end < sketch.start:
            break
        start = -math.inf if wanted.start is not None else sketch.start
        end = math.inf if whole else sketch.end
        inside = Within(stem, centre, start, end, sketch.thickness)
        deep = _deepest(margins, box, inside, sketch, tolerance / 2)
        shrunk = _shrunk(sketch, max(0.0, deep.bound), wanted, deep.point)
        if best is None or shrunk.worth(stem, wanted) > best.worth(stem, wanted):
            best = shrunk
        if deep.point is None:
            break
        if spare and 2 * deep.bound > spare:
            spare = 2.2 * deep.bound  # the search gave up early: leave it room at the ends
        elif deep.value <= tolerance:  # more rays would find no more
            break
        place = deep.point[[stem.axis]]
        aside = stem.distance(deep.point[list(stem.across)] - centre)
        met = met.joined(Clearances(place, np.array([float(aside)])))
    if best is None or best.thickness <= 0 or best.end <= best.start:
        return None
    return replace(best, bound=bound)


def _deepest(
    margins: Margins, box: Box, inside: Within, sketch: _Sketch, tolerance: float
) -> Found:
    region = Box(box.low.copy(), box.high.copy())
    stem = inside.stem
    across, half = list(stem.across), stem.sides * sketch.thickness
    region.low[stem.axis], region.high[stem.axis] = sketch.start, sketch.end
    region.low[across], region.high[across] = sketch.centre - half, sketch.centre + half
    return search(margins, region, inside, Seek.OUTSIDE, tolerance=tolerance, above=0.0)


def _shrunk(sketch: _Sketch, by: float, wanted: Wanted, point: Array | None) -> Body:
    """On all sides that may give; a given length is kept, or else it does not fit."""
    thick = sketch.thickness - by
    if wanted.length is None:
        start = sketch.start if wanted.start is not None else sketch.start + by
        return Body(sketch.centre, start, sketch.end - by, thick, math.inf, point)
    if wanted.start is not None:
        return Body(sketch.centre, sketch.start, sketch.end, thick, math.inf, point)
    middle = (sketch.start + sketch.end) / 2
    fits = sketch.end - sketch.start - 2 * by >= wanted.length
    start, end = middle - wanted.length / 2, middle + wanted.length / 2
    return Body(sketch.centre, start, end, thick if fits else 0.0, math.inf, point)


def _sketch(
    margins: Margins,
    box: Box,
    stem: Stem,
    wanted: Wanted,
    centre: Array,
    *,
    rounds: int,
    rays: int,
    count: int = PLACES,
    met: Clearances | None = None,
    spare: float = 0.0,
) -> _Sketch:
    low, high = float(box.low[stem.axis]), float(box.high[stem.axis])
    if wanted.start is not None:
        low = wanted.start
        high = low + wanted.length if wanted.length is not None else max(high, low)
    most = max(0.0, stem.most(box, centre))
    known = clearances(margins, stem, box, centre, np.linspace(low, high, count), rays)
    known = known if met is None else known.joined(met)
    for _ in range(rounds):
        sketch = _between(known, stem, wanted, centre, most, spare)
        finer = [np.linspace(a, b, FINER + 2)[1:-1] for a, b in sketch.ends if b > a]
        if not finer:
            break
        more = np.sort(np.concatenate(finer))
        known = known.joined(clearances(margins, stem, box, centre, more, rays))
    return _between(known, stem, wanted, centre, most, spare)


def _between(
    known: Clearances, stem: Stem, wanted: Wanted, centre: Array, most: float, spare: float
) -> _Sketch:
    t, taken = known.places, known.taken
    if wanted.length is not None and wanted.start is not None:
        thick = float(taken.min())
        return _Sketch(centre, float(t[0]), float(t[-1]), thick, thick, thick, ())
    if wanted.length is not None:
        return _of_length(t, taken, wanted.length, spare, centre, most)
    return _of_any_length(t, taken, stem.power, centre, most, fixed=wanted.start is not None)


def _of_length(
    t: Array, taken: Array, length: float, spare: float, centre: Array, most: float
) -> _Sketch:
    longer = length + spare
    starts = np.concatenate((t, t - longer))
    starts = starts[(starts >= t[0]) & (starts + longer <= t[-1])]
    if not len(starts):
        return _Sketch(centre, 0.0, -1.0, 0.0, 0.0, 0.0, ())
    first = np.searchsorted(t, starts, "left")
    after = np.searchsorted(t, starts + longer, "right")
    thick = [float(taken[a:b].min(initial=most)) for a, b in zip(first, after, strict=True)]
    best = int(np.argmax(thick))
    start, end = float(starts[best]), float(starts[best]) + longer
    # One that begins between two places holds those from the second up to the first's end.
    ahead = np.searchsorted(t, t[:-1] + length, "right")
    bound = max(float(taken[i + 1 : ahead[i]].min(initial=most)) for i in range(len(t) - 1))
    ends = [_around(t, start), _around(t, end)]
    for place, shift in ((start, longer), (end, -longer)):
        a, b = _around(t, place)
        ends.append((max(a + shift, float(t[0])), min(b + shift, float(t[-1]))))
    return _Sketch(centre, start, end, thick[best], thick[best], bound, tuple(ends))


def _around(t: Array, place: float) -> tuple[float, float]:
    """The places next to one on either side."""
    i = int(np.searchsorted(t, place))
    return float(t[max(i - 1, 0)]), float(t[min(i + 1, len(t) - 1)])


def _of_any_length(
    t: Array, taken: Array, power: int, centre: Array, most: float, *, fixed: bool
) -> _Sketch:
    best = (-1.0, 0, 0, 0.0)
    bound = float(np.diff(t).max(initial=0.0)) * most**power  # of one that holds no place
    before, after = np.concatenate((t[:1], t[:-1])), np.concatenate((t[1:], t[-1:]))
    for i in range(1 if fixed else len(t)):
        thick = np.minimum(np.minimum.accumulate(taken[i:]), most)
        worth = (t[i:] - t[i]) * thick**power
        j = int(worth.argmax())
        if worth[j] > best[0]:
            best = (float(worth[j]), i, i + j, float(thick[j]))
        # It may begin just after the place before, and end just before the place after.
        bound = max(bound, float(((after[i:] - before[i]) * thick**power).max()))
    worth, i, j, thick = best
    ends = () if fixed else ((float(before[i]), float(t[i])),)
    ends += ((float(t[j]), float(after[j])),)
    return _Sketch(centre, float(t[i]), float(t[j]), thick, worth, bound, ends)
