"""The bounded queue of segments, and when each of them really starts."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

from deltaviz.link.messages import Segment
from deltaviz.link.rules import since

MASK = 0xFFFF_FFFF


@dataclass(frozen=True, slots=True)
class Knot:
    """Where segments meet, in units of the messages."""

    p: tuple[int, ...]
    v: tuple[int, ...]

    @property
    def rests(self) -> bool:
        return not any(self.v)


@dataclass(frozen=True, slots=True)
class Entry:
    segment: Segment
    origin: Knot
    start: int  # board tick


class SegmentQueue:
    """Segments of one epoch in order. `end` is the tick at which the last one is really reached,
    `nominal_end` the host's own time for it, `knot` where it leads.
    """

    def __init__(self, places: int) -> None:
        self._places = places
        self._entries: deque[Entry] = deque()
        self.end = 0
        self.nominal_end = 0
        self.next_index = 0
        self.knot = Knot((), ())

    def __len__(self) -> int:
        return len(self._entries)

    @property
    def free(self) -> int:
        return self._places - len(self._entries)

    @property
    def head(self) -> Entry | None:
        return self._entries[0] if self._entries else None

    def open(self, p: tuple[int, ...], *, t_start: int, planned: int) -> None:
        """A new epoch at rest at `p`."""
        self._entries.clear()
        self.end = planned
        self.nominal_end = t_start
        self.next_index = 0
        self.knot = Knot(p, (0,) * len(p))

    def push(self, segment: Segment, *, planned: int, idle: bool) -> None:
        """Nothing begins before `planned`, the tick until which motion is planned. `idle`: nothing
        moves and nothing waits to, maybe since long ago.
        """
        start = self.end
        if self.knot.rests:
            earliest = planned if idle or since(planned, self.end) > 0 else self.end
            wait = since(segment.t_end - segment.duration, earliest)
            start = (earliest + max(wait, 0)) & MASK
        self._entries.append(Entry(segment, self.knot, start))
        self.end = (start + segment.duration) & MASK
        self.nominal_end = segment.t_end
        self.next_index = (segment.index + 1) & 0xFFFF
        self.knot = Knot(segment.p, segment.v)

    def pop(self) -> Entry:
        return self._entries.popleft()

    def clear(self) -> None:
        self._entries.clear()
