"""Where the camera stands so that the whole robot and its workspace are in the picture."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from deltaviz.scene.units import Array

FIELD_OF_VIEW = math.radians(35.0)
_AZIMUTH = math.radians(-62.0)  # where the camera stands, seen from above
_PLANAR_AZIMUTH = math.radians(-78.0)  # nearly square to the plane of x and z
_ELEVATION = math.radians(16.0)
_MARGIN = 1.08


@dataclass(frozen=True)
class Framing:
    """Camera and floor, in metres."""

    position: Array
    look_at: Array
    floor: float
    radius: float  # of the sphere that holds the robot


def frame(*, reach: float, depth: tuple[float, float], planar: bool = False) -> Framing:
    """A view of a robot whose elbows stand out by `reach` and whose tool works at the heights
    `depth` (low, high); metres. A planar one is seen from the front."""
    low, high = depth
    top, floor = 0.22 * reach, low - 0.12 * (high - low) - 0.05 * reach
    centre = np.array((0.0, 0.0, (top + low) / 2))
    radius = math.hypot(0.86 * reach, (top - low) / 2)
    distance = _MARGIN * radius / math.sin(FIELD_OF_VIEW / 2)
    azimuth = _PLANAR_AZIMUTH if planar else _AZIMUTH
    away = np.array(
        (
            math.cos(_ELEVATION) * math.cos(azimuth),
            math.cos(_ELEVATION) * math.sin(azimuth),
            math.sin(_ELEVATION),
        )
    )
    return Framing(position=centre + distance * away, look_at=centre, floor=floor, radius=radius)
