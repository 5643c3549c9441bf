"""Derivatives by differences, to hold Jacobians to."""

from __future__ import annotations

from typing import Any

import numpy as np
from hypothesis import assume

STEP = 1e-4  # rad
GENTLE = 500.0  # mm/rad; steeper slopes are near type 2 and change fast: they get shorter steps


def assert_jacobian_is_the_slope_of_forward(robot: Any, theta: Any) -> None:
    """By central differences of the fourth order."""
    jacobian = robot.jacobian(theta)
    for joint, turn in enumerate(np.eye(robot.joints)):
        column = jacobian[:, joint]
        step = STEP * min(1.0, GENTLE / np.abs(column).max())
        poses = robot.forward([theta + count * step * turn for count in (-2, -1, 1, 2)])
        assume(np.isfinite(poses).all())
        slope = (poses[0] - 8 * poses[1] + 8 * poses[2] - poses[3]) / (12 * step)
        assert np.abs(slope - column).max() < 1e-5 * (1 + np.abs(column).max())
