"""Families of shapes that grow about a line along one axis: by a length and a thickness."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from deltaviz.mechanism.arrays import Array
from deltaviz.robots.workspace.cells import Box, Cells

FAR = 1e9  # mm: beyond every workspace
CORNERS = 8  # so many directions, or a multiple, hold those to a box's corners


@dataclass(frozen=True)
class Stem:
    """Bodies about lines along `axis`.

    `across` are the axes in which a body has its thickness; its half sides there are `half` times
    the thickness, or with None it is round and the thickness its radius. Along axes that are
    neither it reaches from end to end of a given box.
    """

    axis: int
    across: tuple[int, ...]
    half: tuple[float, ...] | None = None

    @property
    def power(self) -> int:
        """Of the thickness in the volume."""
        return len(self.across)

    @property
    def sides(self) -> Array:
        return np.ones(len(self.across)) if self.half is None else np.array(self.half)

    def distance(self, offsets: Array) -> Array:
        """(..., len(across)) from the line to (...): the thickness that touches there."""
        if self.half is None:
            return np.linalg.norm(offsets, axis=-1)
        return (np.abs(offsets) / self.sides).max(axis=-1)

    def most(self, box: Box, centre: Array) -> float:
        """The thickness of the body about a line that just stays within a box."""
        across = list(self.across)
        room = np.minimum(centre - box.low[across], box.high[across] - centre)
        return float((room / self.sides).min(initial=math.inf))

    def rims(self, angles: Array) -> Array:
        """(...) directions, rad, to offsets across (..., len(across)) to the surface of the body
        of thickness 1. With one axis across a direction has but a sign."""
        ways = np.stack((np.cos(angles), np.sin(angles)), axis=-1)[..., : len(self.across)]
        if self.half is None:
            return ways
        largest = np.abs(ways).max(axis=-1, keepdims=True, initial=0.0)
        return ways / np.maximum(largest, 1e-30) * self.sides

    def angles(self, count: int) -> Array:
        """About `count` directions, evenly spaced, a box's corners among them."""
        if len(self.across) < 2:
            return np.array((np.pi, 0.0))[: 1 + len(self.across)]
        return np.linspace(0, 2 * np.pi, CORNERS * round(count / CORNERS), endpoint=False)


@dataclass(frozen=True)
class Within:
    """How deep inside a body points lie, as the gain of a search; infinite ends do not count."""

    stem: Stem
    centre: Array
    start: float
    end: float
    thickness: float

    def value(self, points: Array) -> Array:
        aside = self.stem.distance(points[:, list(self.stem.across)] - self.centre)
        place = points[:, self.stem.axis]
        ends = np.minimum(place - self.start, self.end - place)
        return np.minimum(self.thickness - aside, ends)

    def best(self, cells: Cells) -> Array:
        points, across, axis = cells.centres.copy(), list(self.stem.across), self.stem.axis
        half = cells.half[across]
        points[:, across] = np.clip(self.centre, points[:, across] - half, points[:, across] + half)
        middle = self._middle()
        half_along = cells.half[axis]
        points[:, axis] = np.clip(
            middle, points[:, axis] - half_along, points[:, axis] + half_along
        )
        return points

    def _middle(self) -> float:
        """Of the ends that count; with one, or none, anything that is far enough from it."""
        start = self.start if np.isfinite(self.start) else min(self.end, 0.0) - FAR
        end = self.end if np.isfinite(self.end) else max(self.start, 0.0) + FAR
        return (start + end) / 2
