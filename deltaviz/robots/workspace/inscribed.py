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
from deltaviz.robots.workspace.sketch import PLACES, Sketch, Wanted, at_first, refined
from deltaviz.robots.workspace.stems import Stem, Within

RAYS = 96  # from each place, all around
HALVINGS = 8  # of the angle between two rays where the outside comes nearest
TURNS = 16
ROUNDS = 8
SHARE = 1 / 4  # of the tolerance, that a sketch may leave open
LITTLE = 1 / 2  # of the tolerance, that a body whose length is given is sketched longer
BUDGET = 4_000_000  # boxes: along flat walls a search needs many
QUICK_BUDGET = 500_000  # while a body may yet be sketched longer instead
STEP = 2  # tolerances: lines nearer than this are not told apart


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

    def worth(self, stem: Stem, wanted: Wanted, more: float = 0.0) -> float:
        """Of a body that is `more` mm thicker and longer."""
        length = self.end - self.start + more
        return wanted.worth(length, self.thickness + more, stem.power)


def largest(
    margins: Margins, box: Box, stem: Stem, wanted: Wanted, tolerance: float
) -> Body | None:
    """`box` must hold the workspace. About a given line a thickness is within `tolerance` mm of
    the bound, unless the body is too flat to be bounded (`sketch.MOST_PLACES`); over all lines the
    bound is wider by some hundredths of the box. None if nothing fits."""
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


def _glance(margins: Margins, box: Box, stem: Stem, wanted: Wanted, centre: Array) -> Sketch:
    def measure(places: Array) -> Clearances:
        return clearances(margins, stem, box, centre, places, RAYS // 2)

    known = measure(at_first(box, stem, wanted, PLACES // 2))
    most = max(0.0, stem.most(box, centre))
    return refined(known, measure, stem, wanted, centre, most, rounds=2, slack=0.0)[0]


def _proved(
    margins: Margins, box: Box, stem: Stem, wanted: Wanted, centre: Array, tolerance: float
) -> Body | None:
    """Sketches are shrunk until they are proved to lie within; what the search by boxes finds
    joins what rays find, until it is no more than the tolerance.

    A given length is kept, so a body is shrunk across; but where an end lies along a wall, a
    little outside there would cost much across: it is sketched longer, to be shrunk there too.
    """

    def measure(places: Array) -> Clearances:
        return clearances(margins, stem, box, centre, places, RAYS, halvings=HALVINGS)

    most = max(0.0, stem.most(box, centre))
    known = measure(at_first(box, stem, wanted))
    best, bound, spare = None, math.inf, 0.0
    free_ends = wanted.length is not None and wanted.start is None
    for _ in range(TURNS):
        sketch, known = refined(
            known, measure, stem, wanted, centre, most,
            rounds=ROUNDS, slack=SHARE * tolerance, spare=spare,
        )  # fmt: skip
        bound = min(bound, sketch.bound)
        if sketch.nothing:
            break
        fine = min(tolerance / 2, spare / 4) if spare else tolerance / 2
        deep = _deepest(margins, box, stem, wanted, sketch, fine, spare)
        shrunk = _shrunk(sketch, max(0.0, deep.bound), wanted, spare, deep.point)
        if best is None or shrunk.worth(stem, wanted) > best.worth(stem, wanted):
            best = shrunk
        if bound <= best.worth(stem, wanted, tolerance):
            break
        gave_up = deep.bound > max(deep.value, 0.0) + 1.01 * fine
        if gave_up and (not free_ends or spare > 2 * deep.bound):
            break
        if free_ends and (gave_up or (not spare and _at_an_end(deep, stem, sketch, tolerance))):
            spare = 2.2 * deep.bound if spare else LITTLE * tolerance
        elif deep.point is None:
            break
        if deep.point is not None:
            place = deep.point[[stem.axis]]
            aside = stem.distance(deep.point[list(stem.across)] - centre)
            met = Clearances(place, np.array([float(aside)]))
            known = known.joined(met).joined(measure(place))
    if best is None or best.thickness <= 0 or best.end <= best.start:
        return None
    return replace(best, bound=bound)


def _at_an_end(deep: Found, stem: Stem, sketch: Sketch, tolerance: float) -> bool:
    if deep.point is None:
        return False
    place = float(deep.point[stem.axis])
    return min(place - sketch.start, sketch.end - place) < LITTLE * tolerance


def _deepest(
    margins: Margins,
    box: Box,
    stem: Stem,
    wanted: Wanted,
    sketch: Sketch,
    tolerance: float,
    spare: float,
) -> Found:
    """Of the points outside that a sketch holds, that which it must be shrunk by most to lose."""
    start, end = sketch.start, sketch.end
    if wanted.start is not None or (wanted.length is not None and not spare):
        start = -math.inf
    if wanted.length is not None and not spare:
        end = math.inf
    free_ends = wanted.length is not None and wanted.start is None
    budget = QUICK_BUDGET if free_ends and not spare else BUDGET
    inside = Within(stem, sketch.centre, start, end, sketch.thickness)
    region = Box(box.low.copy(), box.high.copy())
    across, half = list(stem.across), stem.sides * sketch.thickness
    region.low[stem.axis], region.high[stem.axis] = sketch.start, sketch.end
    region.low[across], region.high[across] = sketch.centre - half, sketch.centre + half
    return search(
        margins, region, inside, Seek.OUTSIDE, tolerance=tolerance, above=0.0, budget=budget
    )


def _shrunk(sketch: Sketch, by: float, wanted: Wanted, spare: float, point: Array | None) -> Body:
    """On all sides that may give; a given length is kept, or else it does not fit."""
    start, end, thick = sketch.start, sketch.end, sketch.thickness - by
    if wanted.length is None:
        start = start if wanted.start is not None else start + by
        end -= by
    elif wanted.start is None:
        middle = (start + end) / 2
        start, end = middle - wanted.length / 2, middle + wanted.length / 2
        thick = thick if 2 * by <= spare or not spare else 0.0
    return Body(sketch.centre, start, end, thick, math.inf, point)
