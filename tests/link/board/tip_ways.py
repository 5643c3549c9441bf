"""Ways of the tip whose joints are about as fast as they may be, all over the workspace."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from deltaviz.link.board.limits import Leeway, Limits
from deltaviz.link.board.parameters import Parameters
from deltaviz.link.board.queue import Knot
from deltaviz.link.board.tip import joint_knot, tip_of
from deltaviz.robots import Robot

TICK_HZ = 200_000


@dataclass(frozen=True)
class Way:
    """A cubic of the tip: mm, mm/s, s."""

    p0: np.ndarray
    v0: np.ndarray
    p1: np.ndarray
    v1: np.ndarray
    seconds: float

    @property
    def ticks(self) -> int:
        return round(self.seconds * TICK_HZ)

    @property
    def start(self) -> Knot:
        return knot(self.p0, self.v0)

    @property
    def end(self) -> Knot:
        return knot(self.p1, self.v1)

    def at(self, u: np.ndarray) -> np.ndarray:
        """Its points (..., 3) after the parts u of its time."""
        u, h = u[..., None], self.seconds
        by_velocity = h * u * (1 - u) * ((1 - u) * self.v0 - u * self.v1)
        return self.p0 + (self.p1 - self.p0) * u * u * (3 - 2 * u) + by_velocity


def knot(p: np.ndarray, v: np.ndarray) -> Knot:
    return Knot(
        tuple(round(float(x) * 256_000) for x in p),
        tuple(round(float(x) * 65_536) for x in v),
        cartesian=True,
    )


def leeway_of(parameters: Parameters, way: Way) -> Leeway:
    """Of an epoch that began where the way does."""
    rest = Knot(way.start.p, (0, 0, 0), cartesian=True)
    joints = joint_knot(parameters, rest)
    began = (0, 0, 0) if joints is None else joints.p
    return Leeway(began, Limits(parameters).outside(tip_of(rest)))


def ways(robot: Robot, count: int, *, seed: int) -> Iterator[Way]:
    """Speeds and accelerations of their joints are up to the limits, or a little more."""
    chance = np.random.default_rng(seed)
    top, pull = np.array(robot.limits.joint.velocity), np.array(robot.limits.joint.acceleration)
    while count > 0:
        theta = chance.uniform(robot.joints.min, robot.joints.max)
        p0 = robot.forward(theta)
        if np.isnan(p0).any() or not robot.reach(p0).legal:
            continue
        count -= 1
        jacobian = robot.mechanism.jacobian(theta)
        h = float(chance.choice([0.004, 0.008, 0.010, 0.020, 0.030, 0.050]))
        size = chance.choice([0.3, 0.8, 1.0, 1.0])
        v0 = jacobian @ (chance.uniform(-1, 1, 3) * top * size * chance.random())
        turn = jacobian @ (chance.uniform(-1, 1, 3) * pull * size)
        change = jacobian @ (chance.uniform(-1, 1, 3) * pull * size) * chance.choice([0, 1])
        v1 = v0 + (turn + change / 2) * h
        p1 = p0 + v0 * h + (turn / 2 + change / 6) * h * h
        yield Way(p0, v0, p1, v1, h)
