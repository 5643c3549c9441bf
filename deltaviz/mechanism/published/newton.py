"""Forward by Newton's method on the constraints themselves (the STM32F407 library)."""

from __future__ import annotations

import numpy as np

from deltaviz.mechanism.arrays import Array
from deltaviz.mechanism.published.legs import Legs, elbow_centres

MOST_STEPS = 60  # 5 to 7 do it, but where the forearms barely meet each step only halves the error
ARRIVED = 1e-13  # a step, in forearms


@np.errstate(all="ignore")
def newton(legs: Legs, theta: Array) -> Array:
    """(..., n) rad to (..., d) mm; NaN where it does not settle, as where forearms cannot meet.

    Solves |P - D_i|² = l_i² from a forearm's length below the elbows. After the first step the
    differences of the equations hold, and the rest is Newton on one quadratic, which stays on
    its side of the elbows.
    """
    centres = elbow_centres(legs, theta)
    squares = np.array([leg.fore**2 for leg in legs])
    scale = float(np.sqrt(squares.max()))
    point = centres.mean(axis=-2)
    point[..., -1] -= scale
    settled = np.zeros(point.shape[:-1], dtype=bool)
    for _ in range(MOST_STEPS):
        rods = point[..., None, :] - centres
        step = _solve(2 * rods, (rods**2).sum(axis=-1) - squares)
        point = point - np.where(settled[..., None], 0.0, step)
        settled = settled | (np.abs(step).max(axis=-1) < ARRIVED * scale)
        if settled.all():
            break
    return np.where(settled[..., None], point, np.nan)


def _solve(matrices: Array, values: Array) -> Array:
    """Rows of NaN where a matrix is singular."""
    det = np.linalg.det(matrices)
    usable = np.isfinite(det) & (det != 0)
    eye = np.broadcast_to(np.eye(matrices.shape[-1]), matrices.shape)
    safe = np.where(usable[..., None, None], matrices, eye)
    solved = np.linalg.solve(safe, values[..., None])[..., 0]
    return np.where(usable[..., None], solved, np.nan)
