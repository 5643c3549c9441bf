"""Inverse by the line on which the elbow lies (the tutorial of Trossen's forum, 2009)."""

from __future__ import annotations

import numpy as np

from deltaviz.mechanism.arrays import Array
from deltaviz.mechanism.published.legs import Legs


@np.errstate(all="ignore")
def elbow_line(legs: Legs, xyz: Array) -> Array:
    """(..., d) mm to (..., n) rad, elbows outside, for effectors below the base (z < 0).

    In the leg's plane the elbow is at the upper arm's length from the motor and at the
    forearm's from the effector's joint: two circles, whose difference is a line z = a + b·out.
    It divides by z: NaN at z = 0, and few digits near it.
    """
    angles: list[Array] = []
    for leg in legs:
        out, side, up = leg.seen(xyz)
        end = out + leg.effector
        squares = end**2 + side**2 + up**2 + leg.upper**2 - leg.fore**2 - leg.base**2
        up = np.where(up < 0, up, np.nan)
        a, b = squares / (2 * up), (leg.base - end) / up
        root = np.sqrt(leg.upper**2 * (1 + b**2) - (a + b * leg.base) ** 2)
        elbow = (leg.base - a * b + root) / (1 + b**2)
        angles.append(np.arctan2(-(a + b * elbow), elbow - leg.base))
    return np.stack(angles, axis=-1)
