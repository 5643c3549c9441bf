"""Commands arrive once, in order, whatever the wire loses, doubles or delays."""

from __future__ import annotations

from dataclasses import replace

import pytest

from deltaviz import load_robot
from deltaviz.link.board.port import BoardPort
from deltaviz.link.configuration import configuration_hash, configure_from
from deltaviz.link.messages import (
    Arm,
    BoardState,
    Configured,
    Done,
    Enable,
    EStop,
    Fault,
    Hello,
    HelloReply,
    Home,
    Inputs,
    Keep,
    Refused,
    Reset,
    Segment,
    Stop,
    StopCause,
    Stopped,
    Telemetry,
    TelemetryFlags,
    Tool,
)
from deltaviz.link.timing import COMMAND_REPEAT
from deltaviz.link.wire.codec import encode
from deltaviz.link.wire.delivery import Delivery
from deltaviz.link.wire.frames import FrameReader, write_frame

CONFIGURE = configure_from(load_robot("stm32"))
TELEMETRY = Telemetry(
    now=1000, state=BoardState.HALTED, fault=Fault.NONE, epoch=0, last_index=0xFFFF,
    t_queue_end=1000, free=64, inputs=Inputs.NONE, flags=TelemetryFlags.CONFIGURED, counts=(0, 0),
)  # fmt: skip
STOPPED = Stopped(epoch=0, cause=StopCause.HOST_STOP, now=0, counts=())


def frame(message, sequence):
    type_, payload = encode(message)
    return write_frame(type_, sequence, payload)


def read(frames):
    """(type, sequence) of each frame."""
    return [(f.type, f.sequence) for f in FrameReader().feed(b"".join(frames))]


@pytest.fixture
def wire(make_wire):
    """Greeted, configured, enabled and homed; nothing under way."""
    wire = make_wire(start_homed=True)
    wire.send(Hello(1))
    wire.send(CONFIGURE)
    wire.deliver()
    assert wire.answers(Configured)
    wire.heard.clear()
    wire.carried_out.clear()
    return wire


# The wire as it should be.


def test_commands_wait_for_the_answer_to_the_one_before(make_wire):
    wire = make_wire(start_homed=True)
    for message in (Hello(1), CONFIGURE, Tool(on=True, servo_angle=0.5)):
        wire.send(message)
    assert read(wire.to_board) == [(0x01, 8)]
    wire.deliver()
    assert [type(m) for m in wire.carried_out] == [Hello, type(CONFIGURE), Tool]
    answers = [m for m in wire.heard if not isinstance(m, Telemetry)]
    assert isinstance(answers[0], HelloReply)
    assert answers[1:] == [Configured(configuration_hash(CONFIGURE)), Done("tool")]


def test_numbers_go_past_zero(make_wire):
    wire = make_wire(sequence=253, start_homed=True)
    wire.send(Hello(1))
    wire.send(CONFIGURE)
    for _ in range(300):
        wire.send(Tool(on=True, servo_angle=0.0))
        wire.deliver()
    assert len(wire.answers(Done)) == 300
    assert len(wire.carried_out) == 302


def test_what_is_no_command_goes_at_once_and_bears_no_number(wire):
    wire.send(Tool(on=True, servo_angle=0.0))
    wire.lose()
    wire.send(Keep(5))
    wire.send(Segment(1, 0, 0, 0, 0, (), ()))
    wire.send(Stop())
    wire.send(EStop())
    assert read(wire.to_board) == [(0x07, 0), (0x06, 0), (0x08, 0), (0x09, 0)]


def test_a_refused_segment_is_no_answer_to_a_command(wire):
    wire.send(Tool(on=True, servo_angle=0.0))
    wire.lose()
    wire.send(Segment(1, 0, 0, 0, 0, (), ()))
    wire.deliver()
    assert [m.command for m in wire.answers(Refused)] == ["segment"]
    wire.wait(50)
    wire.deliver()
    assert wire.answers(Done) == [Done("tool")]


# Lost.


def test_a_lost_command_is_repeated_byte_for_byte_every_50_ms(wire):
    wire.send(Tool(on=True, servo_angle=0.0))
    (first,) = wire.to_board
    wire.lose()
    sent = wire.now
    for repetition in (1, 2, 3):
        due = sent + repetition * COMMAND_REPEAT
        assert wire.host.due(due - 0.001) == []
        assert wire.host.repeat_at == pytest.approx(due)
        assert wire.host.due(due) == [first]
    assert COMMAND_REPEAT == 0.050


