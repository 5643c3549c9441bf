"""The boundary's arithmetic, compiled. See `check_compiled` for why it stands in one file."""

from __future__ import annotations

import numpy as np

from deltaviz.mechanism.compiled import compiled
from deltaviz.motion.followed import Array

TOLERANCE = 1e-7  # units of margin: rounding


@compiled
def first_illegal(margins: Array, floor: Array) -> int:
    """The first row below the floor, or -1. What rises from below lifts the floor with it."""
    least = floor.copy()
    for k in range(margins.shape[0]):
        for c in range(margins.shape[1]):
            if not margins[k, c] >= least[c] - TOLERANCE:
                return k
            if least[c] < 0:
                least[c] = min(0.0, max(least[c], margins[k, c]))
    return -1


@compiled
def legal(margins: Array, floor: Array) -> int:
    """The first row that is above the floor, or -1."""
    for k in range(margins.shape[0]):
        fine = True
        for c in range(margins.shape[1]):
            if not margins[k, c] >= floor[c] - TOLERANCE:
                fine = False
                break
        if fine:
            return k
    return -1


@compiled
def nearest_step(margins: Array, slopes: Array, towards: Array, floor: Array, near: float) -> Array:
    """The step nearest to `towards` that keeps margins + slopes·step above the floor.

    margins, floor (m,), slopes (d, m), towards (d,). Hildreth's method: one constraint after the
    other is given the multiplier it asks for, until none changes.
    """
    count = margins.shape[0]
    axes = towards.shape[0]
    step = towards.copy()
    force = np.zeros(count)
    square = np.zeros(count)
    for c in range(count):
        for i in range(axes):
            square[c] += slopes[i, c] * slopes[i, c]
    for _ in range(200):
        change = 0.0
        for c in range(count):
            if margins[c] > near or not square[c] > 1e-12:
                continue
            value = margins[c] - floor[c]
            for i in range(axes):
                value += slopes[i, c] * step[i]
            new = max(0.0, force[c] - value / square[c])
            delta = new - force[c]
            if delta != 0.0:
                for i in range(axes):
                    step[i] += delta * slopes[i, c]
                force[c] = new
                change = max(change, abs(delta) * np.sqrt(square[c]))
        if change < 1e-6:
            break
    return step
