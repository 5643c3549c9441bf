"""The best body about a line, by what is known to be free at places along it.

A sketch holds none of the points outside that are known, and bounds from above what any body
about the line is worth; whether it lies within the workspace is for a search to prove.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deltaviz.mechanism.arrays import Array
from deltaviz.robots.workspace.cells import Box
from deltaviz.robots.workspace.clearances import Clearances
from deltaviz.robots.workspace.stems import Stem

PLACES = 300  # along a line at the beginning
PARTS = 4  # into which the way between two places is cut where a better body may end
MOST_CUT = 40  # ways in one round, those that promise most
MOST_PLACES = 5000  # along a line: a body that needs more is too flat to be bounded

Measure = Callable[[Array], Clearances]


@dataclass(frozen=True)
class Wanted:
    """What is given of a body: its length, where it starts, and where its line stands.

    What is None is to be chosen: so that the volume is largest, or with the length given the
    thickness.
    """

    length: float | None = None
    start: float | None = None
    centre: Array | None = None

    def worth(self, length: float, thickness: float, power: int) -> float:
        """What is to be as large as possible, of a body with `power` axes across."""
        return thickness if self.length is not None else length * thickness**power


@dataclass(frozen=True)
class Sketch:
    """None about this line is worth more than `bound`. `finer` are places at which to measure
    next if that is to be nearer to `worth`."""

    centre: Array
    start: float
    end: float
    thickness: float
    worth: float
    bound: float
    finer: Array

    @property
    def nothing(self) -> bool:
        return self.thickness <= 0 or self.end < self.start


NONE = np.empty(0)


def at_first(box: Box, stem: Stem, wanted: Wanted, count: int = PLACES) -> Array:
    """Places along the whole line, or where the body is to stand."""
    low, high = float(box.low[stem.axis]), float(box.high[stem.axis])
    if wanted.start is not None:
        low = wanted.start
        high = low + wanted.length if wanted.length is not None else max(high, low)
    return np.linspace(low, high, count)


def refined(
    known: Clearances,
    measure: Measure,
    stem: Stem,
    wanted: Wanted,
    centre: Array,
    most: float,
    *,
    rounds: int,
    slack: float,
    spare: float = 0.0,
) -> tuple[Sketch, Clearances]:
    """The sketch, and what is known after measuring where a body larger by `slack` mm might
    begin or end. None is thicker than `most`; a given length is made `spare` longer."""
    sketch = _between(known, stem, wanted, centre, most, slack, spare)
    for _ in range(rounds):
        fresh = np.setdiff1d(sketch.finer, known.places)
        if not len(fresh):
            break
        known = known.joined(measure(fresh))
        sketch = _between(known, stem, wanted, centre, most, slack, spare)
    return sketch, known


def _between(
    known: Clearances,
    stem: Stem,
    wanted: Wanted,
    centre: Array,
    most: float,
    slack: float,
    spare: float,
) -> Sketch:
    t, taken = known.places, known.taken
    if wanted.length is not None and wanted.start is not None:
        thick = float(taken.min())
        return Sketch(centre, float(t[0]), float(t[-1]), thick, thick, thick, NONE)
    if wanted.length is not None:
        return _of_length(t, taken, wanted.length, centre, most, slack, spare)
    return _of_any_length(t, taken, stem.power, centre, most, slack, wanted.start is not None)


def _of_length(
    t: Array, taken: Array, length: float, centre: Array, most: float, slack: float, spare: float
) -> Sketch:
    longer = length + spare
    starts = np.concatenate((t, t - longer))
    starts = starts[(starts >= t[0]) & (starts + longer <= t[-1])]
    if not len(starts):
        return Sketch(centre, 0.0, -1.0, 0.0, 0.0, 0.0, NONE)
    first = np.searchsorted(t, starts, "left")
    after = np.searchsorted(t, starts + longer, "right")
    thick = [float(taken[a:b].min(initial=most)) for a, b in zip(first, after, strict=True)]
    best = int(np.argmax(thick))
    start, worth = float(starts[best]), thick[best]
    # One that begins between two places holds those from the second up to the first's end.
    ahead = np.searchsorted(t, t[:-1] + length, "right")
    bounds = np.array([taken[i + 1 : ahead[i]].min(initial=most) for i in range(len(t) - 1)])
    ways = _promising(t, bounds, worth + slack)
    if np.diff(t)[bounds > worth + slack].sum() > MOST_PLACES * length:
        # It fits between places almost anywhere, where nothing bounds it: only a better one is
        # looked for, beside the best.
        ways = np.clip(np.searchsorted(t, start) + np.array((-1, 0)), 0, len(t) - 2)
    finer = [start, start + longer]
    for i in ways:
        cuts = np.linspace(t[i], t[i + 1], PARTS + 1)
        finer += [*cuts[1:-1], *(cuts + length)]
    places = np.unique(np.clip(finer, t[0], t[-1]))
    return Sketch(centre, start, start + longer, worth, worth, float(bounds.max()), places)


def _promising(t: Array, bounds: Array, goal: float) -> NDArray[np.intp]:
    """The ways between places at which more than the goal may be had, the best first."""
    order = np.argsort(bounds)[::-1][:MOST_CUT]
    shortest = 1e-9 * (t[-1] - t[0])
    return order[(bounds[order] > goal) & (np.diff(t)[order] > shortest)]


def _of_any_length(
    t: Array, taken: Array, power: int, centre: Array, most: float, slack: float, fixed: bool
) -> Sketch:
    """From each place to each."""
    before, after = np.concatenate((t[:1], t[:-1])), np.concatenate((t[1:], t[-1:]))
    rows = 1 if fixed else len(t)
    thick = np.zeros((rows, len(t)))
    for i in range(rows):
        thick[i, i:] = np.minimum(np.minimum.accumulate(taken[i:]), most)
    worth = (t - t[:rows, None]) * thick**power
    i, j = np.unravel_index(int(worth.argmax()), worth.shape)
    # It may begin just after the place before, and end just before the place after.
    bounds = (after - before[:rows, None]) * thick**power
    holds_no_place = float(np.diff(t).max(initial=0.0)) * most**power
    goal = float((t[j] - t[i] + slack) * (thick[i, j] + slack) ** power)
    finer = [
        *_cuts(t, _promising(t, bounds.max(axis=0)[:-1], goal)),
        *(() if fixed else _cuts(t, _promising(t, bounds.max(axis=1)[1:], goal))),
    ]
    return Sketch(
        centre,
        float(t[i]),
        float(t[j]),
        float(thick[i, j]),
        float(worth[i, j]),
        max(float(bounds.max()), holds_no_place),
        np.unique(finer),
    )


def _cuts(t: Array, ways: NDArray[np.intp]) -> list[float]:
    return [c for i in ways for c in np.linspace(t[i], t[i + 1], PARTS + 1)[1:-1].tolist()]
