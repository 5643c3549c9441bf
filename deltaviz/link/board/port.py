"""The simulated board's end of the wire: bytes in, bytes out. Each command is carried out once."""

from __future__ import annotations

from deltaviz.link.board.board import SimulatedBoard
from deltaviz.link.messages import BoardMessage, EStop, Hello, HostMessage, Stop, Telemetry
from deltaviz.link.wire.codec import decode_host, encode
from deltaviz.link.wire.commands import COMMANDS, answered_by, is_newer, name_of
from deltaviz.link.wire.errors import Malformed
from deltaviz.link.wire.frames import Frame, FrameReader, write_frame

_BEFORE_HELLO = (Hello, Stop, EStop)


class BoardPort:
    """Until its first Hello the board takes only stops and sends no telemetry, so that what else
    opens the link sees silence.
    """

    def __init__(self, board: SimulatedBoard) -> None:
        self.board = board
        self._reader = FrameReader()
        self._malformed = 0
        self._greeted = False
        self._last: int = 0  # the sequence of the last command
        self._answer = b""  # to it, once it is there
        self._sequences: dict[str, int] = {}  # of the last command of each name
        self._out: list[bytes] = []

    @property
    def dropped(self) -> int:
        """Frames that arrived and were no messages from a host."""
        return self._reader.dropped + self._malformed

    def feed(self, data: bytes) -> None:
        for frame in self._reader.feed(data):
            try:
                self._receive(decode_host(frame.type, frame.payload), frame)
            except Malformed:
                self._malformed += 1

    def take(self) -> list[bytes]:
        """The frames that the board has sent since the last call."""
        self._collect()
        out, self._out = self._out, []
        return out

    def _receive(self, message: HostMessage, frame: Frame) -> None:
        if not self._greeted and not isinstance(message, _BEFORE_HELLO):
            return
        if isinstance(message, COMMANDS) and not self._is_turn(message, frame.sequence):
            return
        self.board.receive(message)
        self._collect()

    def _is_turn(self, command: HostMessage, sequence: int) -> bool:
        if self._greeted and sequence == self._last:
            if self._answer:
                self._out.append(self._answer)
            return False
        begins = isinstance(command, Hello)
        if sequence == 0 or not (begins or is_newer(sequence, self._last)):
            return False
        self._collect()  # what was said before is no answer to this
        if begins:
            self._greeted = True
            self._sequences.clear()
        self._last = sequence
        self._answer = b""
        self._sequences[name_of(command)] = sequence
        return True

    def _collect(self) -> None:
        for message in self.board.take():
            if self._greeted or not isinstance(message, Telemetry):
                self._out.append(self._framed(message))

    def _framed(self, message: BoardMessage) -> bytes:
        type_, payload = encode(message)
        name = answered_by(message)
        if name is None:
            return write_frame(type_, 0, payload)
        sequence = self._sequences.get(name, 0)
        frame = write_frame(type_, sequence, payload)
        if sequence == self._last:
            self._answer = frame
        return frame
