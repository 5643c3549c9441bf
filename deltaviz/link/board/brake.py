"""The one brake: all joints along the tangent, to rest, in one common time."""

from __future__ import annotations

from collections.abc import Sequence

from deltaviz.link.board.paths import Ramp


def brake(
    *,
    positions: Sequence[int],
    velocities: Sequence[int],
    accelerations: Sequence[int],
    ticks_per_ms: int,
) -> Ramp:
    """The brake from here: T = max |v_i| / a_i, at least 1 ms.

    `positions` in Q32, `velocities` in 2^-16 microsteps per ms, `accelerations` in 2^-32
    microsteps per ms².
    """
    ticks = ticks_per_ms
    for velocity, acceleration in zip(velocities, accelerations, strict=True):
        ticks = max(ticks, -((-(abs(velocity) << 16) * ticks_per_ms) // acceleration))
    return Ramp(
        start=positions,
        v_start=velocities,
        v_end=[0] * len(velocities),
        ticks=ticks,
        ticks_per_ms=ticks_per_ms,
    )
