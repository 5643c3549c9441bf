"""Inverse by the tangent of the half angle (Zheng and Chen 2023, their equations 16 to 21)."""

from __future__ import annotations

import numpy as np

from deltaviz.mechanism.arrays import Array
from deltaviz.mechanism.published.legs import Legs


@np.errstate(all="ignore")
def half_angle(legs: Legs, xyz: Array) -> Array:
    """(..., d) mm to (..., n) rad, elbows outside; NaN for a leg that does not reach.

    The closed leg, (out - L cos θ)² + side² + (z + L sin θ)² = l², is with t = tan θ/2 the
    quadratic A t² + B t + C = 0. Its minus root is always the elbow outside. Written as
    2C / (-B + √(B² - 4AC)) it keeps its digits where A vanishes; above the base, where B is
    positive, the usual form does.
    """
    angles: list[Array] = []
    for leg in legs:
        out, side, up = leg.seen(xyz)
        out = out + leg.effector - leg.base
        constant = out**2 + side**2 + up**2 + leg.upper**2 - leg.fore**2
        a = constant + 2 * leg.upper * out
        b = 4 * leg.upper * up
        c = constant - 2 * leg.upper * out
        root = np.sqrt(b**2 - 4 * a * c)
        below = 2 * np.arctan2(2 * c, root - b)
        above = 2 * np.arctan2(-b - root, 2 * a)
        angle = np.where(up <= 0, below, above)
        angles.append(np.remainder(angle + np.pi, 2 * np.pi) - np.pi)
    return np.stack(angles, axis=-1)
