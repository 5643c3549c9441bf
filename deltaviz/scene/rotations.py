"""Unit quaternions (w, x, y, z), vectorised over the leading axes."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from deltaviz.scene.units import Array


def about(axis: int, angle: ArrayLike) -> Array:
    """Rotation about a coordinate axis, (...) rad to (..., 4)."""
    half = np.asarray(angle, dtype=np.float64) / 2
    out = np.zeros((*half.shape, 4))
    out[..., 0] = np.cos(half)
    out[..., 1 + axis] = np.sin(half)
    return out


def from_down(direction: Array) -> Array:
    """The shortest rotation that turns -z to `direction`, (..., 3) of any length to (..., 4)."""
    length = np.linalg.norm(direction, axis=-1, keepdims=True)
    x, y, z = np.moveaxis(direction / np.where(length > 0, length, 1.0), -1, 0)
    out = np.stack((1.0 - z, y, -x, np.zeros_like(x)), axis=-1)
    norm = np.linalg.norm(out, axis=-1, keepdims=True)
    straight_up = np.array((0.0, 1.0, 0.0, 0.0))
    return np.where(norm > 1e-9, out / np.where(norm > 1e-9, norm, 1.0), straight_up)


def matrix(wxyz: Array) -> Array:
    """One unit quaternion as a 3 x 3 rotation matrix."""
    w, x, y, z = wxyz / np.linalg.norm(wxyz)
    return np.array(
        (
            (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
            (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
            (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
        )
    )
