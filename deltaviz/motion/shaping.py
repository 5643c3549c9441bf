"""From "there, no faster than this" to the axes and limits that ruckig plans with.

The tip's limits are norms. So a motion of the tip is planned in a frame of its own, whose first
axis is the way to go, and the limits are shared out over its axes so that their norm holds:
what goes straight gets all of them and stays straight. Joints have limits of their own and need
no frame.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from deltaviz.motion.compiled import compiled
from deltaviz.motion.followed import Array
from deltaviz.motion.otg import Generator, Request
from deltaviz.motion.space import CartesianSpace, Space

ASIDE = 0.05  # least share of the limits for an axis that has nothing to do
HEADROOM = 0.997  # of the limits: cubics through exact knots ripple


@dataclass(frozen=True, slots=True)
class Way:
    """Where to, from a state: `displacement` (d,) to the place, or None: only come to rest.

    With `free`, what lies across the way is only brought to rest, not back onto the line.
    `speed` is the largest velocity: in the Cartesian space a norm, else one number per joint.
    """

    displacement: Array | None
    speed: Array
    free: bool = False


class Shaper:
    """Plans ways in one space."""

    def __init__(self, space: Space, period: float) -> None:
        self._space = space
        self._period = period
        metres = isinstance(space, CartesianSpace)
        self._generator = Generator(space.axes, 1e-3 if metres else 1.0)

    def __call__(
        self, q: Array, v: Array, a: Array, way: Way, *, velocity: float, acceleration: float
    ) -> tuple[Array, Array, Array] | None:
        """Position, velocity, acceleration (K+1, d) at the knots of the motion, or None.

        `velocity` and `acceleration` (0-1] are the shares of the limits to plan with.
        """
        if isinstance(self._space, CartesianSpace):
            return self._tip(self._space, q, v, a, way, velocity, acceleration)
        space = self._space
        goal = np.zeros(space.axes) if way.displacement is None else way.displacement
        moved = way.displacement is not None
        held = tuple(moved and not (way.free and d == 0.0) for d in goal.tolist())
        request = Request(
            displacement=goal,
            velocity=v,
            acceleration=a,
            held=held,
            max_velocity=np.maximum(way.speed * (velocity * HEADROOM), 1e-6),
            max_acceleration=space.acceleration * (acceleration * HEADROOM),
            max_jerk=space.jerk * acceleration**1.5,
            together=True,
        )
        rows = self._generator(request, self._period)
        return None if rows is None else (q + rows[0], rows[1], rows[2])

    def _tip(
        self,
        space: CartesianSpace,
        q: Array,
        v: Array,
        a: Array,
        way: Way,
        velocity: float,
        acceleration: float,
    ) -> tuple[Array, Array, Array] | None:
        moved = way.displacement is not None
        ahead = way.displacement if way.displacement is not None else v
        axes, here_v, here_a = frame(ahead, v, a)
        shares = axis_shares(here_v, here_a, space.velocity, space.acceleration)
        goal = np.zeros(space.axes)
        if moved:
            goal[0] = float(np.linalg.norm(ahead))
        across = np.maximum(np.abs(here_v), 0.3 * space.velocity * velocity)
        across[0] = float(way.speed[0]) * velocity * HEADROOM
        request = Request(
            displacement=goal,
            velocity=here_v,
            acceleration=here_a,
            held=(moved, *(moved and not way.free,) * (space.axes - 1)),
            max_velocity=np.maximum(across, 1e-3),
            max_acceleration=shares * (space.acceleration * acceleration * HEADROOM),
            max_jerk=shares * (space.jerk * acceleration**1.5),
            together=False,
        )
        rows = self._generator(request, self._period)
        if rows is None:
            return None
        return q + rows[0] @ axes, rows[1] @ axes, rows[2] @ axes


@compiled
def frame(ahead: Array, v: Array, a: Array) -> tuple[Array, Array, Array]:
    """Orthonormal rows: along `ahead`, then what `v` and `a` have across it; v and a in it."""
    size = len(ahead)
    axes = np.zeros((size, size))
    candidates = np.zeros((3 + size, size))
    candidates[0] = ahead
    candidates[1] = v
    candidates[2] = a
    for i in range(size):
        candidates[3 + i, i] = 1.0
    count = 0
    for k in range(3 + size):
        if count == size:
            break
        row = candidates[k].copy()
        length = np.sqrt((row * row).sum())
        if length < 1e-9:
            continue
        row /= length
        for _ in range(2):
            for i in range(count):
                row -= (row * axes[i]).sum() * axes[i]
        rest = np.sqrt((row * row).sum())
        if rest > 1e-6:
            axes[count] = row / rest
            count += 1
    turned_v = np.zeros(size)
    turned_a = np.zeros(size)
    for i in range(size):
        turned_v[i] = (axes[i] * v).sum()
        turned_a[i] = (axes[i] * a).sum()
    return axes, turned_v, turned_a


@compiled
def axis_shares(v: Array, a: Array, velocity: float, acceleration: float) -> Array:
    """Shares of the limits, their squares adding up to 1: the more an axis has to undo, the more
    it gets; the first has somewhere to go and gets the most."""
    shares = np.ones(len(v))
    total = 1.0
    for i in range(1, len(v)):
        needed = max(2.0 * abs(v[i]) / velocity, abs(a[i]) / acceleration)
        shares[i] = min(1.0, max(ASIDE, needed))
        total += shares[i] * shares[i]
    return shares / np.sqrt(total)
