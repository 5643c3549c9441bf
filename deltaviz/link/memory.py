"""A simulated board in this process, with a clock from outside: for tests, and for trying out."""

from __future__ import annotations

from collections.abc import Callable

from deltaviz.link.board import SimulatedBoard
from deltaviz.link.board.port import BoardPort
from deltaviz.link.messages import BoardMessage, HostMessage
from deltaviz.link.report import LinkReport
from deltaviz.link.rules import TICK_HZ
from deltaviz.link.tap import Tap, untapped
from deltaviz.link.wire.channel import Channel


class MemoryTransport:
    """Board time follows `clock` (seconds), whenever the transport is used."""

    def __init__(
        self, board: SimulatedBoard, clock: Callable[[], float], tap: Tap = untapped
    ) -> None:
        self.board = board
        self._stream = _MemoryStream(board, clock)
        self._channel = Channel(tap(self._stream), clock)

    @property
    def closed(self) -> bool:
        return self._stream.ended is not None

    @property
    def problem(self) -> str | None:
        return None

    @property
    def report(self) -> LinkReport:
        return self._channel.report

    def send(self, message: HostMessage) -> None:
        self._channel.send(message)

    def receive(self) -> list[BoardMessage]:
        return self._channel.receive()

    def fileno(self) -> int:
        return -1

    def close(self) -> None:
        self._channel.close()


class _MemoryStream:
    """The board at the other end hears each byte at the time at which it is written."""

    def __init__(self, board: SimulatedBoard, clock: Callable[[], float]) -> None:
        self.ended: str | None = None
        self._port = BoardPort(board)
        self._clock = clock
        self._began = clock()
        self._ticks = 0

    def write(self, data: bytes) -> int:
        if self.ended is None:
            self._catch_up()
            self._port.feed(data)
        return len(data)

    def read(self) -> bytes:
        if self.ended is not None:
            return b""
        self._catch_up()
        return b"".join(self._port.take())

    def fileno(self) -> int:
        return -1

    def close(self) -> None:
        self.ended = "it was closed"

    def _catch_up(self) -> None:
        due = round((self._clock() - self._began) * TICK_HZ)
        if due > self._ticks:
            self._port.board.advance(due - self._ticks)
            self._ticks = due
