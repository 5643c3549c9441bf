"""Shapes that a person wants to fit into a workspace; upright, lengths in mm."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from deltaviz.mechanism.arrays import Array
from deltaviz.robots.workspace.cells import Box, Cells


class Shape(Protocol):
    """A convex body in its place."""

    @property
    def box(self) -> Box:
        """The smallest axis-parallel box around it."""
        ...

    @property
    def volume(self) -> float: ...

    def depth(self, points: Array) -> Array:
        """(n, d) to (n,): how far inside, negative outside, where it is no more than the
        distance."""
        ...


@dataclass(frozen=True)
class Cylinder:
    """About a vertical line through `centre` (x, y), standing on `floor` (z)."""

    diameter: float
    height: float
    floor: float
    centre: tuple[float, ...] = (0.0, 0.0)

    @property
    def box(self) -> Box:
        radius = self.diameter / 2
        centre = np.array(self.centre)
        return Box(
            np.append(centre - radius, self.floor),
            np.append(centre + radius, self.floor + self.height),
        )

    @property
    def volume(self) -> float:
        return math.pi * self.diameter**2 / 4 * self.height

    def depth(self, points: Array) -> Array:
        radius = np.linalg.norm(points[:, :2] - np.array(self.centre), axis=-1)
        return np.minimum(self.diameter / 2 - radius, _between(points, self.floor, self.height))

    def __str__(self) -> str:
        return (
            f"cylinder {_size(self.diameter)} mm across and {_size(self.height)} mm high"
            f"{_about(self.centre)}, {_between_heights(self.floor, self.height)}"
        )


@dataclass(frozen=True)
class Cuboid:
    """Its sides `size` lie along x and y (along x alone in a plane); `centre` is theirs."""

    size: tuple[float, ...]
    height: float
    floor: float
    centre: tuple[float, ...]

    @property
    def box(self) -> Box:
        centre, half = np.array(self.centre), np.array(self.size) / 2
        return Box(
            np.append(centre - half, self.floor), np.append(centre + half, self.floor + self.height)
        )

    @property
    def volume(self) -> float:
        return math.prod(self.size) * self.height

    def depth(self, points: Array) -> Array:
        aside = np.abs(points[:, :-1] - np.array(self.centre))
        across = (np.array(self.size) / 2 - aside).min(axis=-1)
        return np.minimum(across, _between(points, self.floor, self.height))

    def __str__(self) -> str:
        sides = " by ".join(_size(side) for side in (*self.size, self.height))
        name = "rectangle" if len(self.size) == 1 else "box"
        heights = _between_heights(self.floor, self.height)
        return f"{name} of {sides} mm{_about(self.centre)}, {heights}"


@dataclass(frozen=True)
class Belt:
    """A conveyor: as long as can be along `axis` (0: x, 1: y), so what counts is the stretch of it
    that is served over the whole `width` and from `floor` up to `height` above it. `offset` is
    where its middle runs on the axis across. It fits if that stretch is at least `stretch` long.

    In a plane it runs along x, and its width counts for nothing.
    """

    width: float
    height: float
    floor: float
    axis: int = 0
    offset: float = 0.0
    stretch: float = 0.0

    def __str__(self) -> str:
        along = "xy"[self.axis]
        heights = _between_heights(self.floor, self.height)
        return f"belt {_size(self.width)} mm wide along {along}, {heights}"


@dataclass(frozen=True)
class Depth:
    """How far inside a shape, as the gain of a search."""

    shape: Shape

    def value(self, points: Array) -> Array:
        return self.shape.depth(points)

    def best(self, cells: Cells) -> Array:
        """The point nearest to the shape's middle, coordinate by coordinate."""
        box = self.shape.box
        middle = (box.low + box.high) / 2
        return np.clip(middle, cells.centres - cells.half, cells.centres + cells.half)


def _between(points: Array, floor: float, height: float) -> Array:
    return np.minimum(points[:, -1] - floor, floor + height - points[:, -1])


def _about(centre: tuple[float, ...]) -> str:
    if not any(round(value, 1) for value in centre):
        return ""
    return f" about ({', '.join(map(_mm, centre))})"


def _between_heights(floor: float, height: float) -> str:
    return f"Z {_mm(floor)} to {_mm(floor + height)} mm" if height else f"at Z {_mm(floor)} mm"


def _mm(length: float) -> str:
    """To a tenth, without trailing zeros."""
    return f"{round(length, 1) + 0.0:.6g}"


def _size(length: float) -> str:
    """Of little more digits than a tenth, so that nothing seems to be 0."""
    return f"{length:.3g}" if length < 10 else _mm(length)
