"""A kernel with one joint more: the tool turns about its tip, whatever the arms do.

Its poses are the tip's with the tool's turn as their last entry, in mm of travel: the angle times
`scale`. So all entries of a pose may be measured alike.
"""

from __future__ import annotations

import numpy as np

from deltaviz.mechanism.arrays import Array
from deltaviz.mechanism.bounds import ROUNDING
from deltaviz.mechanism.kernel import Kernel


class ToolKernel:
    """See `Kernel`. `low` and `high` bind the tool's angle (rad)."""

    def __init__(self, arms: Kernel, *, low: float, high: float, scale: float) -> None:
        self._arms = arms
        self._low, self._high, self._scale = low, high, scale

    def inverse(self, xyz: Array) -> Array:
        arms = self._arms.inverse(_tip(xyz))
        turn = xyz[:, -1:] / self._scale
        return np.concatenate((arms, turn + 0.0 * arms[:, :1]), axis=1)  # rows of NaN stay whole

    def forward(self, theta: Array) -> Array:
        return self._joined(self._arms.forward(_tip(theta)), theta)

    def margins(self, xyz: Array, theta: Array) -> Array:
        turn = theta[:, -1:]
        turn = np.where(np.isnan(turn), xyz[:, -1:] / self._scale, turn)
        spare = np.concatenate((turn - self._low, self._high - turn), axis=1)
        arms = self._arms.margins(_tip(xyz), _tip(theta))
        return np.concatenate((arms, spare * self._scale + ROUNDING), axis=1)

    def joint_velocity(self, xyz: Array, theta: Array, velocity: Array) -> Array:
        arms = self._arms.joint_velocity(_tip(xyz), _tip(theta), _tip(velocity))
        return np.concatenate((arms, velocity[:, -1:] / self._scale), axis=1)

    def tip_velocity(self, xyz: Array, theta: Array, velocity: Array) -> Array:
        return self._joined(
            self._arms.tip_velocity(_tip(xyz), _tip(theta), _tip(velocity)), velocity
        )

    def warm_up(self) -> None:
        self._arms.warm_up()

    def _joined(self, tip: Array, turning: Array) -> Array:
        return np.concatenate((tip, turning[:, -1:] * self._scale), axis=1)


def _tip(values: Array) -> Array:
    """All but the tool's column."""
    return np.ascontiguousarray(values[:, :-1])
