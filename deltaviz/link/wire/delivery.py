"""The host's end of the wire, without IO: messages to frames, bytes to messages, time passed in.

One command is outstanding at a time; it is repeated byte for byte until its answer comes, and the
others wait in order. What is no command goes out at once, before whatever waits.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

from deltaviz.link.messages import (
    BoardMessage,
    BoardState,
    Configure,
    Enable,
    EStop,
    Hello,
    Home,
    HostMessage,
    Stop,
    Telemetry,
    TelemetryFlags,
)
from deltaviz.link.timing import COMMAND_REPEAT
from deltaviz.link.wire.codec import encode
from deltaviz.link.wire.commands import COMMANDS, answered_by, name_of, next_sequence
from deltaviz.link.wire.errors import Malformed
from deltaviz.link.wire.frames import Frame, FrameReader, write_frame
from deltaviz.link.wire.versions import decode_from_any_board


@dataclass(slots=True)
class _Outstanding:
    command: HostMessage
    sequence: int
    frame: bytes
    sent_at: float
    repeat_at: float
    repetitions: int = 0
    seen_homing: bool = False


class Delivery:
    """`sequence` is that of the last command; a new one begins at random, so that its Hello is
    not taken for a repetition of what an earlier host has sent.
    """

    def __init__(self, sequence: int) -> None:
        self._sequence = sequence
        self._waiting: deque[HostMessage] = deque()
        self._outstanding: _Outstanding | None = None
        self._reader = FrameReader()
        self._malformed = 0
        self.repeated = 0  # commands, in all
        self.round_trip: float | None = None  # s, of the newest command answered at once

    @property
    def dropped(self) -> int:
        """Frames that arrived and were no messages from a board."""
        return self._reader.dropped + self._malformed

    @property
    def repeat_at(self) -> float | None:
        """When `due` has something to repeat."""
        return None if self._outstanding is None else self._outstanding.repeat_at

    def send(self, message: HostMessage, now: float) -> list[bytes]:
        """The frames to send at once. Raises Unsendable."""
        type_, payload = encode(message)
        self._forget_for(message)
        if not isinstance(message, COMMANDS):
            return [write_frame(type_, 0, payload)]
        self._waiting.append(message)
        return self._next(now)

    def receive(self, data: bytes, now: float) -> tuple[list[BoardMessage], list[bytes]]:
        """What the board has said, and the frames to send now that it has answered."""
        said: list[BoardMessage] = []
        for frame in self._reader.feed(data):
            try:
                message = decode_from_any_board(frame)
            except Malformed:
                self._malformed += 1
                continue
            if self._is_new(message, frame, now):
                said.append(message)
        return said, self._next(now)

    def due(self, now: float) -> list[bytes]:
        """What is to be repeated now."""
        outstanding = self._outstanding
        if outstanding is None or now < outstanding.repeat_at:
            return []
        outstanding.repeat_at = now + COMMAND_REPEAT
        outstanding.repetitions += 1
        self.repeated += 1
        return [outstanding.frame]

    def _next(self, now: float) -> list[bytes]:
        if self._outstanding is not None or not self._waiting:
            return []
        command = self._waiting.popleft()
        self._sequence = next_sequence(self._sequence)
        type_, payload = encode(command)
        frame = write_frame(type_, self._sequence, payload)
        self._outstanding = _Outstanding(command, self._sequence, frame, now, now + COMMAND_REPEAT)
        return [frame]

    def _is_new(self, message: BoardMessage, frame: Frame, now: float) -> bool:
        """An answer is taken once, and only by the command that waits for it."""
        name, outstanding = answered_by(message), self._outstanding
        if name is None:
            if isinstance(message, Telemetry):
                self._watch_homing(message)
            return True
        if (
            outstanding is None
            or outstanding.sequence != frame.sequence
            or name_of(outstanding.command) != name
        ):
            return False
        self._outstanding = None
        if not outstanding.repetitions and not isinstance(outstanding.command, Home):
            self.round_trip = now - outstanding.sent_at  # else: which one was answered?
        return True

    # What is given up.

    def _forget_for(self, message: HostMessage) -> None:
        """What `message` overrules is neither sent nor repeated any more."""
        self._waiting = deque(m for m in self._waiting if not _overrules(message, m))
        if self._outstanding is not None and _overrules(message, self._outstanding.command):
            self._outstanding = None

    def _watch_homing(self, telemetry: Telemetry) -> None:
        """A homing that does not come to its end is not answered."""
        outstanding = self._outstanding
        if outstanding is None or not isinstance(outstanding.command, Home):
            return
        if telemetry.state is BoardState.HOMING:
            outstanding.seen_homing = True
        elif telemetry.state in (BoardState.ESTOP, BoardState.FAULT) or (
            outstanding.seen_homing
            and telemetry.state is not BoardState.BRAKING
            and TelemetryFlags.HOMED not in telemetry.flags
        ):
            self._outstanding = None


def _overrules(message: HostMessage, command: HostMessage) -> bool:
    """A session begins anew. Nothing that leads to motion survives a stop. The drivers can be
    switched off while homing, which is answered only when it ends.
    """
    if isinstance(message, Hello):
        return True
    if isinstance(message, Stop | EStop):
        return not isinstance(command, Hello | Configure) and command != Enable(on=False)
    return message == Enable(on=False) and isinstance(command, Home)
