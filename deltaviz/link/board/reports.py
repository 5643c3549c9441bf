"""What the board says: its answers in order, and when telemetry is due.

Telemetry comes every 5 ms of board time: half of a knot, so that the host's estimate of the
queue is never older than that, at 200 messages a second, a tenth of what 921600 baud carry.
"""

from __future__ import annotations

from deltaviz.link.messages import (
    BoardMessage,
    CartesianSegment,
    Done,
    HostMessage,
    Refusal,
    Refused,
    Segment,
)
from deltaviz.link.rules import TELEMETRY_MS


class Reports:
    """`pieces`: those until the next telemetry; `changed`: something that it tells at once."""

    def __init__(self) -> None:
        self._said: list[BoardMessage] = []
        self.pieces = TELEMETRY_MS
        self.changed = False

    @property
    def telemetry_due(self) -> bool:
        return self.changed or self.pieces == 0

    def say(self, message: BoardMessage) -> None:
        self._said.append(message)

    def telemetry(self, message: BoardMessage) -> None:
        self._said.append(message)
        self.changed = False
        if self.pieces == 0:
            self.pieces = TELEMETRY_MS

    def done(self, message: HostMessage) -> None:
        self._said.append(Done(_name(message)))

    def refuse(self, message: HostMessage, reason: Refusal, *, joint: int | None = None) -> None:
        index = message.index if isinstance(message, Segment | CartesianSegment) else None
        index = None if index == 0xFFFF else index  # which the wire has no number for
        self._said.append(Refused(_name(message), reason, joint=joint, index=index))

    def take(self) -> list[BoardMessage]:
        said, self._said = self._said, []
        return said


def _name(message: HostMessage) -> str:
    return type(message).__name__.lower()
