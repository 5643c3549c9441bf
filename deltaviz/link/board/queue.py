"""The bounded queue of segments, and when each of them really starts."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

from deltaviz.link.messages import CartesianSegment, Segment
from deltaviz.link.rules import since

MASK = 0xFFFF_FFFF


@dataclass(frozen=True, slots=True)
class Knot:
    """Where segments meet, in units of the messages: of the joints, or of the tool tip (x, y, z)
    and whatever joints there are beyond the arms.
    """

    p: tuple[int, ...]
    v: tuple[int, ...]
    cartesian: bool = False

    @property
    def rests(self) -> bool:
        return not any(self.v)


@dataclass(frozen=True, slots=True)
class Entry:
    origin: Knot
    knot: Knot
    start: int  # board tick
    duration: int


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

    def push(
        self, segment: Segment | CartesianSegment, origin: Knot, *, planned: int, idle: bool
    ) -> None:
        """`origin` is `knot`, as the segment speaks of it. Nothing begins before `planned`, the
        tick until which motion is planned. `idle`: nothing moves and nothing waits to, maybe since
        long ago.
        """
        start = self.end
        if origin.rests:
            earliest = planned if idle or since(planned, self.end) > 0 else self.end
            wait = since(segment.t_end - segment.duration, earliest)
            start = (earliest + max(wait, 0)) & MASK
        self.knot = knot_of(segment, origin)
        self._entries.append(Entry(origin, self.knot, start, segment.duration))
        self.end = (start + segment.duration) & MASK
        self.nominal_end = segment.t_end
        self.next_index = (segment.index + 1) & 0xFFFF

    def pop(self) -> Entry:
        return self._entries.popleft()

    def clear(self) -> None:
        self._entries.clear()


def knot_of(segment: Segment | CartesianSegment, origin: Knot) -> Knot:
    """Where a segment leads, whose `origin` is of its own kind."""
    if isinstance(segment, Segment):
        return Knot(segment.p, segment.v)
    held = origin.p[3:]
    return Knot((*segment.p, *held), (*segment.v, *(0 for _ in held)), cartesian=True)
