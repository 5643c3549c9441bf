"""A rotary delta's compiled functions, bound to its numbers."""

from __future__ import annotations

import math

import numpy as np

from deltaviz.mechanism import rotary_delta_batch_compiled as batch
from deltaviz.mechanism import rotary_delta_compiled as compiled
from deltaviz.mechanism import stiffness
from deltaviz.mechanism.arrays import Array
from deltaviz.mechanism.bounds import ROUNDING, Bounds
from deltaviz.mechanism.rotary_delta import RotaryDelta
from deltaviz.mechanism.rotary_delta_numbers import geometry


class RotaryDeltaKernel:
    """See `Kernel`."""

    def __init__(self, mechanism: RotaryDelta, bounds: Bounds) -> None:
        self._g = geometry(mechanism, bounds.tool_offset)
        self._limits = _limits(mechanism, bounds)
        boxes = sum(2 for box in (bounds.z, bounds.x, bounds.y) if box is not None)
        self._columns = 14 + boxes + (bounds.radius is not None)

    def inverse(self, xyz: Array) -> Array:
        return batch.inverse(xyz, self._g)

    def forward(self, theta: Array) -> Array:
        return batch.forward(theta, self._g)

    def margins(self, xyz: Array, theta: Array) -> Array:
        return compiled.margins(xyz, theta, self._g, self._limits, self._columns)

    def joint_velocity(self, xyz: Array, theta: Array, velocity: Array) -> Array:
        return compiled.joint_velocity(xyz, theta, velocity, self._g)

    def tip_velocity(self, xyz: Array, theta: Array, velocity: Array) -> Array:
        return compiled.tip_velocity(xyz, theta, velocity, self._g)

    def warm_up(self) -> None:
        theta = np.zeros((1, 3))
        xyz = self.forward(theta)
        self.margins(xyz, self.inverse(xyz))
        self.tip_velocity(xyz, theta, self.joint_velocity(xyz, theta, theta))


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
