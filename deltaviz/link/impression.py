"""What the other end of a link seems to be, from the bytes that it sends."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum, auto

from deltaviz.link.wire.frames import FrameReader

_FROM_BOARD = 0x80  # and above: the types of a board's messages
_SAMPLE = 40  # characters
_TEXT_SHARE = 0.9
_LEAST_TEXT = 4  # characters
_KEPT = 256  # bytes


class Kind(Enum):
    NOTHING = auto()  # no byte has come
    BOARD = auto()  # a board's frame, of whatever version
    ECHO = auto()  # our own frames come back
    TEXT = auto()
    NOISE = auto()  # bytes without sense: another baud rate, or another device


@dataclass(frozen=True, slots=True)
class Impression:
    kind: Kind = Kind.NOTHING
    sample: str = ""  # of a text


class Listener:
    """Makes up its mind while bytes come; a board's first frame settles it."""

    def __init__(self) -> None:
        self._reader = FrameReader()
        self._heard = b""
        self._settled: Impression | None = None
        self._echoed = False

    def hear(self, data: bytes) -> None:
        if self._settled is not None or not data:
            return
        self._heard = (self._heard + data)[-_KEPT:]
        for frame in self._reader.feed(data):
            if frame.type >= _FROM_BOARD:
                self._settled = Impression(Kind.BOARD)
                return
            self._echoed = True

    @property
    def impression(self) -> Impression:
        if self._settled is not None:
            return self._settled
        if not self._heard:
            return Impression()
        if self._echoed:
            return Impression(Kind.ECHO)
        sample = text_in(self._heard)
        return Impression(Kind.NOISE) if sample is None else Impression(Kind.TEXT, sample)


def text_in(data: bytes) -> str | None:
    """The longest line of what reads as text; None for what does not."""
    characters = [chr(byte) for byte in data if 0x20 <= byte < 0x7F or byte in b"\r\n\t"]
    if len(characters) < max(_LEAST_TEXT, _TEXT_SHARE * len(data)):
        return None
    lines = "".join(characters).split("\n")
    return max((line.strip() for line in lines), key=len)[:_SAMPLE] or None
