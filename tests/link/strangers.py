"""What may stand at a port instead of our board: each answers bytes as such a device does."""

from __future__ import annotations

import random
from collections.abc import Callable

from deltaviz.link.board import SimulatedBoard
from deltaviz.link.board.port import BoardPort
from deltaviz.link.messages import HelloReply
from deltaviz.link.wire.codec import encode
from deltaviz.link.wire.frames import FrameReader, write_frame

Stranger = Callable[[bytes], bytes]


def silent(_heard: bytes) -> bytes:
    return b""


def echo(heard: bytes) -> bytes:
    return heard


class Machine:
    """A machine controller: greets when it is opened, and complains about lines."""

    def __init__(self) -> None:
        self._greeting = b"\r\nGrbl 1.1h ['$' for help]\r\n"

    def __call__(self, heard: bytes) -> bytes:
        greeting, self._greeting = self._greeting, b""
        return greeting + b"error:20\r\n" * heard.count(b"\n")


class Gps:
    """Talks all the time."""

    def __call__(self, _heard: bytes) -> bytes:
        return b"$GPGGA,123519,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,*47\r\n"


class OtherBaud:
    """What a talking board looks like at another baud rate; it understands nothing."""

    def __init__(self) -> None:
        self._noise = random.Random(5)

    def __call__(self, _heard: bytes) -> bytes:
        return bytes(self._noise.choice((0x00, 0x80, 0xE0, 0xF8, 0xFE, 0xC6)) for _ in range(9))


class OtherVersion:
    """A board of another version of the protocol: of its hello only the beginning is known."""

    def __init__(self, version: int) -> None:
        self._version = version
        self._reader = FrameReader()

    def __call__(self, heard: bytes) -> bytes:
        frames = self._reader.feed(heard)
        payload = self._version.to_bytes(2, "little") + b"\x05other and more than we know"
        return b"".join(write_frame(0x81, frame.sequence, payload) for frame in frames[:1])


class Deaf:
    """A board in the middle of a session, whose receive line is broken."""

    def __init__(self) -> None:
        self._port = BoardPort(SimulatedBoard())
        type_, payload = encode_hello()
        self._port.feed(write_frame(type_, 9, payload))
        self._port.take()

    def __call__(self, _heard: bytes) -> bytes:
        self._port.board.advance(1000)
        return b"".join(self._port.take())


class Answering:
    """Our board, but with another word in its hello."""

    def __init__(self, reply: HelloReply) -> None:
        self._reply = encode(reply)
        self._reader = FrameReader()

    def __call__(self, heard: bytes) -> bytes:
        return b"".join(
            write_frame(self._reply[0], frame.sequence, self._reply[1])
            for frame in self._reader.feed(heard)
            if frame.type == 1
        )


def encode_hello() -> tuple[int, bytes]:
    from deltaviz.link.messages import PROTOCOL_VERSION, Hello

    return encode(Hello(PROTOCOL_VERSION))
