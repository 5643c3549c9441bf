"""Array types, and the shape check that every vectorised function shares."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


def rows(values: ArrayLike, width: int, name: str) -> Array:
    """`values` as float64 of shape (..., width); ValueError if the last axis differs."""
    array = np.asarray(values, dtype=np.float64)
    if array.ndim == 0 or array.shape[-1] != width:
        raise ValueError(f"{name} has shape {array.shape}; it must be (..., {width})")
    return array
