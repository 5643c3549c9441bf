"""How long the host has listened, which is not how long it has waited: while its computer slept or
had no time for it, it heard nothing, and what the board said meanwhile is still to be read.
"""

from __future__ import annotations

from deltaviz.link.timing import LISTENS_FOR


class Listening:
    """In seconds of listening, of which each turn adds at most LISTENS_FOR."""

    def __init__(self, now: float) -> None:
        self._turned = now
        self.since_opening = 0.0
        self.in_vain = 0.0  # since something was heard

    def goes_on(self, now: float) -> None:
        """A turn of the control loop, or something to be read in one."""
        listened = min(now - self._turned, LISTENS_FOR)
        self._turned = now
        self.since_opening += listened
        self.in_vain += listened

    def heard(self, now: float) -> None:
        self.goes_on(now)
        self.in_vain = 0.0
