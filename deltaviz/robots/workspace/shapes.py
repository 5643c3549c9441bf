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
            f"cylinder of diameter {self.diameter:.6g} mm and height {self.height:.6g} mm"
            f"{_about(self.centre)}, Z {self.floor:.6g} to {self.floor + self.height:.6g} mm"
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
        sides = " by ".join(f"{side:.6g}" for side in self.size)
        return (
            f"box of {sides} by {self.height:.6g} mm{_about(self.centre)}, "
            f"Z {self.floor:.6g} to {self.floor + self.height:.6g} mm"
        )


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
        return (
            f"belt {self.width:.6g} mm wide along {along}, "
            f"Z {self.floor:.6g} to {self.floor + self.height:.6g} mm"
        )


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
    if not any(centre):
        return ""
    return f" about ({', '.join(f'{value:.6g}' for value in centre)})"
