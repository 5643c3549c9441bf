"""How good a candidate is: pure, and the same wherever it is computed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum

import numpy as np

from deltaviz.mechanism import GeometryError
from deltaviz.mechanism.arrays import Array
from deltaviz.robots.design.candidate import Lengths, made
from deltaviz.robots.design.wish import Wish
from deltaviz.robots.robot import Robot
from deltaviz.robots.workspace.limits import Limit
from deltaviz.robots.workspace.margins import Margins

UNREACHED = 1e3  # above any score of a candidate that reaches everything
IMPOSSIBLE = 1e9


class Preference(Enum):
    """What the worst place of the body is judged by."""

    BOTH = "both"
    CONDITIONING = "conditioning"
    RESOLUTION = "resolution"

    @property
    def measures(self) -> tuple[str, ...]:
        return ("conditioning", "resolution") if self is Preference.BOTH else (self.value,)

    def of(self, condition: float, resolution: float) -> float:
        """The logarithm of the measure, or of their product."""
        values = {"conditioning": condition, "resolution": resolution}
        return sum(math.log(values[name]) for name in self.measures)


@dataclass(frozen=True)
class Task:
    """`reserve` mm is kept from every limit, `grain` mm is what lengths are rounded to."""

    template: Robot
    wish: Wish
    preference: Preference = Preference.BOTH
    grain: float = 0.5
    reserve: float = 0.0

    def lengths(self, numbers: Sequence[float]) -> Lengths:
        """What the search's numbers mean: rounded, and on the floor that was wished."""
        rounded = Lengths(*map(float, numbers)).rounded(self.grain)
        return rounded if self.wish.floor is None else replace(rounded, floor=self.wish.floor)


def score(task: Task, numbers: Sequence[float]) -> float:
    """Less is better; from UNREACHED on the body is not reached, by as many mm as are above it."""
    lengths = task.lengths(numbers)
    try:
        robot = made(task.template, lengths)
    except GeometryError:
        return IMPOSSIBLE
    points = task.wish.points()
    points[:, -1] += lengths.floor
    missing = task.reserve - least_margin(robot, points)
    if missing > 0:
        return UNREACHED + missing
    return task.preference.of(*worst(robot, points))


def least_margin(robot: Robot, points: Array) -> float:
    """mm, from all limits and between all parts; negative where a limit is broken."""
    least = float(robot.margins(points, robot.inverse(points)).min())
    if least < 0 or robot.bodies is None:
        return least
    gaps, _ = Margins.of(robot, Limit.REACH | Limit.COLLISIONS).gaps(points)
    return min(least, float(gaps.min()))


def worst(robot: Robot, points: Array) -> tuple[float, float]:
    """(conditioning, resolution in mm) where each is worst."""
    arms = robot.mechanism.joints
    jacobian = robot.jacobian(robot.inverse(points))[..., :arms]
    sigma = np.linalg.svd(jacobian, compute_uv=False)
    steps = np.asarray(robot.drive.microsteps_per_rad[:arms])
    step = np.linalg.svd(jacobian / steps, compute_uv=False)
    return float((sigma[:, 0] / sigma[:, -1]).max()), float(step[:, 0].max())
