"""The bounded queue of segments, and when each of them really starts."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

from deltaviz.link.messages import Segment
from deltaviz.link.rules import since


@dataclass(frozen=True, slots=True)
class Entry:
    segment: Segment
    start: int  # board tick


class SegmentQueue:
    """Knots of one epoch in order. `end` is the tick at which the last one is really reached,
    `nominal_end` the host's own time for it, `knot` its position and velocity.
    """

    def __init__(self, places: int) -> None:
        self._places = places
        self._entries: deque[Entry] = deque()
        self.end = 0
        self.nominal_end = 0
        self.next_index = 0
        self.p: tuple[int, ...] = ()
        self.v: tuple[int, ...] = ()

    def __len__(self) -> int:
        return len(self._entries)

    @property
    def free(self) -> int:
        return self._places - len(self._entries)

    @property
    def head(self) -> Entry | None:
        return self._entries[0] if self._entries else None

    def open(self, p: tuple[int, ...], t_start: int) -> None:
        """A new epoch at rest at `p`."""
        self._entries.clear()
        self.nominal_end = t_start
        self.next_index = 0
        self.p = p
        self.v = (0,) * len(p)

    def push(self, segment: Segment, *, idle_at: int | None) -> None:
        """`idle_at` is the present tick when nothing runs and nothing waits, else None."""
        previous_end = self.end if idle_at is None else idle_at
        wait = since(segment.t_end - segment.duration, previous_end) if not any(self.v) else 0
        start = (previous_end + max(wait, 0)) & 0xFFFF_FFFF
        self._entries.append(Entry(segment, start))
        self.end = (start + segment.duration) & 0xFFFF_FFFF
        self.nominal_end = segment.t_end
        self.next_index = (segment.index + 1) & 0xFFFF
        self.p, self.v = segment.p, segment.v

    def pop(self) -> Entry:
        return self._entries.popleft()

    def clear(self) -> None:
        self._entries.clear()
