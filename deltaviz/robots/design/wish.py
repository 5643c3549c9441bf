"""What a robot is to reach: an upright body about the vertical axis, at a height or at any."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from deltaviz.mechanism.arrays import Array
from deltaviz.robots.robot import Zone
from deltaviz.robots.workspace.shapes import Cuboid, Cylinder

RIM, INNER = 72, 12  # directions in which a cylinder is looked at
LEVELS = 5
ACROSS = 11  # along each side of a box; in a plane there is time for more
ACROSS_PLANE = 41


@dataclass(frozen=True)
class Wish:
    """`body` stands on z = 0; `floor` (mm) is where it is to stand, None: wherever it is best."""

    body: Cylinder | Cuboid
    floor: float | None = None

    @property
    def dimensions(self) -> int:
        return 3 if isinstance(self.body, Cylinder) else len(self.body.size) + 1

    @property
    def span(self) -> float:
        """mm: its largest side."""
        return float(self.body.box.size.max())

    def at(self, floor: float) -> Cylinder | Cuboid:
        return replace(self.body, floor=floor)

    def points(self) -> Array:
        """(n, d) mm, standing on z = 0: its surface, densely at its edges, and some within."""
        if isinstance(self.body, Cylinder):
            across = _disc(self.body.diameter / 2)
        else:
            count = ACROSS_PLANE if len(self.body.size) == 1 else ACROSS
            sides = [np.linspace(-side / 2, side / 2, count) for side in self.body.size]
            across = np.stack(np.meshgrid(*sides), axis=-1).reshape(-1, len(sides))
        heights = np.linspace(0.0, self.body.height, LEVELS)
        return np.concatenate([_lifted(across, height) for height in heights.tolist()])

    def zone(self, floor: float) -> Zone:
        """The robot's own workspace, as its file has it: nothing but the body."""
        z = (floor, floor + self.body.height)
        if isinstance(self.body, Cylinder):
            return Zone(z=z, radius=self.body.diameter / 2)
        x, *y = ((-side / 2, side / 2) for side in self.body.size)
        return Zone(z=z, x=x, y=y[0] if y else None)


def _disc(radius: float) -> Array:
    rings = [(radius, RIM), (0.7 * radius, INNER), (0.35 * radius, INNER), (0.0, 1)]
    points: list[Array] = []
    for ring, count in rings:
        turn = np.arange(count) * (2 * math.pi / count)
        points.append(ring * np.stack((np.cos(turn), np.sin(turn)), axis=-1))
    return np.concatenate(points)


def _lifted(across: Array, height: float) -> Array:
    return np.concatenate((across, np.full((len(across), 1), height)), axis=-1)
