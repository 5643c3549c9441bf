"""At which tick of its own clock a board heard what a capture says it was sent."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Sequence
from itertools import pairwise

from deltaviz.link import messages as m
from deltaviz.link.capture.spoken import Spoken, of_kind
from deltaviz.link.rules import TELEMETRY_MS, since, since16
from deltaviz.link.traffic import Said

Segment = m.Segment | m.CartesianSegment
_NONE_TAKEN = 0xFFFF
_WITHIN = 0.2  # s in which telemetry shows what came of a message
_LEADS_TO: dict[type, frozenset[m.BoardState]] = {
    m.Stop: frozenset({m.BoardState.BRAKING}),
    m.EStop: frozenset({m.BoardState.ESTOP}),
    m.Arm: frozenset({m.BoardState.ARMED}),
    m.Home: frozenset({m.BoardState.HOMING}),
}


class BoardClock:
    """By the telemetry around a time; a change of state is told at the tick at which it happens,
    and motion begins one to two milliseconds after the segment that begins it has come.
    """

    def __init__(self, said: Sequence[Said], *, tick_hz: int) -> None:
        self._telemetry = of_kind(m.Telemetry, said)
        self._times = [item.at for item in self._telemetry]
        segments = [*of_kind(m.Segment, said), *of_kind(m.CartesianSegment, said)]
        self._segments = {
            (item.message.epoch, item.message.index): item.message for item in segments
        }
        self._tick_hz = tick_hz
        self._ticks_per_ms = tick_hz // 1000

    def power_up(self, at: float) -> int:
        """A tick at about this time at which one of the board's milliseconds begins."""
        boundary = self._boundary()
        ahead = since(boundary, self.tick(at))
        return (boundary - -(-ahead // self._ticks_per_ms) * self._ticks_per_ms) & 0xFFFF_FFFF

    def _boundary(self) -> int:
        """One of the ticks of telemetry that came for no other reason than that it was time."""
        ticks = [item.message.now for item in self._telemetry]
        period = TELEMETRY_MS * self._ticks_per_ms
        pairs = pairwise(ticks)
        return next((tick for tick, later in pairs if since(later, tick) == period), ticks[0])

    def tick(self, at: float) -> int:
        """At this time (s): by the newest telemetry, never past the next one."""
        following = bisect_right(self._times, at)
        before = self._telemetry[max(0, following - 1)]
        tick = before.message.now + round((at - before.at) * self._tick_hz)
        if 0 < following < len(self._telemetry):
            latest = self._telemetry[following].message.now
            tick += min(0, since(latest, tick & 0xFFFF_FFFF))
        return tick & 0xFFFF_FFFF

    def heard(self, message: object, at: float) -> int:
        """When the board heard this message, which was sent at this time."""
        first, end = bisect_left(self._times, at), bisect_left(self._times, at + _WITHIN)
        after = self._telemetry[first:end]
        if isinstance(message, m.Segment | m.CartesianSegment) and self._begins(message):
            started = self._started(message, after)
            if started is not None:
                return (started - self._ticks_per_ms * 3 // 2) & 0xFFFF_FFFF
        states = _LEADS_TO.get(type(message), frozenset())
        shown = (item.message.now for item in after if item.message.state in states)
        return next(shown, self.tick(at))

    def _begins(self, segment: Segment) -> bool:
        """Whether it is the first after a rest."""
        before = self._segments.get((segment.epoch, (segment.index - 1) & 0xFFFF))
        return before is None or not any(before.v)

    def _started(self, segment: Segment, after: list[Spoken[m.Telemetry]]) -> int | None:
        """Where the queue began, of which telemetry tells the end."""
        for item in after:
            told = item.message
            count = since16(told.last_index, segment.index) + 1
            if told.epoch != segment.epoch or told.last_index == _NONE_TAKEN or count < 1:
                continue
            indices = ((segment.index + k) & 0xFFFF for k in range(count))
            queued = [self._segments.get((segment.epoch, index)) for index in indices]
            length = sum(item.duration for item in queued if item is not None)
            return (told.t_queue_end - length) & 0xFFFF_FFFF
        return None
