"""A host and a board with a wire between them that loses, doubles and delays what it is told to."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from deltaviz.link.board import SimulatedBoard
from deltaviz.link.board.port import BoardPort
from deltaviz.link.messages import BoardMessage, HostMessage
from deltaviz.link.wire.delivery import Delivery

START = 100.0  # s


class Wire:
    """`to_board` and `to_host` are frames under way. Board time follows the clock."""

    def __init__(self, *, sequence: int = 7, **board: Any) -> None:
        self.now = START
        self.port = BoardPort(SimulatedBoard(**board))
        self.host = Delivery(sequence)
        self.to_board: list[bytes] = []
        self.to_host: list[bytes] = []
        self.heard: list[BoardMessage] = []
        self.carried_out: list[HostMessage] = []
        receive = self.port.board.receive

        def carry_out(message: HostMessage) -> None:
            self.carried_out.append(message)
            receive(message)

        self.port.board.receive = carry_out

    def send(self, message: HostMessage) -> None:
        self.to_board += self.host.send(message, self.now)

    def wait(self, ms: int) -> None:
        """Nothing is delivered meanwhile; repetitions go on the wire."""
        for _ in range(ms):
            self.now += 0.001
            self.port.board.advance(200)
            self.to_board += self.host.due(self.now)
        self.to_host += self.port.take()

    def deliver(self, *, to_host: bool = True) -> None:
        """All that is under way arrives, and what follows from it."""
        while self.to_board or (to_host and self.to_host):
            frames, self.to_board = self.to_board, []
            for frame in frames:
                self.port.feed(frame)
            self.to_host += self.port.take()
            if not to_host:
                return
            frames, self.to_host = self.to_host, []
            for frame in frames:
                said, more = self.host.receive(frame, self.now)
                self.heard += said
                self.to_board += more

    def lose(self) -> None:
        self.to_board.clear()
        self.to_host.clear()

    def answers(self, kind: type) -> list[BoardMessage]:
        return [message for message in self.heard if isinstance(message, kind)]


@pytest.fixture
def make_wire() -> Callable[..., Wire]:
    return Wire
