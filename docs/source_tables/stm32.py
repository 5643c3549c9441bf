"""The STM32F407 library's numbers."""

from __future__ import annotations

import numpy as np

from deltaviz.mechanism import RotaryDelta


def scan(robot: RotaryDelta) -> tuple[np.ndarray, np.ndarray]:
    """Its scan: (m, 3) mm and (m, 3) rad, the points of its grid that the links reach."""
    axis, height = np.arange(-250.0, 251.0, 20.0), np.arange(-460.0, -99.0, 20.0)
    points = np.stack(np.meshgrid(axis, axis, height, indexing="ij"), axis=-1).reshape(-1, 3)
    points = points[np.hypot(points[:, 0], points[:, 1]) <= 250]
    theta = robot.inverse(points)
    reached = np.isfinite(theta).all(axis=-1)
    return points[reached], theta[reached]
