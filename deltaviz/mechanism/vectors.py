"""Products of vectors held by component: several times as fast as numpy's own `cross`."""

from __future__ import annotations

import numpy as np

from deltaviz.mechanism.arrays import Array

Vector = tuple[Array, ...]  # its three components


def minus(a: Vector, b: Vector) -> Vector:
    return tuple(p - q for p, q in zip(a, b, strict=True))


def dot(a: Vector, b: Vector) -> Array:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


def cross_rows(matrix: Array) -> Array:
    """(..., 3, 3) to the cross products of its rows: 2 x 3, 3 x 1, 1 x 2."""
    one, two, three = matrix[..., 0, :], matrix[..., 1, :], matrix[..., 2, :]
    pairs = (np.cross(two, three), np.cross(three, one), np.cross(one, two))
    return np.stack(pairs, axis=-2)
