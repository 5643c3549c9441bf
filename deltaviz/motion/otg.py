"""Jerk-limited motion from any state to rest: ruckig, fed with what it digests.

Lengths go in as metres (in millimetres it fails in a few per cent of updates). Its profiles are
evaluated here, for all knots at once. Whatever it raises means: no new motion.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
import ruckig

from deltaviz.mechanism.compiled import compiled
from deltaviz.motion.followed import Array

_otg: Any = ruckig  # it has no types


@dataclass(frozen=True, slots=True)
class Request:
    """A motion from (0, velocity, acceleration) to rest, in any one unit of length and s.

    Axes marked `held` go to `displacement`; the others only come to rest. With `together` the
    axes keep their proportions and end at the same time.
    """

    displacement: Array
    velocity: Array
    acceleration: Array
    held: tuple[bool, ...]
    max_velocity: Array
    max_acceleration: Array
    max_jerk: Array
    together: bool

    def __add__(self, other: Self) -> Request:
        """Both motions at once, each on its own axes."""
        return Request(
            displacement=np.append(self.displacement, other.displacement),
            velocity=np.append(self.velocity, other.velocity),
            acceleration=np.append(self.acceleration, other.acceleration),
            held=self.held + other.held,
            max_velocity=np.append(self.max_velocity, other.max_velocity),
            max_acceleration=np.append(self.max_acceleration, other.max_acceleration),
            max_jerk=np.append(self.max_jerk, other.max_jerk),
            together=self.together and other.together,
        )


class Generator:
    """Makes motions of `axes` axes. `scale` turns a unit of length into what ruckig is fed."""

    def __init__(self, axes: int, scale: float) -> None:
        self._ruckig = _otg.Ruckig(axes)
        self._input = _otg.InputParameter(axes)
        self._trajectory = _otg.Trajectory(axes)
        self._axes = axes
        self._scale = scale
        self._controlled: tuple[tuple[bool, ...], bool] | None = None
        self._input.current_position = [0.0] * axes

    def __call__(self, request: Request, period: float) -> tuple[Array, Array, Array] | None:
        """Position, velocity, acceleration (K+1, axes), one row per `period`, or None."""
        given = self._input
        scale = self._scale
        given.current_velocity = (request.velocity * scale).tolist()
        given.current_acceleration = (request.acceleration * scale).tolist()
        given.target_position = (request.displacement * scale).tolist()
        given.max_velocity = (request.max_velocity * scale).tolist()
        given.max_acceleration = (request.max_acceleration * scale).tolist()
        given.max_jerk = (request.max_jerk * scale).tolist()
        self._control(request.held, request.together)
        try:
            result = self._ruckig.calculate(given, self._trajectory)
        except (_otg.RuckigError, ValueError):  # a ValueError for results that it has no name for
            return None
        if result not in (_otg.Result.Working, _otg.Result.Finished):
            return None
        return self._rows(request, period)

    def _control(self, held: tuple[bool, ...], together: bool) -> None:
        if self._controlled == (held, together):
            return
        self._controlled = (held, together)
        alike = _otg.Synchronization.Phase if together else _otg.Synchronization.No
        self._input.per_dof_synchronization = [alike] * self._axes
        control = _otg.ControlInterface
        self._input.per_dof_control_interface = [
            control.Position if to_place else control.Velocity for to_place in held
        ]

    def _rows(self, request: Request, period: float) -> tuple[Array, Array, Array]:
        profiles = self._trajectory.profiles[0]
        times = np.array([(*p.brake.t, *p.t, *p.accel.t) for p in profiles])
        jerks = np.array([(*p.brake.j, *p.j, *p.accel.j) for p in profiles]) / self._scale
        duration = max(sum(row) for row in times.tolist())
        count = max(1, math.ceil(duration / period - 1e-6))
        q, v, a = run(times, jerks, request.velocity, request.acceleration, period, count)
        held = np.asarray(request.held)
        q[-1, held] = request.displacement[held]  # at rest there, whatever rounding says
        v[-1] = 0.0
        a[-1] = 0.0
        return q, v, a


@compiled
def run(
    times: Array, jerks: Array, velocity: Array, acceleration: Array, period: float, count: int
) -> tuple[Array, Array, Array]:
    """Each axis's pieces of constant jerk, from position 0, at 0, 1 .. `count` periods."""
    axes, pieces = times.shape
    q = np.empty((count + 1, axes))
    v = np.empty((count + 1, axes))
    a = np.empty((count + 1, axes))
    for i in range(axes):
        p0 = 0.0
        v0 = velocity[i]
        a0 = acceleration[i]
        start = 0.0
        piece = 0
        for k in range(count + 1):
            now = k * period
            while piece < pieces and now > start + times[i, piece]:
                t = times[i, piece]
                j = jerks[i, piece]
                p0 += t * (v0 + t * (a0 / 2 + t * j / 6))
                v0 += t * (a0 + t * j / 2)
                a0 += t * j
                start += t
                piece += 1
            if piece == pieces:
                v0 = 0.0
                a0 = 0.0
            t = now - start
            j = jerks[i, piece] if piece < pieces else 0.0
            q[k, i] = p0 + t * (v0 + t * (a0 / 2 + t * j / 6))
            v[k, i] = v0 + t * (a0 + t * j / 2)
            a[k, i] = a0 + t * j
    return q, v, a