def test_a_command_whose_answer_was_lost_is_not_carried_out_again(wire):
    wire.send(Tool(on=True, servo_angle=0.0))
    wire.deliver(to_host=False)
    wire.lose()
    wire.wait(49)
    assert wire.to_board == []
    wire.wait(1)
    wire.deliver()
    assert wire.answers(Done) == [Done("tool")]
    assert wire.carried_out == [Tool(on=True, servo_angle=0.0)]
    wire.wait(200)
    assert wire.to_board == []  # it is answered


def test_what_waits_goes_out_with_the_late_answer(wire):
    wire.send(Tool(on=True, servo_angle=0.0))
    wire.send(Tool(on=False, servo_angle=0.0))
    wire.lose()
    wire.wait(50)
    wire.deliver()
    assert [m.on for m in wire.carried_out] == [True, False]
    assert len(wire.answers(Done)) == 2


def test_a_lost_hello_is_repeated_too(make_wire):
    wire = make_wire()
    wire.send(Hello(1))
    wire.lose()
    wire.wait(50)
    wire.deliver()
    assert wire.answers(HelloReply)


# Doubled and delayed.


def test_a_doubled_command_is_carried_out_once_and_answered_twice(wire):
    wire.send(Tool(on=True, servo_angle=0.0))
    wire.to_board *= 2
    wire.deliver(to_host=False)
    assert wire.carried_out == [Tool(on=True, servo_angle=0.0)]
    assert read(wire.to_host) == [(0x84, 10), (0x84, 10)]
    wire.deliver()
    assert wire.answers(Done) == [Done("tool")]  # told once


def test_a_doubled_hello_begins_one_session(wire):
    wire.send(Hello(1))
    wire.to_board *= 3
    wire.deliver()
    assert len(wire.carried_out) == 1
    assert len(wire.answers(HelloReply)) == 1


def test_a_doubled_command_that_is_not_yet_answered_is_not_carried_out_again(make_wire):
    wire = make_wire()
    for message in (Hello(1), CONFIGURE, Enable(on=True)):
        wire.send(message)
        wire.deliver()
    wire.carried_out.clear()
    wire.send(Keep(wire.port.board.now))
    wire.send(Home())
    wire.deliver()
    for _ in range(3):
        wire.wait(50)
        wire.send(Keep(wire.port.board.now))
        assert (0x04, 11) in read(wire.to_board)
        wire.deliver()
    assert wire.port.board.state is BoardState.HOMING
    assert sum(isinstance(m, Home) for m in wire.carried_out) == 1


def test_a_command_that_comes_after_a_newer_one_is_dropped(wire):
    wire.send(Tool(on=True, servo_angle=0.0))
    (late,) = wire.to_board
    wire.deliver()
    wire.send(Tool(on=False, servo_angle=0.0))
    wire.deliver()
    wire.to_board.append(late)
    wire.deliver()
    assert wire.port.board.tool == Tool(on=False, servo_angle=0.0)
    assert len(wire.carried_out) == 2


@pytest.mark.parametrize(
    ("ahead", "taken"), [(0, False), (1, True), (127, True), (128, False), (255, False)]
)
@pytest.mark.parametrize("last", [3, 200])
def test_newer_is_up_to_127_ahead(make_wire, last, ahead, taken):
    wire = make_wire()
    wire.port.feed(frame(Hello(1), last))
    wire.port.feed(frame(Enable(on=True), (last + ahead) % 256))
    assert (Enable(on=True) in wire.carried_out) == taken


def test_a_command_without_a_number_is_dropped(make_wire):
    wire = make_wire()
    wire.port.feed(frame(Hello(1), 0))
    assert wire.carried_out == []
    wire.port.feed(frame(Hello(1), 200))
    wire.port.feed(frame(Enable(on=True), 0))
    assert wire.carried_out == [Hello(1)]


def test_a_hello_with_an_older_number_begins_a_session(wire):
    wire.port.feed(frame(Hello(1), 3))
    assert wire.carried_out == [Hello(1)]
    assert read(wire.port.take())[0] == (0x81, 3)
    wire.port.feed(frame(Tool(on=True, servo_angle=0.0), 4))
    assert len(wire.carried_out) == 2


def test_a_late_answer_is_told_to_nobody():
    host = Delivery(7)
    host.send(Hello(1), 0.0)
    reply = HelloReply(1, "b", "1", 0, 200_000, 64, 1, 0, False, 0, StopCause.BOOT)
    for sequence in (0, 7, 9):
        assert host.receive(frame(reply, sequence), 0.0) == ([], [])
    assert host.receive(frame(Done("tool"), 8), 0.0) == ([], [])  # of an earlier session
    assert host.receive(frame(reply, 8), 0.0) == ([reply], [])
    assert host.receive(frame(reply, 8), 0.0) == ([], [])


