"""At which tick of its own clock a board heard what a capture says it was sent."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Sequence

from deltaviz.link import messages as m
from deltaviz.link.capture.spoken import Spoken, of_kind
from deltaviz.link.rules import since, since16
from deltaviz.link.traffic import Said

_NONE_TAKEN = 0xFFFF
_WITHIN = 0.2  # s in which telemetry shows what came of a message
_LEADS_TO: dict[type, frozenset[m.BoardState]] = {
    m.Stop: frozenset({m.BoardState.BRAKING}),
    m.EStop: frozenset({m.BoardState.ESTOP}),
    m.Arm: frozenset({m.BoardState.ARMED}),
    m.Home: frozenset({m.BoardState.HOMING}),
}


class BoardClock:
    """By the telemetry around a time; a change of state is told at the tick at which it happens."""

    def __init__(self, said: Sequence[Said], *, tick_hz: int) -> None:
        self._telemetry = of_kind(m.Telemetry, said)
        self._times = [item.at for item in self._telemetry]
        self._segments = {
            (item.message.epoch, item.message.index): item.message
            for item in of_kind(m.Segment, said)
        }
        self._tick_hz = tick_hz

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
        if isinstance(message, m.Segment) and self._begins(message):
            started = self._started(message, after)
            return self.tick(at) if started is None else started
        states = _LEADS_TO.get(type(message), frozenset())
        shown = (item.message.now for item in after if item.message.state in states)
        return next(shown, self.tick(at))

    def _begins(self, segment: m.Segment) -> bool:
        """Whether it is the first after a rest."""
        before = self._segments.get((segment.epoch, (segment.index - 1) & 0xFFFF))
        return before is None or not any(before.v)

    def _started(self, segment: m.Segment, after: list[Spoken[m.Telemetry]]) -> int | None:
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
