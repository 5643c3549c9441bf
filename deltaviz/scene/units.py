"""The scene is in metres, everything else in millimetres: the one place where that changes."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

MM_PER_M = 1000.0


def metres(mm: ArrayLike) -> Array:
    """Lengths of the robot, as lengths in the scene."""
    return np.asarray(mm, dtype=np.float64) / MM_PER_M


def millimetres(m: ArrayLike) -> Array:
    """Lengths in the scene, as lengths of the robot."""
    return np.asarray(m, dtype=np.float64) * MM_PER_M
