"""A rotary delta's compiled functions, bound to its numbers."""

from __future__ import annotations

import math

import numpy as np

from deltaviz.mechanism import rotary_delta_batch_compiled as batch
from deltaviz.mechanism import rotary_delta_compiled as compiled
from deltaviz.mechanism import stiffness
from deltaviz.mechanism.arrays import Array
from deltaviz.mechanism.bound_kernel import BoundKernel, CompiledFunctions
from deltaviz.mechanism.bounds import ROUNDING, Bounds
from deltaviz.mechanism.rotary_delta import RotaryDelta
from deltaviz.mechanism.rotary_delta_numbers import geometry

FUNCTIONS = CompiledFunctions(
    inverse=batch.inverse,
    forward=batch.forward,
    margins=compiled.margins,
    joint_velocity=compiled.joint_velocity,
    tip_velocity=compiled.tip_velocity,
)


def rotary_delta_kernel(mechanism: RotaryDelta, bounds: Bounds) -> BoundKernel:
    boxes = sum(2 for box in (bounds.z, bounds.x, bounds.y) if box is not None)
    return BoundKernel(
        FUNCTIONS,
        geometry=geometry(mechanism, bounds.tool_offset),
        limits=_limits(mechanism, bounds),
        columns=14 + boxes + (bounds.radius is not None),
        joints=3,
    )


def _limits(mechanism: RotaryDelta, bounds: Bounds) -> Array:
    out = np.full(compiled.LIMITS, math.nan)
    most = math.pi / 2 if bounds.ball_joint_max is None else bounds.ball_joint_max
    sideways = math.sin(most)
    for start, values in (
        (compiled.TYPE_1_SCALE, mechanism.type_1_scale),
        (compiled.JOINT_SCALE, mechanism.joint_scale),
        (compiled.SIDEWAYS_MAX, [fore * sideways for fore in mechanism.forearm]),
        (compiled.JOINT_MIN, bounds.joint_min),
        (compiled.JOINT_MAX, bounds.joint_max),
    ):
        out[start : start + 3] = values
    out[compiled.TYPE_2_SCALE] = mechanism.type_2_scale
    out[compiled.ROUNDING] = ROUNDING
    out[compiled.TYPE_1_RESERVE] = stiffness.TYPE_1_RESERVE
    out[compiled.TYPE_2_RESERVE] = stiffness.TYPE_2_RESERVE
    for axis, box in enumerate((bounds.z, bounds.x, bounds.y)):
        if box is not None:
            out[compiled.BOX + 2 * axis : compiled.BOX + 2 * axis + 2] = box
    if bounds.radius is not None:
        out[compiled.RADIUS] = bounds.radius
    return out
