"""Whether a robot's forearms can meet at all within its joint limits."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

import numpy as np

from deltaviz.mechanism import FiveBar, Mechanism, RotaryDelta

STEPS = 9  # of each joint's range, at both ends and between


def can_meet(mechanism: Mechanism, low: Sequence[float], high: Sequence[float]) -> bool:
    """At some angles of a grid between the joint limits (rad, one per arm)."""
    ranges = [np.linspace(a, b, STEPS) for a, b in zip(low, high, strict=True)]
    theta = np.array(list(itertools.product(*ranges)))
    return bool(np.isfinite(mechanism.forward(theta)).any())


def shortest_forearm(
    mechanism: Mechanism, low: Sequence[float], high: Sequence[float]
) -> float | None:
    """mm, of forearms that meet on the middle line of a robot with equal arms; None otherwise.

    There the elbows, moved inward, stand at s + L cos θ from it.
    """
    if not isinstance(mechanism, RotaryDelta | FiveBar):
        return None
    arms = mechanism.arms
    if len({(arm.offset, arm.upper_arm, arm.forearm) for arm in arms}) > 1:
        return None
    first, least, most = arms[0], max(low), min(high)
    if not least <= most:
        return None
    nearest = min(math.cos(least), math.cos(most))  # to the middle, of the elbows
    return max(0.0, first.offset + first.upper_arm * nearest)
