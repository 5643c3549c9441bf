"""Velocities and accelerations between joints and tip, and how long the brake takes."""

from __future__ import annotations

import numpy as np

from deltaviz.motion.check_compiled import BRAKE_SHARE, SHORTEST_SEGMENT, TANGENT_STEP
from deltaviz.motion.followed import Array, Kernel


def brake_time(rate: Array, acceleration: Array) -> float:
    """The common time (s) in which all joints come to rest from `rate` (n,)."""
    return max(SHORTEST_SEGMENT, float(np.max(np.abs(rate) / acceleration)) / BRAKE_SHARE)


def drift(kernel: Kernel, theta: Array, rate: Array) -> Array:
    """The tip's acceleration (N, d) at constant joint velocity: (dJ/dt) thetadot."""
    ahead = theta + TANGENT_STEP * rate
    behind = theta - TANGENT_STEP * rate
    forward = kernel.tip_velocity(kernel.forward(ahead), ahead, rate)
    backward = kernel.tip_velocity(kernel.forward(behind), behind, rate)
    return (forward - backward) / (2 * TANGENT_STEP)


def tip_acceleration(kernel: Kernel, theta: Array, rate: Array, acceleration: Array) -> Array:
    """The tip's acceleration (d,) from the joints' state (n,)."""
    pose = theta[None, :]
    xyz = kernel.forward(pose)
    bent = drift(kernel, pose, rate[None, :])
    return (kernel.tip_velocity(xyz, pose, acceleration[None, :]) + bent)[0]


def joint_acceleration(kernel: Kernel, theta: Array, rate: Array, acceleration: Array) -> Array:
    """The joints' acceleration (n,) at which the tip accelerates at `acceleration` (d,)."""
    pose = theta[None, :]
    xyz = kernel.forward(pose)
    bent = drift(kernel, pose, rate[None, :])
    return kernel.joint_velocity(xyz, pose, acceleration[None, :] - bent)[0]
