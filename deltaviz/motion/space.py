"""The two spaces in which motion is planned: of the tool, and of the joints."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from deltaviz.motion.check_compiled import SAME_BRANCH
from deltaviz.motion.dynamics import joint_acceleration, tip_acceleration
from deltaviz.motion.followed import Array, Followed


@dataclass(frozen=True, slots=True)
class Group:
    """Axes of a space that share their limits: of the norm of what they do together."""

    part: slice
    velocity: float
    acceleration: float
    jerk: float


class CartesianSpace:
    """Poses of the tool: its tip in mm and, if it turns, its turn in mm of travel.

    Limits are norms over the tip's axes; the turn has its joint's.
    """

    unit = 1.0  # of this space per mm of travel

    def __init__(self, robot: Followed) -> None:
        self.kernel = robot.kernel
        self.axes = robot.joint_count
        self.tip_axes = len(robot.axes)
        limits, joint = robot.limits.cartesian, robot.limits.joint
        tip = slice(0, self.tip_axes)
        self.groups = [Group(tip, limits.velocity, limits.acceleration, limits.jerk)]
        for axis in range(self.tip_axes, self.axes):
            acceleration = joint.acceleration[axis] * robot.turn_scale
            self.groups.append(
                Group(
                    slice(axis, axis + 1),
                    joint.velocity[axis] * robot.turn_scale,
                    acceleration,
                    acceleration * limits.jerk / limits.acceleration,
                )
            )
        self.top = np.array([group.velocity for group in self.groups])

    def knots(self, q: Array, v: Array) -> tuple[Array, Array, Array]:
        """Angles, joint velocities and tip positions at each row of q and v; NaN out of reach."""
        theta = self.kernel.inverse(q)
        return theta, self.kernel.joint_velocity(q, theta, v), q

    def margins(self, q: Array) -> Array:
        """(N, m), -inf in rows that no angles reach."""
        return _without_nan(self.kernel.margins(q, self.kernel.inverse(q)))

    def state(self, theta: Array, rate: Array, acceleration: Array) -> tuple[Array, Array, Array]:
        """Position, velocity, acceleration here, from the joints' own."""
        pose = theta[None, :]
        xyz = self.kernel.forward(pose)
        velocity = self.kernel.tip_velocity(xyz, pose, rate[None, :])
        return xyz[0], velocity[0], tip_acceleration(self.kernel, theta, rate, acceleration)

    def joints(self, theta: Array, rate: Array, a: Array) -> Array:
        """The joints' acceleration for the acceleration `a` of this space."""
        return joint_acceleration(self.kernel, theta, rate, a)

    def share(self, v: Array) -> float:
        """How much of its limit the velocity `v` takes, of the group that takes most."""
        return max(float(np.linalg.norm(v[g.part])) / g.velocity for g in self.groups)


class JointSpace:
    """The joints' angles in rad. Limits are per joint.

    There is no limit on joint jerk; its ramps take as long as the Cartesian ones.
    """

    def __init__(self, robot: Followed) -> None:
        self.kernel = robot.kernel
        self.axes = robot.joint_count
        self.velocity = np.asarray(robot.limits.joint.velocity, dtype=float)
        self.acceleration = np.asarray(robot.limits.joint.acceleration, dtype=float)
        cartesian = robot.limits.cartesian
        self.jerk = self.acceleration * (float(cartesian.jerk) / float(cartesian.acceleration))
        self.unit = float(np.min(self.velocity)) / float(cartesian.velocity)
        least = (float(np.min(limit)) for limit in (self.velocity, self.acceleration, self.jerk))
        self.groups = [Group(slice(None), *least)]
        self.top = self.velocity

    def knots(self, q: Array, v: Array) -> tuple[Array, Array, Array]:
        return q, v, self.kernel.forward(q)

    def margins(self, q: Array) -> Array:
        xyz = self.kernel.forward(q)
        margins = _without_nan(self.kernel.margins(xyz, q))
        same = np.abs(self.kernel.inverse(xyz) - q).max(axis=1) < SAME_BRANCH
        margins[~same] = -np.inf
        return margins

    def state(self, theta: Array, rate: Array, acceleration: Array) -> tuple[Array, Array, Array]:
        return theta, rate, acceleration

    def joints(self, theta: Array, rate: Array, a: Array) -> Array:
        return a

    def share(self, v: Array) -> float:
        return float(np.max(np.abs(v) / self.velocity))


Space: TypeAlias = CartesianSpace | JointSpace


def _without_nan(margins: Array) -> Array:
    return np.where(np.isnan(margins), -np.inf, margins)
