"""What the board asks of the hardware: drivers, inputs, tool, watchdog, and room to send."""

from __future__ import annotations

from dataclasses import replace

import pytest

from deltaviz.link.messages import (
    PROTOCOL_VERSION,
    BoardState,
    Configured,
    Done,
    Enable,
    EStop,
    Fault,
    Hello,
    HelloReply,
    Inputs,
    Options,
    Reset,
    Stop,
    Stopped,
    Telemetry,
    Tool,
)
from deltaviz.link.wire.codec import decode_board
from deltaviz.link.wire.frames import FrameReader
from tests.firmware.c_board import CBoard
from tests.link.board.bench import Bench, Host, gantry

PIECE = 200  # ticks


@pytest.fixture
def board():
    return CBoard()


@pytest.fixture
def bench():
    return Bench(gantry(), make_board=CBoard)


def view(bench: Bench):
    assert isinstance(bench.board, CBoard)
    return bench.board.look()


@pytest.mark.parametrize("active_high", [False, True])
def test_the_drivers_enable_is_left_alone_until_its_level_is_known(board, active_high):
    host = Host(board)
    host.send(Hello(PROTOCOL_VERSION))
    host.send(Enable(on=True))
    host.send(EStop())
    host.send(Reset())
    board.advance(1000)
    assert not board.look().drivers_known
    options = Options.ENABLE_ACTIVE_HIGH if active_high else Options.NONE
    host.send(replace(gantry(), options=options))
    seen = board.look()
    assert seen.drivers_known
    assert not seen.drivers_on
    assert seen.drivers_active_high == active_high
    host.send(Enable(on=True))
    assert board.look().drivers_on


def test_drivers_are_off_when_disabled_or_stopped_for_good(bench):
    assert view(bench).drivers_on
    bench.send(EStop())
    assert not view(bench).drivers_on
    bench.send(Reset())
    assert not view(bench).drivers_on
    bench.send(Enable(on=True))
    assert view(bench).drivers_on
    bench.arm()
    bench.segment([0.3, 100], [30, 0])
    bench.run(5)
    bench.board.plant.force_switch(0, True)
    bench.run_to_rest()
    assert bench.board.state is BoardState.FAULT
    assert view(bench).drivers_on  # it holds where it is
    bench.send(Reset())
    assert not view(bench).drivers_on


def test_disabled_in_motion_the_drivers_hold_until_it_rests(bench):
    bench.speed_up(1500)
    bench.run(25)
    bench.send(Enable(on=False))
    while bench.board.moving:
        assert view(bench).drivers_on
        bench.run(1)
    assert not view(bench).drivers_on


@pytest.mark.parametrize("active_open", [False, True])
def test_a_switch_is_what_its_robot_says(board, active_open):
    """Pressed is open or closed; an open circuit reads as high."""
    host = Host(board)
    host.send(Hello(PROTOCOL_VERSION))
    host.send(replace(gantry(), options=Options.SWITCH_ACTIVE_OPEN if active_open else Options(0)))
    board.plant.force_switch(1, True)
    board.advance(PIECE)
    told = next(m for m in reversed(host.hear()) if isinstance(m, Telemetry))
    assert told.inputs == Inputs.SWITCH_1


def test_an_estop_that_is_pressed_at_power_up_is_noticed(board):
    board.press_estop(True)
    board.advance(PIECE)
    host = Host(board)
    host.send(Hello(PROTOCOL_VERSION))
    board.advance(5 * PIECE)
    told = next(m for m in host.hear() if isinstance(m, Telemetry))
    assert told.state is BoardState.ESTOP
    assert told.fault is Fault.ESTOP_INPUT
    assert told.inputs == Inputs.ESTOP


