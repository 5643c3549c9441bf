"""How firmly rods hold a body, as one smooth signed number, and the reserves kept from 0.

For rows A (forearm directions, or couples), 1/‖A⁻¹‖ = det A / ‖adj A‖ (Frobenius): if each
rod is off by an independent error ε, clearance of a ball joint say, the body is off by
ε/stiffness. The determinant alone is a worse measure: it calls nearly parallel rods, which are
still stiff, worse than flat ones, which are not.
"""

from __future__ import annotations

import numpy as np

from deltaviz.mechanism.arrays import Array

# At most tenfold amplification of clearance and of force in the forearms.
TYPE_2_RESERVE = 0.1
# Squared sine of 8.1 degrees: a joint must turn at most 7 times as fast as with the upper arm
# square to the line from shoulder to effector; about 2 mm before the arm is straight.
TYPE_1_RESERVE = 0.02

TINY = 1e-12


def unit(vectors: Array) -> Array:
    """(..., d) vectors to length 1; 0 stays 0."""
    length = np.sqrt((vectors * vectors).sum(axis=-1, keepdims=True))
    return vectors / np.maximum(length, TINY)


def stiffness(matrix: Array) -> Array:
    """det A / ‖adj A‖ of (..., 3, 3); 0 where the rows are dependent, signed as the determinant."""
    one, two, three = matrix[..., 0, :], matrix[..., 1, :], matrix[..., 2, :]
    first, second, third = np.cross(two, three), np.cross(three, one), np.cross(one, two)
    norm = np.sqrt((first**2 + second**2 + third**2).sum(axis=-1))
    return (one * first).sum(axis=-1) / np.maximum(norm, TINY)


def planar_stiffness(matrix: Array) -> Array:
    """det A / ‖adj A‖ of (..., 2, 2), whose adjugate is as large as itself."""
    one, two = matrix[..., 0, :], matrix[..., 1, :]
    det = one[..., 0] * two[..., 1] - one[..., 1] * two[..., 0]
    norm = np.sqrt((matrix**2).sum(axis=(-2, -1)))
    return det / np.maximum(norm, TINY)
