"""The lower tier: positions that advance evenly from tick to tick, and the counts they give.

The real board adds an increment each tick and steps when the nearest whole number changes; here
the position after k ticks is the same sum, so no tick need be visited. (The nearest, not the
integer part: truncated, the arms would stand half a microstep off on average.)
"""

from __future__ import annotations

from collections.abc import Sequence

HALF = 1 << 31


def nearest(position: int) -> int:
    """The whole microsteps of a position in Q32; halves go up."""
    return (position + HALF) >> 32


class Stepper:
    """Positions in Q32; `counts` are the whole numbers nearest to them."""

    def __init__(self, joints: int) -> None:
        self._from = [0] * joints
        self._to = [0] * joints
        self._increments = [0] * joints
        self._ticks = 0
        self._elapsed = 0

    @property
    def remaining(self) -> int:
        """Ticks until the target of the present piece; 0 at rest."""
        return self._ticks - self._elapsed

    @property
    def positions(self) -> list[int]:
        if self._elapsed == self._ticks:
            return list(self._to)
        return [p + i * self._elapsed for p, i in zip(self._from, self._increments, strict=True)]

    @property
    def counts(self) -> tuple[int, ...]:
        positions = self._to if self._elapsed == self._ticks else self.positions
        return tuple([nearest(position) for position in positions])

    def place(self, positions: Sequence[int]) -> None:
        """Says where it is, without a step."""
        self._to = list(positions)
        self._ticks = self._elapsed = 0

    def load(self, targets: list[int], ticks: int) -> None:
        """Heads for `targets`, to be there in `ticks`, from the position of this tick."""
        start = self._to if self._elapsed == self._ticks else self.positions
        self._from = start
        self._to = targets
        self._increments = [(t - p) // ticks for t, p in zip(targets, start, strict=True)]
        self._ticks = ticks
        self._elapsed = 0

    def advance(self, ticks: int) -> None:
        """`ticks` must not pass the end of the piece. There, the position is the target itself:
        what the division dropped does not add up.
        """
        self._elapsed += ticks


def piece_ticks(remaining: int, ticks_per_ms: int) -> int:
    """How long the next piece of a path is: 1 ms, and the last two shorter but never tiny."""
    if remaining >= 2 * ticks_per_ms:
        return ticks_per_ms
    return remaining // 2 if remaining > ticks_per_ms else remaining
