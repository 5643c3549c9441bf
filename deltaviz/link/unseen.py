"""The segments of which no telemetry has told that the board took them, and when they are repeated.

A board takes each index once and in order, so a repetition does no harm. When it refuses one that
was sent only once, the one before is missing; that is quick. What else is lost is repeated after a
while, which grows with the link's own round trips: a slow link is not made slower.

All times are the board's, by the telemetry that the host had.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, replace

from deltaviz.link.messages import CartesianSegment, Segment, Telemetry, TelemetryFlags
from deltaviz.link.rules import since, since16
from deltaviz.link.timing import GAP_REPEAT, LOSSY_FOR, NOT_BEGUN, SEGMENT_REPEAT

_ROUND_TRIPS = 2.0  # of the longest, before a segment is thought to be lost
_FORGETS = 0.98  # of the longest round trip, with each segment that is told of


@dataclass(slots=True)
class _Sent:
    segment: Segment | CartesianSegment
    first: int  # tick
    last: int  # tick
    copies: int = 1


class Unseen:
    """Of one epoch."""

    def __init__(self, *, tick_hz: int) -> None:
        self._tick_hz = tick_hz
        self._sent: deque[_Sent] = deque()
        self._gap = False
        self._patience = SEGMENT_REPEAT
        self._repeated: int | None = None  # tick at which something last was

    def __len__(self) -> int:
        return len(self._sent)

    @property
    def ticks(self) -> int:
        """How long they take."""
        return sum(sent.segment.duration for sent in self._sent)

    def add(self, segment: Segment | CartesianSegment, telemetry: Telemetry) -> None:
        self._sent.append(_Sent(segment, telemetry.now, telemetry.now))

    def acknowledge(self, telemetry: Telemetry) -> None:
        """Forget those up to `telemetry.last_index`. "None taken yet" is 65535, one before the
        first index: it acknowledges nothing here.
        """
        while self._sent and since16(telemetry.last_index, self._sent[0].segment.index) >= 0:
            sent = self._sent.popleft()
            self._gap = False
            if sent.copies == 1:
                trip = self._seconds(sent.last, telemetry)
                self._patience = max(SEGMENT_REPEAT, _ROUND_TRIPS * trip, _FORGETS * self._patience)

    def passed_over(self, index: int | None) -> None:
        """The board refused a segment of this index, as it was not the next."""
        for sent in list(self._sent)[1:]:
            self._gap |= sent.segment.index == index and sent.copies == 1

    def repeats(self, telemetry: Telemetry) -> list[Segment | CartesianSegment]:
        """What is to be sent again now, in order: all, if the first seems to be lost."""
        if not self._sent:
            return []
        waited = self._seconds(self._sent[0].last, telemetry)
        if waited < (GAP_REPEAT if self._gap else self._patience):
            return []
        if not self._gap:
            self._patience *= 2  # it may be the link that is slow
        self._gap = False
        self._repeated = telemetry.now
        for sent in self._sent:
            sent.last = telemetry.now
            sent.copies += 1
        return [replace(sent.segment, seen=telemetry.now) for sent in self._sent]

    def too_late(self, telemetry: Telemetry) -> bool:
        """A motion from rest has not reached the board for so long that it must not begin."""
        if not self._sent or TelemetryFlags.MOVING in telemetry.flags:
            return False
        return self._seconds(self._sent[0].first, telemetry) >= NOT_BEGUN

    def lossy(self, telemetry: Telemetry) -> bool:
        """Whether something had to be repeated just now, or seems to be lost."""
        if self._sent and self._seconds(self._sent[0].first, telemetry) >= SEGMENT_REPEAT:
            return True
        return self._repeated is not None and self._seconds(self._repeated, telemetry) < LOSSY_FOR

    def _seconds(self, tick: int, telemetry: Telemetry) -> float:
        return since(telemetry.now, tick) / self._tick_hz
