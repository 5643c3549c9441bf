"""How much motion the board is given ahead: enough for the stalls that this computer has."""

from __future__ import annotations

SHORTEST = 0.060  # s; what a computer with time to spare needs
LONGEST = 0.120  # s; longer, and a jog that is let go would run on noticeably
MEMORY = 10.0  # s for which a stall is remembered


class Horizon:
    """Twice the worst recent gap between two turns of the control loop."""

    def __init__(self) -> None:
        self.seconds = SHORTEST
        self._turned: float | None = None
        self._until = float("-inf")

    def turn(self, now: float, *, moving: bool) -> None:
        """The loop has come round. Gaps count while the robot moves: at rest the loop dozes."""
        gap = now - self._turned if moving and self._turned is not None else 0.0
        self._turned = now if moving else None
        wanted = min(LONGEST, 2 * gap)
        if wanted >= self.seconds:
            self.seconds, self._until = wanted, now + MEMORY
        elif now >= self._until:
            self.seconds = SHORTEST
