"""Inverse by the rule of cosines (the STM32F407 library; the planar robot's documentation)."""

from __future__ import annotations

import numpy as np

from deltaviz.mechanism.arrays import Array
from deltaviz.mechanism.published.legs import Legs


@np.errstate(all="ignore")
def cosine_rule(legs: Legs, xyz: Array) -> Array:
    """(..., d) mm to (..., n) rad, elbows outside; NaN for a leg that does not reach.

    The triangle of motor, elbow and effector's joint, seen in the leg's plane: its distance is
    the planar one, and the forearm counts with what a lean out of the plane leaves of it,
    √(l² - side²). The direction comes from an atan2, the angle at the motor from the rule.
    The arc cosine has few digits left where the arm is nearly straight.
    """
    angles: list[Array] = []
    for leg in legs:
        out, side, up = leg.seen(xyz)
        out = out + leg.effector - leg.base
        distance = np.hypot(out, up)
        seen = leg.fore**2 - side**2
        at_motor = np.arccos((distance**2 + leg.upper**2 - seen) / (2 * leg.upper * distance))
        angle = np.arctan2(-up, out) - at_motor
        angles.append(np.remainder(angle + np.pi, 2 * np.pi) - np.pi)
    return np.stack(angles, axis=-1)