def test_forward_is_the_low_level_of_an_inverted_joint():
    configure = replace(gantry(), inverted=(False, True))
    bench = Bench(configure, make_board=CBoard)
    assert isinstance(bench.board, CBoard)
    bench.arm()
    bench.board.pins = []
    bench.segment([3, 103], [0, 0], ms=30)
    bench.run(35)
    levels = [(pin >> 4 & 1, pin >> 5 & 1) for pin in bench.board.pins if pin & 0x3]
    assert set(levels) == {(1, 0)}


def test_the_tool_is_told(bench):
    assert Done("tool") in bench.send(Tool(on=True, servo_angle=-0.5))
    seen = view(bench)
    assert seen.tool_on
    assert seen.servo_angle == -0.5
    bench.send(EStop())
    assert not view(bench).tool_on


def test_the_watchdog_is_fed_only_while_control_runs(board):
    board.advance(5 * PIECE)
    fed = board.look().fed
    assert fed == 5
    board.run(PIECE)
    for _ in range(100):
        board.feed(b"\0")
    assert board.look().fed == fed
    board.control()
    assert board.look().fed == fed + 1


def test_a_control_that_comes_late_switches_the_drivers_off(bench):
    bench.speed_up(2000)
    bench.go_on(20)
    bench.run(60)
    board = bench.board
    assert isinstance(board, CBoard)
    board.run(PIECE)
    board.run_without_control(2 * PIECE)
    stood = board.counts
    board.control()
    heard = bench.advance(0)
    assert board.state is BoardState.ESTOP
    assert board.fault is Fault.LATE
    assert not board.homed
    assert not board.look().drivers_on
    assert any(isinstance(m, Stopped) and m.counts == stood for m in heard)
    bench.run(50)
    assert board.counts == stood
    assert list(board.look().emitted[:2]) == list(stood)
    assert Done("reset") in bench.send(Reset())


def test_one_tick_less_is_in_time(bench):
    bench.speed_up(2000)
    bench.go_on(20)
    bench.run(60)
    board = bench.board
    assert isinstance(board, CBoard)
    board.run(PIECE)
    board.run_without_control(PIECE - 1)
    board.control(after=PIECE - 1)
    assert board.state is BoardState.ARMED
    bench.advance(1 + 20 * PIECE)
    assert board.state is BoardState.ARMED
    assert board.fault is Fault.NONE


def frames_of(board):
    return [decode_board(f.type, f.payload) for f in FrameReader().feed(b"".join(board.take()))]


def test_without_room_telemetry_is_dropped_and_answers_wait(bench):
    """Three seconds of silence; the host then hears every answer, and whole frames only."""
    board = bench.board
    assert isinstance(board, CBoard)
    board.set_write_room(0)
    for number in range(300):
        board.advance(10 * PIECE)
        if number % 30 == 0:
            board.feed(bench.frame(Tool(on=False, servo_angle=float(number))))
    board.set_write_room(1 << 14)
    heard = frames_of(board)
    assert sum(message == Done("tool") for message in heard) == 10
    told = [message for message in heard if isinstance(message, Telemetry)]
    assert 10 <= len(told) <= 16
    board.advance(5 * PIECE)
    assert [m.now for m in frames_of(board) if isinstance(m, Telemetry)] == [board.now]


def test_an_answer_that_found_no_room_is_given_again(bench):
    board = bench.board
    assert isinstance(board, CBoard)
    board.set_write_room(0)
    for _ in range(40):
        board.feed(bench.frame(Stop()))  # 40 answers: more than there is room for
    command = bench.frame(Tool(on=True, servo_angle=0.0))
    board.feed(command)
    board.set_write_room(1 << 14)
    assert Done("tool") not in frames_of(board)
    board.feed(command)
    assert frames_of(board) == [Done("tool")]


def test_the_names_that_it_was_built_with_are_told(board):
    host = Host(board)
    reply = next(m for m in host.send(Hello(PROTOCOL_VERSION)) if isinstance(m, HelloReply))
    assert (reply.board, reply.build) == ("host", "native")
    assert isinstance(host.send(gantry())[0], Configured)
