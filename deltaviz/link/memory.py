"""A simulated board in this process, with a clock from outside: for tests, and for trying out."""

from __future__ import annotations

from collections.abc import Callable

from deltaviz.link.board import SimulatedBoard
from deltaviz.link.messages import BoardMessage, HostMessage
from deltaviz.link.rules import TICK_HZ


class MemoryTransport:
    """Board time follows `clock` (seconds), whenever the transport is used."""

    def __init__(self, board: SimulatedBoard, clock: Callable[[], float]) -> None:
        self.board = board
        self._clock = clock
        self._began = clock()
        self._ticks = 0
        self._closed = False

    @property
    def closed(self) -> bool:
        return self._closed

    @property
    def problem(self) -> str | None:
        return None

    def send(self, message: HostMessage) -> None:
        if not self._closed:
            self._catch_up()
            self.board.receive(message)

    def receive(self) -> list[BoardMessage]:
        if self._closed:
            return []
        self._catch_up()
        return self.board.take()

    def fileno(self) -> int:
        return -1

    def close(self) -> None:
        self._closed = True

    def _catch_up(self) -> None:
        due = round((self._clock() - self._began) * TICK_HZ)
        if due > self._ticks:
            self.board.advance(due - self._ticks)
            self._ticks = due
