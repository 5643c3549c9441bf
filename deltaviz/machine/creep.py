"""Motion of a robot that does not know its pose: single joints, slowly, by counts alone.

It stands in for the follower until the robot is homed. There is no geometry to check: what
limits it is the speed below which nothing breaks, and the person who watches.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from deltaviz.motion.goal import AtJointVelocity, Goal
from deltaviz.motion.held import Held
from deltaviz.motion.knot import Knot
from deltaviz.robots import Robot

GENTLY = 0.25  # share of the joint's acceleration limit


class Creep:
    """Ramps each joint to the velocity asked for, at most the unhomed one (rad/s)."""

    def __init__(self, robot: Robot, theta: Sequence[float], *, period: float = 0.010) -> None:
        self.theta = tuple(theta)
        self.velocity = tuple(0.0 for _ in theta)
        self._period = period
        self._axes = len(robot.axes)
        self._fastest = tuple(robot.limits.joint.unhomed_velocity)
        self._step = tuple(a * GENTLY * period for a in robot.limits.joint.acceleration)

    @property
    def resting(self) -> bool:
        return not any(self.velocity)

    @property
    def held_by(self) -> tuple[Held, ...]:
        return ()

    @property
    def xyz(self) -> tuple[float, ...]:
        """Unknown."""
        return (math.nan,) * self._axes

    target_xyz = xyz

    @property
    def target_theta(self) -> tuple[float, ...]:
        return self.theta

    def step(self, goal: Goal, *, override: float = 1.0) -> Knot:
        """One period further; anything but a joint velocity means rest."""
        still = tuple(0.0 for _ in self.theta)
        asked = goal.theta if isinstance(goal, AtJointVelocity) else still
        before = self.velocity
        self.velocity = tuple(
            v + max(-step, min(step, max(-fast, min(fast, want * override)) - v))
            for v, want, fast, step in zip(before, asked, self._fastest, self._step, strict=True)
        )
        self.theta = tuple(
            p + 0.5 * (v0 + v1) * self._period
            for p, v0, v1 in zip(self.theta, before, self.velocity, strict=True)
        )
        return Knot(self._period, self.theta, self.velocity)