# What overrules.


@pytest.mark.parametrize("stop", [Stop(), EStop()], ids=["stop", "e-stop"])
def test_a_stop_overrules_what_waits(wire, stop):
    for command in (Arm(1, 0, ()), Home(), Enable(on=True), Tool(on=True, servo_angle=0.0)):
        wire.send(command)
    wire.send(Reset())
    wire.lose()
    wire.send(stop)
    wire.wait(200)
    wire.deliver()
    assert wire.carried_out == [stop]


def test_a_stop_overrules_neither_the_session_nor_switching_off(make_wire):
    wire = make_wire(start_homed=True)
    for message in (Hello(1), CONFIGURE, Enable(on=False)):
        wire.send(message)
    wire.lose()
    wire.send(Stop())
    wire.wait(50)
    wire.deliver()
    assert wire.port.board.state is BoardState.DISABLED
    assert Done("enable") in wire.heard


def test_switching_off_does_not_wait_for_the_end_of_homing(make_wire):
    wire = make_wire()
    for message in (Hello(1), CONFIGURE, Enable(on=True)):
        wire.send(message)
    wire.deliver()
    wire.send(Keep(wire.port.board.now))
    wire.send(Home())
    wire.wait(30)
    wire.deliver()
    assert wire.port.board.moving
    wire.send(Enable(on=False))
    wire.deliver()
    wire.wait(100)
    wire.deliver()
    assert wire.port.board.state is BoardState.DISABLED


def test_a_new_hello_overrules_everything(wire):
    wire.send(Tool(on=True, servo_angle=0.0))
    wire.send(Home())
    wire.lose()
    wire.send(Hello(1))
    wire.wait(100)
    wire.deliver()
    assert wire.carried_out == [Hello(1)]


@pytest.mark.parametrize(
    ("then", "given_up"),
    [
        ({"state": BoardState.HOMING}, False),
        ({"state": BoardState.BRAKING}, False),
        ({"state": BoardState.HALTED}, True),
        ({"state": BoardState.DISABLED}, True),
        ({"state": BoardState.FAULT, "fault": Fault.HOMING_NO_SWITCH}, True),
        # It has ended well: the answer is under way, or was lost.
        ({"state": BoardState.HALTED, "flags": TelemetryFlags.HOMED}, False),
    ],
    ids=str,
)
def test_a_homing_that_ended_early_is_given_up(then, given_up):
    host = Delivery(7)
    host.send(Home(), 0.0)
    for changes in ({}, {"state": BoardState.HOMING}, then):
        host.receive(frame(replace(TELEMETRY, **changes), 0), 0.0)
    assert (host.due(1.0) == []) == given_up


def test_homing_is_repeated_until_the_board_homes():
    host = Delivery(7)
    host.send(Home(), 0.0)
    host.receive(frame(TELEMETRY, 0), 0.0)
    assert host.due(0.05)


# A link that something else opens.


def test_before_the_first_hello_a_board_takes_stops_only_and_is_silent(make_wire):
    wire = make_wire()
    for sequence, message in enumerate((CONFIGURE, Enable(on=True), Keep(1), Reset()), 1):
        wire.port.feed(frame(message, sequence))
    wire.port.board.advance(10_000)
    assert wire.port.take() == []
    wire.port.feed(frame(Stop(), 0))
    wire.port.feed(frame(EStop(), 0))
    assert wire.carried_out == [Stop(), EStop()]
    assert {type_ for type_, _ in read(wire.port.take())} == {0x86}
    wire.port.feed(frame(Hello(1), 1))
    wire.port.board.advance(1000)
    assert {type_ for type_, _ in read(wire.port.take())} == {0x81, 0x85}


def test_what_is_no_message_is_counted_and_harms_nothing(wire):
    port: BoardPort = wire.port
    rubbish = [
        b"hello, is there anybody?\r\n\0",
        frame(STOPPED, 0),  # an echo
        write_frame(0x7F, 0, b""),  # no such type
        write_frame(0x08, 0, b"\0"),  # longer than a Stop is
        frame(Stop(), 0)[1:],
    ]
    for count, data in enumerate(rubbish, 1):
        port.feed(data)
        assert port.dropped == count
        wire.host.receive(frame(Stop(), 0), 0.0)
        assert wire.host.dropped == count
    wire.send(Tool(on=True, servo_angle=0.0))
    wire.deliver()
    assert wire.answers(Done) == [Done("tool")]
