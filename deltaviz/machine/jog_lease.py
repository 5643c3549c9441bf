"""The dead-man leases: a held jog or drag lives only while its page says so.

A sign of life counts from when it was *sent*: its time on the page's clock plus the smallest
offset between that clock and ours ever seen, that is, by the fastest delivery. So a burst of
signs that was held up on the way extends nothing. The smallest offset may grow by what two
clocks drift apart at the most.
"""

from __future__ import annotations

from collections import OrderedDict

LEASE = 0.200  # s after the sending of the last sign of life
DRIFT = 200e-6  # s/s between two computers' clocks, at the most
MAX_ENDED = 65536  # ended presses remembered; a page would need days of pressing to come round
MAX_CLOCKS = 256


class PageClock:
    """How far a page's clock is from ours, by the fastest delivery seen."""

    def __init__(self) -> None:
        self._offset = float("inf")
        self._at = 0.0

    def sending(self, *, sent_ms: float, at: float) -> float:
        """Our time at which what arrived `at` was sent; never later than `at`."""
        sent = sent_ms / 1000
        drifted = self._offset + DRIFT * max(0.0, at - self._at)
        self._offset = min(drifted, at - sent)
        self._at = at
        return sent + self._offset


class PageClocks:
    """One clock per page of each client."""

    def __init__(self) -> None:
        self._clocks: OrderedDict[tuple[str, str], PageClock] = OrderedDict()

    def sending(self, client: str, clock: str, *, sent_ms: float, at: float) -> float:
        key = (client, clock)
        known = self._clocks.setdefault(key, PageClock())
        self._clocks.move_to_end(key)
        if len(self._clocks) > MAX_CLOCKS:
            self._clocks.popitem(last=False)
        return known.sending(sent_ms=sent_ms, at=at)

    def forget(self, client: str) -> None:
        """A page that is loaded again starts a new clock."""
        for key in [key for key in self._clocks if key[0] == client]:
            del self._clocks[key]


class JogLease:
    """At most one press at a time is alive."""

    def __init__(self, clocks: PageClocks) -> None:
        self._clocks = clocks
        self._ended: OrderedDict[tuple[str, str], None] = OrderedDict()
        self._live: tuple[str, str] | None = None
        self._seq = -1
        self._deadline = float("-inf")

    @property
    def live(self) -> bool:
        return self._live is not None

    def begin(self, client: str, press: str, *, at: float, now: float) -> str | None:
        """A press, which ends the one before. The refusal, or None."""
        if (client, press) in self._ended or self._live == (client, press):
            return "This press was seen before; press again."
        if now >= at + LEASE:
            self._remember((client, press))
            return "This press came too late; press again."
        self.end()
        self._live = (client, press)
        self._seq = -1
        self._deadline = at + LEASE
        return None

    def beat(
        self, client: str, press: str, *, seq: int, sent_ms: float, clock: str, at: float
    ) -> bool:
        """A sign of life; whether it belongs to the press that is alive and is newer than all."""
        sent = self._clocks.sending(client, clock, sent_ms=sent_ms, at=at)
        if self._live != (client, press) or seq <= self._seq:
            return False
        self._seq = seq
        self._deadline = sent + LEASE
        return True

    def expired(self, now: float) -> bool:
        """Whether a press is alive whose last sign of life was sent too long ago."""
        return self._live is not None and now >= self._deadline

    def is_live(self, client: str, press: str) -> bool:
        return self._live == (client, press)

    def end(self) -> None:
        """The press, if one is alive, is over and never lives again."""
        if self._live is not None:
            self._remember(self._live)
        self._live = None

    def _remember(self, press: tuple[str, str]) -> None:
        self._ended[press] = None
        if len(self._ended) > MAX_ENDED:
            self._ended.popitem(last=False)


class DragLease:
    """A drag in the scene, kept alive by the console, which may hear of it before or after.

    Signs of life have no press of their own; their sending times must grow.
    """

    def __init__(self, clocks: PageClocks) -> None:
        self._clocks = clocks
        self._newest: dict[tuple[str, str], float] = {}  # the page's own clock, ms
        self._sent: dict[str, float] = {}  # ours, s
        self._live: str | None = None
        self._deadline = float("-inf")

    @property
    def live(self) -> bool:
        return self._live is not None

    def is_live(self, client: str) -> bool:
        return self._live == client

    def begin(self, client: str, *, at: float, now: float) -> str | None:
        """The handle was grabbed. The refusal, or None."""
        if now >= at + LEASE:
            return "This grab came too late; grab the handle again."
        self._live = client
        self._deadline = max(at, self._sent.get(client, at)) + LEASE
        return None

    def alive(self, client: str, *, sent_ms: float, clock: str, at: float) -> None:
        """A sign of life of `client`'s."""
        sent = self._clocks.sending(client, clock, sent_ms=sent_ms, at=at)
        if sent_ms <= self._newest.get((client, clock), float("-inf")):
            return
        self._newest[client, clock] = sent_ms
        self._sent[client] = sent
        if self._live == client:
            self._deadline = sent + LEASE

    def expired(self, now: float) -> bool:
        return self._live is not None and now >= self._deadline

    def end(self) -> None:
        self._live = None

    def forget(self, client: str) -> None:
        self._sent.pop(client, None)
        for key in [key for key in self._newest if key[0] == client]:
            del self._newest[key]
