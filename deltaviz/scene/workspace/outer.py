"""What a workspace cannot exceed, before it is computed."""

from __future__ import annotations

import numpy as np

from deltaviz.mechanism import FiveBar, RotaryDelta
from deltaviz.robots import Robot


def roughly(robot: Robot, axis: int) -> tuple[float, float]:
    """Its ends along an axis, in mm, from the arms' lengths alone."""
    zone, mechanism = robot.zone, robot.mechanism
    assert isinstance(mechanism, RotaryDelta | FiveBar)
    reach = float(np.max(np.add(mechanism.upper_arm, mechanism.forearm)))
    if axis == 2:
        return float(round(min(-reach, zone.z[0]))), float(round(max(0.0, zone.z[1])))
    return -float(round(reach)), float(round(reach))
