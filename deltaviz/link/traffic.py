"""What was said on a link, made of the bytes that passed in each direction."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from deltaviz.link.messages import BoardMessage, HostMessage
from deltaviz.link.wire.codec import decode_board, decode_host
from deltaviz.link.wire.errors import Malformed
from deltaviz.link.wire.frames import ENCODED_MAX, Frame, decode_frame

_TEXT = frozenset(b"\t\r\n") | frozenset(range(0x20, 0x7F))


class Sender(StrEnum):
    HOST = "host"
    BOARD = "board"


@dataclass(frozen=True, slots=True)
class Said:
    """`sequence` is 0 for what is neither a command nor an answer."""

    at: float  # s
    sender: Sender
    sequence: int
    message: HostMessage | BoardMessage


@dataclass(frozen=True, slots=True)
class Garbage:
    """Bytes that are no frame, or a frame that is no message of this sender's."""

    at: float
    sender: Sender
    data: bytes


class Direction:
    """The bytes of one direction. With `sender` None it is a line on which both are heard."""

    def __init__(self, sender: Sender | None) -> None:
        self._sender = sender
        self._partial = b""

    def feed(self, data: bytes, at: float) -> list[Said | Garbage]:
        *ended, self._partial = (self._partial + data).split(b"\0")
        heard = [self._read(encoded, at) for encoded in ended if encoded]
        if len(self._partial) > ENCODED_MAX or _is_text(self._partial):
            heard.append(Garbage(at, self._sender or Sender.BOARD, self._partial))
            self._partial = b""
        return heard

    def _read(self, encoded: bytes, at: float) -> Said | Garbage:
        frame = decode_frame(encoded)
        sender = self._sender or _sender_of(frame)
        if frame is None:
            return Garbage(at, sender, encoded)
        decode = decode_host if sender is Sender.HOST else decode_board
        try:
            return Said(at, sender, frame.sequence, decode(frame.type, frame.payload))
        except Malformed:
            return Garbage(at, sender, encoded)


def _is_text(data: bytes) -> bool:
    """Whole lines as a device prints that speaks no frames. A frame may be cut behind a byte that
    is a line's end, but its type and lengths are no text."""
    return data.endswith(b"\n") and all(byte in _TEXT for byte in data)


def _sender_of(frame: Frame | None) -> Sender:
    return Sender.HOST if frame is not None and frame.type < 0x80 else Sender.BOARD
