"""From "there, no faster than this" to the axes and limits that ruckig plans with.

The tip's limits are norms. So a motion of the tip is planned in a frame of its own, whose first
axis is the way to go, and the limits are shared out over its axes so that their norm holds:
what goes straight gets all of them and stays straight. A tool's turn, and joints, have limits of
their own and need no frame.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from deltaviz.mechanism.compiled import compiled
from deltaviz.motion.followed import Array
from deltaviz.motion.otg import Generator, Request
from deltaviz.motion.space import CartesianSpace, Group, JointSpace, Space

ASIDE = 0.05  # least share of the limits for an axis that has nothing to do
ACROSS = 0.3  # of the velocity limit: what an axis across the way may use
IN_LINE = 1e-9  # rad/s and rad/s²: less than this across the way is rounding
HEADROOM = 0.997  # of the limits: cubics through exact knots ripple


@dataclass(frozen=True, slots=True)
class Way:
    """Where to, from a state: `displacement` (d,) to the place, or None: only come to rest.

    With `free`, what lies across the way is only brought to rest, not back onto the line.
    `speed` is the largest velocity: of the tip a norm, then one number for the tool's turn, if
    any; of joints one number each.
    """

    displacement: Array | None
    speed: Array
    free: bool = False

    def within(self, seconds: float) -> Way:
        """The same way, or as much of it as takes about `seconds` at its speed."""
        if self.displacement is None:
            return self
        tip = 1 + len(self.displacement) - len(self.speed)
        size = np.abs(self.displacement)
        size = np.append(np.linalg.norm(size[:tip]), size[tip:])
        time = float(np.max(size / np.maximum(self.speed, 1e-9)))
        return (
            self
            if time <= seconds
            else replace(self, displacement=self.displacement * (seconds / time))
        )


@dataclass(frozen=True, slots=True)
class Shares:
    """What part of the limits (0-1] to plan with."""

    velocity: float = 1.0
    acceleration: float = 1.0


class Shaper:
    """Plans ways in one space."""

    def __init__(self, space: Space, period: float) -> None:
        self._space = space
        self._period = period
        metres = isinstance(space, CartesianSpace)
        self._generator = Generator(space.axes, 1e-3 if metres else 1.0)

    def __call__(
        self, q: Array, v: Array, a: Array, way: Way, shares: Shares
    ) -> tuple[Array, Array, Array] | None:
        """Position, velocity, acceleration (K+1, d) at the knots of the motion, or None."""
        if isinstance(self._space, CartesianSpace):
            axes, request = _pose_request(self._space, v, a, way, shares)
        else:
            axes, request = _joint_request(self._space, v, a, way, shares)
        rows = self._generator(request, self._period)
        if rows is None:
            return None
        return q + rows[0] @ axes, rows[1] @ axes, rows[2] @ axes


def _pose_request(
    space: CartesianSpace, v: Array, a: Array, way: Way, shares: Shares
) -> tuple[Array, Request]:
    """The tip's motion, and beside it the tool's turn if there is one."""
    moved = way.displacement is not None
    ahead = way.displacement if way.displacement is not None else v
    tip, *turns = space.groups
    rows, request = _tip_request(tip, ahead[tip.part], v[tip.part], a[tip.part], way, shares)
    axes = np.eye(space.axes)
    axes[tip.part, tip.part] = rows
    for turn, speed in zip(turns, way.speed[1:].tolist(), strict=True):
        most = speed * shares.velocity * HEADROOM
        request += Request(
            displacement=ahead[turn.part] if moved else np.zeros(1),
            velocity=v[turn.part],
            acceleration=a[turn.part],
            held=(moved and not way.free,),
            max_velocity=np.maximum(np.abs(v[turn.part]), max(most, 1e-3)),
            max_acceleration=np.array([turn.acceleration * shares.acceleration * HEADROOM]),
            max_jerk=np.array([turn.jerk * shares.acceleration**1.5]),
            together=False,
        )
    return axes, request


def _tip_request(
    tip: Group, ahead: Array, v: Array, a: Array, way: Way, shares: Shares
) -> tuple[Array, Request]:
    moved = way.displacement is not None
    axes, here_v, here_a = frame(ahead, v, a)
    parts = axis_shares(here_v, here_a, tip.velocity, tip.acceleration)
    most = np.maximum(np.abs(here_v), ACROSS * tip.velocity * shares.velocity)
    most[0] = float(way.speed[0]) * shares.velocity * HEADROOM
    return axes, Request(
        displacement=_along(ahead, moved),
        velocity=here_v,
        acceleration=here_a,
        held=(moved, *(moved and not way.free,) * (len(ahead) - 1)),
        max_velocity=np.maximum(most, 1e-3),
        max_acceleration=parts * (tip.acceleration * shares.acceleration * HEADROOM),
        max_jerk=parts * (tip.jerk * shares.acceleration**1.5),
        together=False,
    )


def _joint_request(
    space: JointSpace, v: Array, a: Array, way: Way, shares: Shares
) -> tuple[Array, Request]:
    moved = way.displacement is not None
    ahead = way.displacement if way.displacement is not None else v
    velocity = way.speed * (shares.velocity * HEADROOM)
    acceleration = space.acceleration * (shares.acceleration * HEADROOM)
    jerk = space.jerk * shares.acceleration**1.5
    axes, here_v, here_a = frame(ahead, v, a)
    if max(np.abs(here_v[1:]).max(), np.abs(here_a[1:]).max()) < IN_LINE and ahead.any():
        # All joints keep their proportions: one axis, as fast as the slowest joint allows.
        with np.errstate(divide="ignore"):
            along = [float(np.min(limit / np.abs(axes[0]))) for limit in (acceleration, jerk)]
            part = np.abs(axes[0]) > IN_LINE
            fastest = float(np.min(velocity[part] / np.abs(axes[0][part])))
        return axes, Request(
            displacement=_along(ahead, moved),
            velocity=here_v,
            acceleration=here_a,
            held=(moved,) * space.axes,
            max_velocity=np.full(space.axes, max(fastest, 1e-6)),
            max_acceleration=np.full(space.axes, along[0]),
            max_jerk=np.full(space.axes, along[1]),
            together=False,
        )
    goal = ahead if moved else np.zeros(space.axes)
    return np.eye(space.axes), Request(
        displacement=goal,
        velocity=v,
        acceleration=a,
        held=tuple(moved and not (way.free and d == 0.0) for d in goal.tolist()),
        max_velocity=np.maximum(velocity, 1e-6),
        max_acceleration=acceleration,
        max_jerk=jerk,
        together=True,
    )


def _along(ahead: Array, moved: bool) -> Array:
    goal = np.zeros(len(ahead))
    if moved:
        goal[0] = float(np.linalg.norm(ahead))
    return goal


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
