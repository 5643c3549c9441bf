"""Whether a designed robot reaches what was asked: proved, not sampled.

The search looks at points and numpy's margins; here boxes of the whole body are halved until each
is proved to be within reach, by the workspace's own compiled margins.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from deltaviz.robots.design.wish import Wish
from deltaviz.robots.robot import Robot
from deltaviz.robots.workspace.fit import Fit
from deltaviz.robots.workspace.quality import quality
from deltaviz.robots.workspace.workspace import Workspace

TOLERANCE = 0.4  # mm of the workspace; the fit is proved to a quarter of it
GRID = 24  # points along each side, where quality is looked at


@dataclass(frozen=True)
class Proof:
    """`condition` and `resolution` (mm) are the worst over a grid of the body."""

    fit: Fit
    condition: float
    resolution: float

    @property
    def holds(self) -> bool:
        return self.fit.fits


def prove(robot: Robot, wish: Wish, floor: float) -> Proof:
    """Under all limits of the machine, the collisions of its parts among them."""
    body = wish.at(floor)
    found = Workspace(robot, tolerance=TOLERANCE).fit(body)
    box = body.box
    sides = [np.linspace(low, high, GRID) for low, high in zip(box.low, box.high, strict=True)]
    points = np.stack(np.meshgrid(*sides), axis=-1).reshape(-1, len(sides))
    points = points[body.depth(points) >= -1e-9]
    measured = quality(robot, points)
    return Proof(found, float(np.max(measured.condition)), float(np.max(measured.resolution)))
