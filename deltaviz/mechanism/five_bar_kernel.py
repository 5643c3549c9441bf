"""A five-bar's compiled functions, bound to its numbers."""

from __future__ import annotations

import math

import numpy as np

from deltaviz.mechanism import arm as arm_module
from deltaviz.mechanism import five_bar, stiffness
from deltaviz.mechanism import five_bar_compiled as compiled
from deltaviz.mechanism.arrays import Array
from deltaviz.mechanism.bound_kernel import BoundKernel, CompiledFunctions
from deltaviz.mechanism.bounds import ROUNDING, Bounds
from deltaviz.mechanism.five_bar import FiveBar

FUNCTIONS = CompiledFunctions(
    inverse=compiled.inverse,
    forward=compiled.forward,
    margins=compiled.margins,
    joint_velocity=compiled.joint_velocity,
    tip_velocity=compiled.tip_velocity,
)


def five_bar_kernel(mechanism: FiveBar, bounds: Bounds) -> BoundKernel:
    """Of the bounds, a radius and a box in y bind nothing in a plane."""
    boxes = sum(2 for box in (bounds.z, bounds.x) if box is not None)
    return BoundKernel(
        FUNCTIONS,
        geometry=_geometry(mechanism, bounds),
        limits=_limits(mechanism, bounds),
        columns=compiled.OWN_COLUMNS + boxes,
        joints=2,
    )


def _geometry(mechanism: FiveBar, bounds: Bounds) -> Array:
    out = np.zeros((4, 5))
    for i, arm in enumerate(mechanism.arms):
        out[i, :4] = arm.offset, arm.upper_arm, arm.forearm, arm.cos
    out[2, :2] = bounds.tool_offset
    out[3, compiled.EDGE] = arm_module.EDGE_ROUNDING
    out[3, compiled.MEET] = five_bar.MEET_ROUNDING
    out[3, compiled.UNDETERMINED] = five_bar.UNDETERMINED
    out[3, compiled.TINY] = stiffness.TINY
    out[3, compiled.LEAST_RHO] = arm_module.LEAST_RHO
    return out


def _limits(mechanism: FiveBar, bounds: Bounds) -> Array:
    out = np.full(compiled.LIMITS, math.nan)
    for start, values in (
        (compiled.TYPE_1_SCALE, mechanism.type_1_scale),
        (compiled.JOINT_SCALE, mechanism.joint_scale),
        (compiled.JOINT_MIN, bounds.joint_min),
        (compiled.JOINT_MAX, bounds.joint_max),
    ):
        out[start : start + 2] = values
    out[compiled.TYPE_2_SCALE] = mechanism.type_2_scale
    out[compiled.ROUNDING] = ROUNDING
    out[compiled.TYPE_1_RESERVE] = stiffness.TYPE_1_RESERVE
    out[compiled.TYPE_2_RESERVE] = stiffness.TYPE_2_RESERVE
    for axis, box in enumerate((bounds.z, bounds.x)):
        if box is not None:
            out[compiled.BOX + 2 * axis : compiled.BOX + 2 * axis + 2] = box
    return out
