"""What the steppers follow: positions as functions of the tick, in integers that fit 64 bits.

Positions go in and out in Q32 (2^-32 microsteps) unless named otherwise, velocities in 2^-16
microsteps per millisecond. A path begins at tick 0 and ends at tick `ticks`.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

Q10_TO_Q32 = 22


class Path(Protocol):
    @property
    def ticks(self) -> int: ...

    @property
    def rests(self) -> bool:
        """Whether it ends at rest."""
        ...

    def positions(self, tick: int) -> list[int] | None:
        """None: the joints cannot be there."""
        ...

    def velocities(self, tick: int) -> Sequence[int] | None: ...


class Cubic:
    """The cubic between two knots, in Hermite form over u = tick / ticks (Q30):

    p = p0 + d (3u² - 2u³) + m0 (u - 2u² + u³) + m1 (u³ - u²), where d = p1 - p0 and m = v · ticks.
    """

    def __init__(
        self,
        *,
        start: Sequence[int],
        end: Sequence[int],
        v_start: Sequence[int],
        v_end: Sequence[int],
        ticks: int,
        ticks_per_ms: int,
    ) -> None:
        """Knots' positions are in 2^-10 microsteps, as in messages."""
        self.ticks = ticks
        self.rests = not any(v_end)
        self._ticks_per_ms = ticks_per_ms
        self._v_end = v_end
        self._joints = [
            (p0 << Q10_TO_Q32, p1 - p0, v0 * ticks // ticks_per_ms, v1 * ticks // ticks_per_ms)
            for p0, p1, v0, v1 in zip(start, end, v_start, v_end, strict=True)
        ]

    def positions(self, tick: int) -> list[int]:
        u = (tick << 30) // self.ticks
        u2 = (u * u) >> 30
        u3 = (u2 * u) >> 30
        h = 3 * u2 - 2 * u3
        g0 = u - 2 * u2 + u3
        g1 = u3 - u2
        return [p0 + ((d * h) >> 8) + ((m0 * g0 + m1 * g1) >> 14) for p0, d, m0, m1 in self._joints]

    def velocities(self, tick: int) -> Sequence[int]:
        if tick == self.ticks:
            return self._v_end  # without the rounding of m
        u = (tick << 30) // self.ticks
        u2 = (u * u) >> 30
        h = 6 * (u - u2)
        g0 = (1 << 30) - 4 * u + 3 * u2
        g1 = 3 * u2 - 2 * u
        return [
            (((d * h) >> 24) + ((m0 * g0 + m1 * g1) >> 30)) * self._ticks_per_ms // self.ticks
            for _, d, m0, m1 in self._joints
        ]


class Ramp:
    """Every joint from one velocity to another, evenly, in the same time."""

    def __init__(
        self,
        *,
        start: Sequence[int],
        v_start: Sequence[int],
        v_end: Sequence[int],
        ticks: int,
        ticks_per_ms: int,
    ) -> None:
        self.ticks = ticks
        self.rests = not any(v_end)
        self._ticks_per_ms = ticks_per_ms
        self._joints = list(zip(start, v_start, v_end, strict=True))

    def positions(self, tick: int) -> list[int]:
        span = 2 * self.ticks
        return [
            p0 + (((tick * (v0 * span + (v1 - v0) * tick) // span) << 16) // self._ticks_per_ms)
            for p0, v0, v1 in self._joints
        ]

    def velocities(self, tick: int) -> list[int]:
        return [v0 + (v1 - v0) * tick // self.ticks for _, v0, v1 in self._joints]
