"""A board in this process, with a clock from outside."""

from __future__ import annotations

import pytest

from deltaviz.link.board import SimulatedBoard
from deltaviz.link.memory import MemoryTransport
from deltaviz.link.messages import Enable, Hello, HelloReply, Refused, Telemetry


class Clock:
    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock():
    return Clock()


@pytest.fixture
def link(clock):
    return MemoryTransport(SimulatedBoard(), clock)


def test_the_board_follows_the_clock_it_is_given(link, clock):
    link.send(Hello(1))
    assert any(isinstance(m, HelloReply) for m in link.receive())
    clock.now += 0.012
    assert [m.now for m in link.receive() if isinstance(m, Telemetry)] == [1000, 2000]
    assert link.board.now == 2400


def test_a_board_that_was_not_greeted_is_silent(link, clock):
    link.send(Enable(on=True))
    clock.now += 0.5
    assert link.receive() == []


def test_the_next_command_goes_out_with_the_answer_to_the_one_before(link):
    link.send(Hello(1))
    link.send(Enable(on=True))
    assert not any(isinstance(m, Refused) for m in link.receive())
    assert any(isinstance(m, Refused) for m in link.receive())


def test_once_closed_it_takes_and_gives_nothing(link, clock):
    link.send(Hello(1))
    link.receive()
    link.close()
    assert link.closed
    assert link.problem is None
    link.send(Hello(1))
    clock.now += 1.0
    assert link.receive() == []
    assert link.board.now == 0
