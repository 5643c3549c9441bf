"""What the compiled functions must know of a rotary delta, as one array of numbers."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from deltaviz.mechanism import arm as arm_module
from deltaviz.mechanism import rotary_delta, stiffness
from deltaviz.mechanism.arrays import Array
from deltaviz.mechanism.rotary_delta import RotaryDelta


def geometry(mechanism: RotaryDelta, tool_offset: Sequence[float]) -> Array:
    """(5, 5): for each arm (offset, upper_arm, forearm, cos, sin of its azimuth), then (tool
    offset x, y, z, handedness, 0), then the tolerances: of the edge of reach, of forearms that
    just meet, of elbows that coincide, of a zero length, and the least ρ."""
    out = np.zeros((5, 5))
    for i, arm in enumerate(mechanism.arms):
        out[i] = arm.offset, arm.upper_arm, arm.forearm, arm.cos, arm.sin
    out[3] = (*tool_offset, mechanism.handedness, 0.0)
    out[4] = (
        arm_module.EDGE_ROUNDING,
        rotary_delta.MEET_ROUNDING,
        rotary_delta.UNDETERMINED,
        stiffness.TINY,
        arm_module.LEAST_RHO,
    )
    return out
