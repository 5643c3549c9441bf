"""How a mechanism turns its joints' motion and torque into the effector's: from its Jacobian."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from deltaviz.mechanism.arrays import Array


@dataclass(frozen=True)
class Dexterity:
    """Of Jacobians (..., d, n) in mm/rad, (...) each; NaN where they are.

    `slowest`, `fastest`: the effector's speed in its slowest and fastest direction, mm/s for joints
    turning at 1 rad/s together (their speeds' root of squares): the smallest and the largest
    singular value. `condition`: their ratio, 1 at best.
    """

    slowest: Array
    fastest: Array

    @classmethod
    def of(cls, jacobian: Array) -> Dexterity:
        known = np.asarray(np.isfinite(jacobian).all(axis=(-2, -1)))
        filled = np.where(known[..., None, None], jacobian, 0.0)
        values = np.linalg.svd(filled, compute_uv=False)
        lost = np.where(known, 0.0, np.nan)
        return cls(values[..., -1] + lost, values[..., 0] + lost)

    @property
    def condition(self) -> Array:
        with np.errstate(all="ignore"):
            return self.fastest / self.slowest

    @property
    def stiffness(self) -> Array:
        """N/mm in the softest direction, for 1 N m/rad at each joint: K = J^-T k J^-1."""
        with np.errstate(all="ignore"):
            return 1000.0 / self.fastest**2

    @property
    def least_force(self) -> Array:
        """N in the weakest direction, for joint torques of 1 N m together (root of squares)."""
        with np.errstate(all="ignore"):
            return 1000.0 / self.fastest

    @property
    def most_force(self) -> Array:
        """N in the strongest direction, likewise."""
        with np.errstate(all="ignore"):
            return 1000.0 / self.slowest
