"""The board's lease on its host's attention: motion needs a host that saw recent telemetry."""

from __future__ import annotations

from deltaviz.link.rules import since


class Lease:
    """Alive for `ticks` after the newest telemetry tick that the host is known to have seen."""

    def __init__(self, ticks: int) -> None:
        self._ticks = ticks
        self._seen: int | None = None

    @property
    def alive(self) -> bool:
        return self._seen is not None

    def extend(self, seen: int, now: int) -> None:
        """A `seen` in the future, expired, or older than the one that counts changes nothing."""
        age = since(now, seen)
        if 0 <= age < self._ticks and (self._seen is None or since(seen, self._seen) > 0):
            self._seen = seen

    def remaining(self, tick: int) -> int | None:
        """Ticks from `tick` until it ends; None when there is none."""
        return None if self._seen is None else self._ticks - since(tick, self._seen)

    def expire(self) -> None:
        """Forgets `seen`, so that it is never compared with a counter that has wrapped since."""
        self._seen = None
