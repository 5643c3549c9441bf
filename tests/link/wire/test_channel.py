"""Messages over a stream: whole, in order, stops first, and never waiting for the other side."""

from __future__ import annotations

import socket

import pytest

from deltaviz.link.messages import Done, EStop, Hello, HelloReply, Keep, Stop, StopCause, Tool
from deltaviz.link.socket_stream import SocketStream
from deltaviz.link.wire.channel import Channel
from deltaviz.link.wire.codec import decode_host, encode
from deltaviz.link.wire.frames import FrameReader, write_frame
from deltaviz.link.wire.stream import MOST_UNSENT

REPLY = HelloReply(1, "b", "1", 0, 200_000, 64, 1, 0, False, 0, StopCause.BOOT)


class Narrow:
    """A stream that takes as many bytes as it is told to."""

    def __init__(self) -> None:
        self.ended: str | None = None
        self.room = 0
        self.taken = bytearray()
        self.arriving = b""

    def write(self, data: bytes) -> int:
        count = min(self.room, len(data))
        self.room -= count
        self.taken += data[:count]
        return count

    def read(self) -> bytes:
        data, self.arriving = self.arriving, b""
        return data

    def fileno(self) -> int:
        return -1

    def close(self) -> None:
        self.ended = "it was closed"

    def messages(self):
        return [(decode_host(f.type, f.payload), f.sequence) for f in self.frames()]

    def frames(self):
        return FrameReader().feed(bytes(self.taken))


class Clock:
    now = 5.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def stream():
    return Narrow()


@pytest.fixture
def clock():
    return Clock()


@pytest.fixture
def channel(stream, clock):
    return Channel(stream, clock)


def test_a_stop_takes_the_place_of_all_that_waits_but_never_breaks_into_a_frame(stream, channel):
    stream.room = 3
    for seen in range(4):
        channel.send(Keep(seen))
    channel.send(Stop())
    channel.send(EStop())
    channel.send(Keep(9))
    stream.room = 1000
    channel.receive()
    said = [message for message, _ in stream.messages()]
    assert said == [Keep(0), Stop(), EStop(), Keep(9)], "the first was begun"


def test_repeated_stops_wait_once(stream, channel):
    for _ in range(50):
        channel.send(Stop())
        channel.send(EStop())
    stream.room = 1000
    channel.receive()
    assert [message for message, _ in stream.messages()] == [Stop(), EStop()]


def test_a_command_that_a_stop_swept_away_is_repeated_if_it_is_still_wanted(stream, channel, clock):
    channel.send(Hello(1))
    channel.send(Stop())
    stream.room = 1000
    channel.receive()
    assert [message for message, _ in stream.messages()] == [Stop()]
    clock.now += 0.051
    channel.receive()
    assert [message for message, _ in stream.messages()] == [Stop(), Hello(1)]


def test_receiving_repeats_what_is_due(stream, channel, clock):
    stream.room = 1000
    channel.send(Hello(1))
    clock.now += 0.049
    channel.receive()
    assert len(stream.frames()) == 1
    clock.now += 0.002
    channel.receive()
    assert len(stream.frames()) == 2
    assert len(set(stream.frames())) == 1


def test_receiving_sends_what_waited_for_an_answer(stream, channel):
    stream.room = 1000
    channel.send(Hello(1))
    channel.send(Tool(on=True, servo_angle=0.0))
    (frame,) = stream.frames()
    stream.arriving = write_frame(encode(REPLY)[0], frame.sequence, encode(REPLY)[1])
    assert channel.receive() == [REPLY]
    assert [message for message, _ in stream.messages()][1] == Tool(on=True, servo_angle=0.0)


def test_two_hosts_begin_with_different_numbers():
    numbers = set()
    for _ in range(200):
        stream = Narrow()
        stream.room = 1000
        Channel(stream).send(Hello(1))
        numbers |= {sequence for _, sequence in stream.messages()}
    assert len(numbers) > 60
    assert numbers <= set(range(1, 256))


def test_a_peer_that_stops_reading_ends_it(stream, channel):
    size = len(write_frame(*encode_keep()))
    for _ in range(MOST_UNSENT // size):
        channel.send(Keep(0x01010101))
    assert channel.ended is None
    channel.send(Keep(0x01010101))
    assert channel.ended == "it has stopped reading"


def encode_keep():
    type_, payload = encode(Keep(0x01010101))
    return type_, 0, payload


@pytest.fixture
def pair():
    left, right = socket.socketpair()
    ends = SocketStream(left), SocketStream(right)
    yield ends
    for end in ends:
        end.close()


def test_a_socket_carries_frames_whole_and_in_order(pair):
    left, right = pair
    channel, got, reader = Channel(left), [], FrameReader()
    for number in range(2000):
        channel.send(Keep(number))
    while len(got) < 2000:
        got += [decode_host(f.type, f.payload) for f in reader.feed(right.read())]
        channel.receive()  # sends on what the socket had no room for
    assert got == [Keep(number) for number in range(2000)]


def test_what_was_sent_before_the_end_still_arrives(pair):
    left, right = pair
    channel = Channel(right)
    channel.send(Tool(on=True, servo_angle=0.0))
    (frame,) = FrameReader().feed(left.read())
    left.write(write_frame(encode(Done("tool"))[0], frame.sequence, encode(Done("tool"))[1]))
    left.close()
    assert channel.receive() == [Done("tool")]
    assert channel.ended == "it has ended"
    channel.send(Stop())
    assert channel.receive() == []


def test_a_socket_that_nobody_reads_takes_what_it_can_and_waits_for_nobody(pair):
    left, _ = pair
    data = b"x" * (1 << 20)
    assert 0 < left.write(data) < len(data)
    assert left.write(data) == 0
    assert left.ended is None
