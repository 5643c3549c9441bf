"""A robot as lines: base, arms and effector, at the pose where its homing ends."""

from __future__ import annotations

import numpy as np

from deltaviz.robots import Robot
from deltaviz.robots.coordinates import in_space
from deltaviz.scene.rig import Dimensions
from deltaviz.scene.units import Array, metres


def arms_outline(robot: Robot) -> Array:
    """(k, 2, 3): segments in metres."""
    d, ready = Dimensions.of(robot), robot.homing.ready
    theta = np.array(ready[: len(d.upper_arm)])[:, None]
    motors = d.outward * d.base_radius[:, None]
    down = np.array((0.0, 0.0, -1.0))
    elbows = motors + d.upper_arm[:, None] * (np.cos(theta) * d.outward + np.sin(theta) * down)
    tip = metres(in_space(tuple(robot.forward(ready).tolist())))
    wrists = tip - d.tool_offset + d.outward * d.effector_radius[:, None]
    pairs = ((motors, elbows), (elbows, wrists), _around(motors), _around(wrists))
    return np.concatenate([np.stack(pair, axis=1) for pair in pairs])


def _around(corners: Array) -> tuple[Array, Array]:
    return corners, np.roll(corners, -1, axis=0)
