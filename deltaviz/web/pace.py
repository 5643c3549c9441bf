"""How much one page may ask: bounded work for each, so that no flood delays another's stop."""

from __future__ import annotations


class Allowance:
    """So many at once, and so many a second after that."""

    def __init__(self, *, burst: float, per_second: float) -> None:
        self._burst = burst
        self._rate = per_second
        self._left = burst
        self._at: float | None = None

    def take(self, now: float) -> bool:
        """Whether one more is within the allowance at the monotonic time `now` (s)."""
        if self._at is not None:
            self._left = min(self._burst, self._left + (now - self._at) * self._rate)
        self._at = now
        if self._left < 1:
            return False
        self._left -= 1
        return True
