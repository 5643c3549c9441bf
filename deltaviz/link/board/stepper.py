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
    """The present piece and the next, of `piece` ticks each. Positions in Q32; where a piece ends,
    the position is its target itself: what the division dropped does not add up.
    """

    def __init__(self, joints: int, piece: int) -> None:
        self._piece = piece
        self._start: Sequence[int] = [0] * joints
        self._target = self._next = self._start
        self._elapsed = 0

    @property
    def positions(self) -> list[int]:
        piece, elapsed = self._piece, self._elapsed
        return [
            p + (t - p) // piece * elapsed
            for p, t in zip(self._start, self._target, strict=True)
        ]  # fmt: skip

    @property
    def counts(self) -> tuple[int, ...]:
        """The whole numbers nearest to the positions."""
        positions = self.positions if self._elapsed else self._start
        return tuple([(position + HALF) >> 32 for position in positions])

    @property
    def stands(self) -> bool:
        """In this piece and the next."""
        return self._start == self._target == self._next

    def advance(self, ticks: int) -> None:
        """Not beyond the end of the piece."""
        self._elapsed += ticks

    def begin_piece(self) -> None:
        """The next piece is the present one; the one behind it stands until it is planned."""
        self._start, self._target = self._target, self._next
        self._elapsed = 0

    def plan(self, targets: Sequence[int]) -> None:
        """The piece after the present one."""
        self._next = targets

    def place(self, positions: Sequence[int]) -> None:
        """Says where it is, or stops it there; without a step."""
        self._start = self._target = self._next = positions
