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
FEWER_STEPS = 4  # along a ray that ends where one beside it met the outside
DEEPEST = 8  # of the directions in which the outside comes nearest: so many are looked at closer


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
    margins: Margins,
    stem: Stem,
    box: Box,
    centre: Array,
    places: Array,
    rays: int,
    *,
    halvings: int = 0,
) -> Clearances:
    """In `rays` directions at each place, out to the sides of the box, which must hold the
    workspace except along axes that the stem fills: there five levels are looked at.

    Where the outside comes nearest the angle between rays is halved so many times: it may come
    nearer still between two.
    """
    most = stem.most(box, centre)
    if most <= 0:
        return Clearances(places, np.zeros(len(places)))
    directions = stem.angles(rays)
    angles = np.tile(directions, (len(places), 1))
    taken = _taken(margins, stem, box, centre, places, angles, np.full(angles.shape, most), STEPS)
    if halvings and len(stem.across) == 2:
        angles, taken = _deepest(angles, taken)
        step = 2 * np.pi / len(directions)
        for _ in range(halvings):
            step /= 2
            before = angles
            for shift in (-step, step):
                found = _taken(
                    margins, stem, box, centre, places, before + shift, taken, FEWER_STEPS
                )
                angles = np.where(found < taken, before + shift, angles)
                taken = np.minimum(found, taken)
    return Clearances(places, taken.min(axis=1))


def _deepest(angles: Array, taken: Array) -> tuple[Array, Array]:
    """Of each place (n, rays): the directions in which less is free than in those beside them."""
    beside = np.minimum(np.roll(taken, 1, axis=1), np.roll(taken, -1, axis=1))
    least = np.where(taken <= beside, taken, np.inf)
    order = np.argsort(least, axis=1)[:, :DEEPEST]
    return np.take_along_axis(angles, order, 1), np.take_along_axis(taken, order, 1)


def _taken(
    margins: Margins,
    stem: Stem,
    box: Box,
    centre: Array,
    places: Array,
    angles: Array,
    lengths: Array,
    steps: int,
) -> Array:
    """(n, rays) angles at n places, and how far to look, to where the outside begins."""
    rims = lengths[..., None] * stem.rims(angles)
    ends, line = _rays(stem, box, centre, places, rims)
    inside, outside, blocked = _first_outside(margins, line, ends, steps)
    touched = crossing(margins, inside, outside)
    way = outside - inside
    touched += way / np.maximum(np.linalg.norm(way, axis=-1, keepdims=True), 1e-30) * OUTWARD
    surely = np.where((margins.least(touched) < 0)[:, None], touched, outside)
    taken = np.repeat(lengths, len(ends) // lengths.size)
    taken[blocked] = stem.distance(surely[:, list(stem.across)] - centre)
    return taken.reshape(*lengths.shape, -1).min(axis=-1)


def _first_outside(
    margins: Margins, line: Array, ends: Array, steps: int
) -> tuple[Array, Array, NDArray[np.intp]]:
    """Of rays from a line: the last point seen before the first outside, that point, and which
    rays have one. Both are the same where the line itself is outside."""
    shares = np.linspace(0.0, 1.0, steps + 1)
    points = line[:, None] + (ends - line)[:, None] * shares[:, None]
    out = margins.least(points) < 0
    blocked = np.flatnonzero(out.any(axis=1))
    first = out[blocked].argmax(axis=1)
    before = np.maximum(first - 1, 0)
    return points[blocked, before], points[blocked, first], blocked


def _rays(stem: Stem, box: Box, centre: Array, places: Array, rims: Array) -> tuple[Array, Array]:
    """(ends of rays, their beginnings), (n, d) each, place by place; `rims` (n, rays, across)."""
    dimensions, across = len(box.low), list(stem.across)
    filled = [a for a in range(dimensions) if a != stem.axis and a not in across]
    levels = np.meshgrid(*[np.linspace(box.low[a], box.high[a], 5) for a in filled])
    levels = np.array(levels).reshape(len(filled), -1).T if filled else np.zeros((1, 0))
    ends = np.empty((*rims.shape[:2], len(levels), dimensions))
    ends[..., stem.axis] = places[:, None, None]
    ends[..., across] = (centre + rims)[:, :, None]
    ends[..., filled] = levels
    ends = ends.reshape(-1, dimensions)
    line = ends.copy()
    line[:, across] = centre
    return ends, line
