"""What a board executed and what it was commanded, as records for the judge."""

from __future__ import annotations

from dataclasses import dataclass, field

from deltaviz.link.messages import (
    Arm,
    BoardMessage,
    BoardState,
    HostMessage,
    Keep,
    Segment,
    Telemetry,
)
from deltaviz.link.messages import Stopped as BoardStopped
from deltaviz.link.rules import since


@dataclass(frozen=True, slots=True)
class Sample:
    """The board at the end of a millisecond. Between two, every joint moves evenly."""

    tick: int  # the board's, which wraps
    state: BoardState
    epoch: int
    positions: tuple[int, ...]  # 2^-32 microsteps
    counts: tuple[int, ...]  # as the board knows them
    arms: tuple[float, ...]  # rad, where they truly are
    moving: bool
    unheard: int  # ticks since the newest telemetry that the host has said it had


@dataclass
class Executed:
    """One board, from power-up on. What it told is noted before the wire has hurt it."""

    samples: list[Sample] = field(default_factory=list)
    epoch: int = 0
    arms: dict[int, Arm] = field(default_factory=dict)  # by epoch
    segments: dict[tuple[int, int], Segment] = field(default_factory=dict)  # by epoch and index
    queue_ends: dict[tuple[int, int], int] = field(default_factory=dict)  # as told: the same key
    stops: list[int] = field(default_factory=list)  # ticks at which a whole Stop arrived
    told_stops: list[BoardStopped] = field(default_factory=list)
    seen: int | None = None
    lost_power: bool = False  # in the end, whatever moved then

    def command(self, message: HostMessage) -> None:
        """What the host has said; said again, it must be the same."""
        if isinstance(message, Keep | Segment) and (
            self.seen is None or since(message.seen, self.seen) > 0
        ):
            self.seen = message.seen
        if isinstance(message, Arm):
            self._arm(message)
        if isinstance(message, Segment):
            self._segment(message)

    def _arm(self, message: Arm) -> None:
        """An epoch that the board never took may be named again, by a new session."""
        if self.arms.get(message.epoch, message) != message:
            assert self.epoch != message.epoch, "one epoch, armed twice"
            self.segments = {k: s for k, s in self.segments.items() if k[0] != message.epoch}
        self.arms[message.epoch] = message

    def _segment(self, message: Segment) -> None:
        first = self.segments.setdefault((message.epoch, message.index), message)
        assert _motion(first) == _motion(message), "one place in the motion, two segments"

    def note(self, message: BoardMessage) -> None:
        match message:
            case Telemetry():
                self.epoch = message.epoch
                if message.t_queue_end != message.now:
                    self.queue_ends[message.epoch, message.last_index] = message.t_queue_end
            case BoardStopped():
                self.told_stops.append(message)
            case _:
                pass


def _motion(segment: Segment) -> tuple[object, ...]:
    return segment.t_end, segment.duration, segment.p, segment.v
