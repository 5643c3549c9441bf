"""Where a motion at a commanded velocity may go: straight on, up to the first limit."""

from __future__ import annotations

import numpy as np

from deltaviz.motion.boundary import Boundary
from deltaviz.motion.followed import Array
from deltaviz.motion.shaping import Way
from deltaviz.motion.space import CartesianSpace, Group, Space

AHEAD = 0.25  # s of steady motion before a plan begins to slow
RESERVE = 0.05  # units of margin, about mm, that a jog keeps to a limit
NOTHING = 0.005  # mm; less than this is no way to go


class Jog:
    """Ways at a velocity in one space."""

    def __init__(self, space: Space) -> None:
        self._space = space
        self._boundary = Boundary(space)

    def way(self, q: Array, v: Array, wanted: Array, *, ease: float) -> tuple[Way, bool]:
        """The way from (q, v) at the velocity `wanted` (d,); whether a limit ends it.

        `ease` is the share of the acceleration limit that can be used here.
        """
        speed = float(np.linalg.norm(wanted))
        rest = Way(None, self._speeds(wanted))
        if speed < 1e-9:
            return rest, False
        ahead = wanted / speed
        along = ahead * float(ahead @ v)
        start = q + self._stop(v - along, ease)
        length = speed * AHEAD + float(np.linalg.norm(self._stop(wanted, ease)))
        length = max(length, float(np.linalg.norm(self._stop(along, ease))))
        end = self._boundary.last_legal(
            start, start + ahead * length, self._boundary.floor(q, RESERVE)
        )
        travel = float(ahead @ (end - q))
        held = travel < length - 1e-9
        if travel < NOTHING * self._space.unit:
            return rest, held
        return Way(ahead * travel, self._speeds(wanted), free=True), held

    def _speeds(self, wanted: Array) -> Array:
        space = self._space
        if isinstance(space, CartesianSpace):
            tip = float(np.linalg.norm(wanted[space.groups[0].part]))
            return np.array([min(tip, space.groups[0].velocity), *space.top[1:]])
        return np.minimum(np.abs(wanted), space.velocity)

    def _stop(self, v: Array, ease: float) -> Array:
        """How far a stop from the velocity v carries, under the jerk limit."""
        return np.concatenate(
            [
                v[group.part] * (_stop_time(v[group.part], group, ease) / 2.0)
                for group in self._space.groups
            ]
        )


def _stop_time(v: Array, group: Group, ease: float) -> float:
    speed = float(np.linalg.norm(v))
    if speed < 1e-12:
        return 0.0
    acceleration, jerk = group.acceleration * ease, group.jerk * ease**1.5
    if speed < acceleration * acceleration / jerk:
        return 2.0 * float(np.sqrt(speed / jerk))
    return speed / acceleration + acceleration / jerk
