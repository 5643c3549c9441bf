"""A path of the tool tip: the cubic between two Cartesian knots, turned into joints tick by tick.

The joints beyond the arms, a tool's rotation, stand still.
"""

from __future__ import annotations

from deltaviz.link.board.kinematics import Vector
from deltaviz.link.board.parameters import Parameters
from deltaviz.link.board.queue import Knot
from deltaviz.link.board.real_cubic import RealCubic
from deltaviz.link.board.tip import P_STEP, V_STEP

_Q32 = 1 << 32
_Q10_TO_Q32 = 22
_V_UNIT = 65.536  # 2^-16 microsteps/ms in a microstep/s


class TipPath:
    """Positions in Q32, velocities in 2^-16 microsteps per millisecond, as of any path."""

    def __init__(
        self, parameters: Parameters, start: Knot, end: Knot, *, ticks: int, tick_hz: int
    ) -> None:
        assert parameters.kinematics is not None
        self.ticks = ticks
        self.rests = end.rests
        self._kinematics = parameters.kinematics
        self._per_rad = parameters.configure.microsteps_per_rad
        self._tick_hz = tick_hz
        self._axes = tip_axes(start, end, ticks / tick_hz)
        self._held = [p << _Q10_TO_Q32 for p in start.p[3:]]

    def positions(self, tick: int) -> list[int] | None:
        t = tick / self._tick_hz
        x, y, z = (axis.position(t) for axis in self._axes)
        angles = self._kinematics.angles((x, y, z))
        if angles is None:
            return None
        moved = zip(angles, self._per_rad, strict=False)
        return [int(angle * m * _Q32) for angle, m in moved] + self._held

    def velocities(self, tick: int) -> list[int] | None:
        motions = self._kinematics.motions(*tip_state(self._axes, tick / self._tick_hz))
        if motions is None:
            return None
        moved = zip(motions, self._per_rad, strict=False)
        return [int(motion.rate * m * _V_UNIT) for motion, m in moved] + [0] * len(self._held)


def tip_axes(start: Knot, end: Knot, seconds: float) -> list[RealCubic]:
    """The tip's motion between Cartesian knots, mm and s."""
    return [
        RealCubic(
            start.p[i] * P_STEP, end.p[i] * P_STEP, start.v[i] * V_STEP, end.v[i] * V_STEP, seconds
        )
        for i in range(3)
    ]


def tip_state(axes: list[RealCubic], t: float) -> tuple[Vector, Vector, Vector]:
    """Position, velocity and acceleration after t seconds."""
    x, y, z = axes
    return (
        (x.position(t), y.position(t), z.position(t)),
        (x.velocity(t), y.velocity(t), z.velocity(t)),
        (x.acceleration(t), y.acceleration(t), z.acceleration(t)),
    )
