"""Families of shapes that grow about a line along one axis: by a length and a thickness."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from deltaviz.mechanism.arrays import Array
from deltaviz.robots.workspace.cells import Box, Cells

FAR = 1e9  # mm: beyond every workspace


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

    def rims(self, count: int) -> Array:
        """Offsets across to the surface of the body of thickness 1, in `count` directions."""
        if not self.across:
            return np.zeros((1, 0))
        if len(self.across) == 1:
            return np.array(((-1.0,), (1.0,))) * self.sides
        angle = np.linspace(0, 2 * np.pi, count, endpoint=False)
        circle = np.stack((np.cos(angle), np.sin(angle)), axis=-1)
        if self.half is None:
            return circle
        return circle / np.abs(circle).max(axis=-1, keepdims=True) * self.sides


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
