"""What a host has commanded, as messages say it: cubics between knots, in microsteps and ticks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deltaviz.link.messages import Segment

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


@dataclass(frozen=True)
class CommandedPath:
    """From rest at `counts`, and at rest there again after the last of n cubics. Positions are in
    microsteps, velocities in microsteps per tick.
    """

    counts: tuple[int, ...]
    begins: Ints  # (n,) ticks
    ticks: Ints  # (n,)
    positions_at_knots: Floats  # (n + 1, joints)
    velocities_at_knots: Floats  # (n + 1, joints)

    @property
    def begin(self) -> int:
        return int(self.begins[0])

    @property
    def end(self) -> int:
        return int(self.begins[-1] + self.ticks[-1])

    def going_on(self, ticks: int) -> CommandedPath:
        """As if it went on with the velocity of its last knot."""
        last, velocity = self.positions_at_knots[-1], self.velocities_at_knots[-1]
        return CommandedPath(
            self.counts,
            np.append(self.begins, self.end),
            np.append(self.ticks, ticks),
            np.vstack([self.positions_at_knots, last + velocity * ticks]),
            np.vstack([self.velocities_at_knots, velocity]),
        )

    def positions(self, at: Ints) -> Floats:
        """(ticks, joints)."""
        piece = np.clip(np.searchsorted(self.begins, at, side="right") - 1, 0, None)
        ticks = self.ticks[piece][:, None]
        u = np.clip((at - self.begins[piece])[:, None] / ticks, 0.0, 1.0)
        p0, p1 = self.positions_at_knots[piece], self.positions_at_knots[piece + 1]
        m0 = self.velocities_at_knots[piece] * ticks
        m1 = self.velocities_at_knots[piece + 1] * ticks
        return (
            p0 + (p1 - p0) * (3 * u**2 - 2 * u**3) + m0 * (u - 2 * u**2 + u**3) + m1 * (u**3 - u**2)
        )


def commanded_path(
    counts: Sequence[int], segments: Sequence[Segment], *, late: int, ticks_per_ms: int
) -> CommandedPath:
    """`late`: the ticks by which the board runs behind the host's own times. Segments follow each
    other without a pause.
    """
    return CommandedPath(
        tuple(counts),
        np.array([segment.t_end - segment.duration + late for segment in segments]),
        np.array([segment.duration for segment in segments]),
        np.array([counts, *(np.array(segment.p) / 1024 for segment in segments)]),
        np.array(
            [
                np.zeros(len(counts)),
                *(np.array(segment.v) / 65536 / ticks_per_ms for segment in segments),
            ]
        ),
    )
