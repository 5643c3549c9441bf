"""Frames between the processes, the loop's statistics, and the horizon."""

from __future__ import annotations

import socket
from collections.abc import Iterator

import pytest

from deltaviz.machine.frames import FrameReader, FrameWriter
from deltaviz.machine.horizon import LONGEST, MEMORY, SHORTEST, Horizon
from deltaviz.machine.loop_stats import Periods


@pytest.fixture
def ends() -> Iterator[tuple[socket.socket, socket.socket]]:
    near, far = socket.socketpair()
    with near, far:
        yield near, far


def test_values_arrive_in_order_and_whole(ends: tuple[socket.socket, socket.socket]) -> None:
    writer, reader = FrameWriter(ends[0]), FrameReader(ends[1])
    assert reader.read() == []
    sent = ["a", (1, 2.5), b"x" * 300_000, None, {"k": [1]}]
    for value in sent:
        writer.send(value)
    got: list[object] = []
    while len(got) < len(sent):
        got += reader.read()
        writer.pump()
    assert got == sent
    assert not writer.pending


def test_a_frame_that_comes_byte_by_byte(ends: tuple[socket.socket, socket.socket]) -> None:
    near, far = socket.socketpair()
    with near, far:
        FrameWriter(near).send(("hello", 7))
        raw = far.recv(4096)
    reader = FrameReader(ends[1])
    for k, byte in enumerate(raw):
        assert reader.read() == [], f"after {k} bytes"
        ends[0].send(bytes([byte]))
    assert reader.read() == [("hello", 7)]


def test_a_stalled_reader_blocks_nobody_and_later_gets_the_newest_picture(
    ends: tuple[socket.socket, socket.socket],
) -> None:
    writer, reader = FrameWriter(ends[0]), FrameReader(ends[1])
    for k in range(20_000):
        writer.send_newest((k, "x" * 100))
    writer.send("an answer")
    got: list[object] = []
    while writer.pending or not got or got[-1] != (19_999, "x" * 100):
        got += reader.read()
        writer.pump()
    assert "an answer" in got, "answers are never dropped"
    assert len(got) < 20_000, "pictures are"


def test_the_end_of_the_other_side_is_noticed(ends: tuple[socket.socket, socket.socket]) -> None:
    near, far = socket.socketpair()
    writer, reader = FrameWriter(near), FrameReader(near)
    far.close()
    assert reader.read() == []
    assert reader.closed
    writer.send("lost")
    assert writer.closed
    assert not writer.pending
    near.close()


def test_setup_is_read_alone(ends: tuple[socket.socket, socket.socket]) -> None:
    writer, reader = FrameWriter(ends[0]), FrameReader(ends[1])
    assert reader.read_one() is None
    writer.send("setup")
    writer.send("intent")
    assert reader.read_one() == "setup"
    assert reader.read() == ["intent"]


def test_percentiles() -> None:
    periods = Periods()
    assert periods.stats(underruns=0).p99 == 0.0
    for k in range(1, 101):
        periods.add(k / 1000)
    stats = periods.stats(underruns=3)
    assert stats.count == 100
    assert stats.p50 == pytest.approx(0.050, abs=2e-4)
    assert stats.p99 == pytest.approx(0.099, abs=2e-4)
    assert stats.worst == pytest.approx(0.100)
    assert stats.underruns == 3
    periods.add(1.5)
    assert periods.stats(underruns=0).worst == 1.5


def test_the_horizon_follows_the_worst_recent_stall() -> None:
    horizon = Horizon()
    now = 0.0
    for _ in range(10):
        now += 0.003
        horizon.turn(now, moving=True)
    assert horizon.seconds == SHORTEST
    now += 0.045
    horizon.turn(now, moving=True)
    assert horizon.seconds == pytest.approx(0.090)
    now += 0.300
    horizon.turn(now, moving=True)
    assert horizon.seconds == LONGEST
    end = now + MEMORY
    while now < end - 0.01:
        now += 0.005
        horizon.turn(now, moving=True)
    assert horizon.seconds == LONGEST
    horizon.turn(end, moving=True)
    assert horizon.seconds == SHORTEST


def test_dozing_at_rest_is_no_stall() -> None:
    horizon = Horizon()
    horizon.turn(0.0, moving=True)
    horizon.turn(0.1, moving=False)
    horizon.turn(5.0, moving=True)
    assert horizon.seconds == SHORTEST
