"""How thick a body about a line may be at places along it: measured along rays."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deltaviz.mechanism.arrays import Array
from deltaviz.robots.workspace.cells import Box
from deltaviz.robots.workspace.crossing import crossing
from deltaviz.robots.workspace.margins import Margins
from deltaviz.robots.workspace.stems import Stem

OUTWARD = 1e-4  # mm, from a boundary point to one outside
STEPS = 16  # along each ray, in which the first point outside is looked for


@dataclass(frozen=True)
class Clearances:
    """At `places` (n,) along a line, in ascending order, a point outside the workspace lies at a
    distance `taken` (n,) from it: none nearer was found, which proves nothing."""

    places: Array
    taken: Array

    def joined(self, other: Clearances) -> Clearances:
        places = np.concatenate((self.places, other.places))
        order = np.argsort(places, kind="stable")
        return Clearances(places[order], np.concatenate((self.taken, other.taken))[order])


def clearances(
    margins: Margins, stem: Stem, box: Box, centre: Array, places: Array, rays: int
) -> Clearances:
    """In `rays` directions at each place, out to the sides of the box, which must hold the
    workspace except along axes that the stem fills: there five levels are looked at."""
    most = stem.most(box, centre)
    if most <= 0:
        return Clearances(places, np.zeros(len(places)))
    ends, line = _rays(stem, box, centre, places, most * stem.rims(rays))
    inside, outside, blocked = _first_outside(margins, line, ends)
    touched = crossing(margins, inside, outside)
    way = outside - inside
    touched += way / np.maximum(np.linalg.norm(way, axis=-1, keepdims=True), 1e-30) * OUTWARD
    surely = np.where((margins.least(touched) < 0)[:, None], touched, outside)
    reach = stem.distance(surely[:, list(stem.across)] - centre)
    taken = np.full(len(ends), most)
    taken[blocked] = reach
    return Clearances(places, taken.reshape(len(places), -1).min(axis=1))


def _first_outside(
    margins: Margins, line: Array, ends: Array
) -> tuple[Array, Array, NDArray[np.intp]]:
    """Of rays from a line: the last point seen before the first outside, that point, and which
    rays have one. Both are the same where the line itself is outside."""
    shares = np.linspace(0.0, 1.0, STEPS + 1)
    points = line[:, None] + (ends - line)[:, None] * shares[:, None]
    out = margins.least(points) < 0
    blocked = np.flatnonzero(out.any(axis=1))
    first = out[blocked].argmax(axis=1)
    before = np.maximum(first - 1, 0)
    return points[blocked, before], points[blocked, first], blocked


def _rays(stem: Stem, box: Box, centre: Array, places: Array, rims: Array) -> tuple[Array, Array]:
    """(ends of rays, their beginnings), (n, d) each, place by place."""
    dimensions, across = len(box.low), list(stem.across)
    filled = [a for a in range(dimensions) if a != stem.axis and a not in across]
    levels = np.meshgrid(*[np.linspace(box.low[a], box.high[a], 5) for a in filled])
    levels = np.array(levels).reshape(len(filled), -1).T if filled else np.zeros((1, 0))
    ends = np.empty((len(places), len(rims), len(levels), dimensions))
    ends[..., stem.axis] = places[:, None, None]
    ends[..., across] = (centre + rims)[None, :, None]
    ends[..., filled] = levels
    ends = ends.reshape(-1, dimensions)
    line = ends.copy()
    line[:, across] = centre
    return ends, line
