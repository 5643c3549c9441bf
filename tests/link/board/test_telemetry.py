"""Telemetry: each 5 ms of board time, and at once when something changes."""

from __future__ import annotations

from deltaviz.link.board import SimulatedBoard
from deltaviz.link.messages import (
    BoardState,
    Configured,
    EStop,
    Hello,
    HelloReply,
    Stop,
    Telemetry,
    TelemetryFlags,
)

MS = 200


def test_it_comes_every_5_ms(bench):
    offset = -(bench.ticks_since(bench.seen)) % (5 * MS)
    bench.advance(offset)
    bench.said.clear()
    bench.advance(5 * MS - 1)
    assert bench.all(Telemetry) == []
    bench.advance(1)
    assert [t.now for t in bench.all(Telemetry)] == [bench.now]


def test_its_number_does_not_depend_on_how_time_is_cut(make_bench):
    whole, cut = make_bench(), make_bench()
    for bench in (whole, cut):
        bench.said.clear()
        bench.arm()
        bench.segment([1, 100], [0, 0], ms=20)
    whole.advance(100 * MS)
    while cut.now != whole.now:
        cut.advance(min(37, whole.ticks_since(cut.now)))
    assert whole.said == cut.said


def test_a_change_of_state_is_told_at_once(bench):
    assert any(isinstance(m, Telemetry) and m.state is BoardState.ARMED for m in bench.arm())
    told = bench.send(Stop())
    assert [m.state for m in told if isinstance(m, Telemetry)] == [BoardState.HALTED]
    told = bench.send(EStop())
    assert [m.state for m in told if isinstance(m, Telemetry)] == [BoardState.ESTOP]


def test_before_it_is_configured_it_says_so():
    board = SimulatedBoard(boot=77)
    board.advance(5 * MS)
    (told,) = board.take()
    assert isinstance(told, Telemetry)
    assert told.counts == ()
    assert TelemetryFlags.CONFIGURED not in told.flags
    board.receive(Hello(1))
    reply = next(m for m in board.take() if isinstance(m, HelloReply))
    assert (reply.boot, reply.joints, reply.configuration, reply.homed) == (77, 0, 0, False)


def test_the_same_configuration_is_answered_in_every_state(bench):
    bench.arm()
    first = next(m for m in bench.said if isinstance(m, Configured))
    assert first in bench.send(bench.configure)
    assert bench.board.state is BoardState.ARMED
