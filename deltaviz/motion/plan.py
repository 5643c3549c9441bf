"""A plan: the knots of a motion that ends at rest."""

from __future__ import annotations

from dataclasses import dataclass

from deltaviz.motion.followed import Array
from deltaviz.motion.space import Space


@dataclass(frozen=True, slots=True)
class Plan:
    """Row 0 is the state it starts from, the last row is at rest. Every segment is as long.

    `theta`, `rate`, `pose` (K+1, n); `q`, `v`, `a` (K+1, n): the planned motion in its own space.
    `segment` in s. `braking`: along the joints' tangent, bound by no Cartesian limit.
    """

    space: Space
    theta: Array
    rate: Array
    pose: Array
    q: Array
    v: Array
    a: Array
    segment: float
    braking: bool = False

    @property
    def last(self) -> int:
        """The index of the row at rest."""
        return len(self.theta) - 1
