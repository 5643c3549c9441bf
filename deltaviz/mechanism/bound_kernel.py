"""Compiled functions, bound to a mechanism's numbers: what all kernels of arms have alike."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from deltaviz.mechanism.arrays import Array


@dataclass(frozen=True, slots=True)
class CompiledFunctions:
    """Each takes its arrays and the geometry; `margins` the limits and its columns, too."""

    inverse: Callable[[Array, Array], Array]
    forward: Callable[[Array, Array], Array]
    margins: Callable[[Array, Array, Array, Array, int], Array]
    joint_velocity: Callable[[Array, Array, Array, Array], Array]
    tip_velocity: Callable[[Array, Array, Array, Array], Array]


class BoundKernel:
    """See `Kernel`. `columns` is how many margins there are."""

    def __init__(
        self,
        functions: CompiledFunctions,
        *,
        geometry: Array,
        limits: Array,
        columns: int,
        joints: int,
    ) -> None:
        self._f = functions
        self._g = geometry
        self._limits = limits
        self._columns = columns
        self._joints = joints

    def inverse(self, xyz: Array) -> Array:
        return self._f.inverse(xyz, self._g)

    def forward(self, theta: Array) -> Array:
        return self._f.forward(theta, self._g)

    def margins(self, xyz: Array, theta: Array) -> Array:
        return self._f.margins(xyz, theta, self._g, self._limits, self._columns)

    def joint_velocity(self, xyz: Array, theta: Array, velocity: Array) -> Array:
        return self._f.joint_velocity(xyz, theta, velocity, self._g)

    def tip_velocity(self, xyz: Array, theta: Array, velocity: Array) -> Array:
        return self._f.tip_velocity(xyz, theta, velocity, self._g)

    def warm_up(self) -> None:
        theta = np.zeros((1, self._joints))
        xyz = self.forward(theta)
        self.margins(xyz, self.inverse(xyz))
        self.tip_velocity(xyz, theta, self.joint_velocity(xyz, theta, theta))
