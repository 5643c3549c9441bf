"""The firmware in the emulator, as a host finds it: from power-up to faults."""

from __future__ import annotations

from math import pi

import pytest

from deltaviz.link.emulator.bench import Circuit
from deltaviz.link.messages import (
    BoardState,
    Done,
    Fault,
    HelloReply,
    Inputs,
    StopCause,
    Stopped,
    TelemetryFlags,
    Tool,
)
from deltaviz.link.wire.frames import write_frame

MS = 40  # ticks


def test_it_starts_disabled_and_unhomed_with_its_arms_anywhere(emulated_board):
    board = emulated_board()
    board.connect()
    board.until(lambda: board.telemetry.counts, "counts")
    hello = next(m for m in board.said if isinstance(m, HelloReply))
    assert (hello.board, hello.tick_hz, hello.joints) == ("emulated F407", 40_000, 0)
    assert hello.last_stop is StopCause.BOOT
    assert len(hello.build) == 12
    told = board.telemetry
    assert (told.state, told.counts) == (BoardState.DISABLED, (0, 0, 0))
    assert TelemetryFlags.HOMED not in told.flags
    seen = board.bench.state()
    assert not seen.drivers_on
    assert len(set(seen.arms[:3])) == 3


def test_every_power_up_has_a_number_of_its_own(emulated_board):
    boots: set[int] = set()
    for _ in range(2):
        board = emulated_board()
        board.connect()
        boots |= {m.boot for m in board.said if isinstance(m, HelloReply)}
    assert len(boots) == 2


def test_homing_finds_the_switches_and_ends_at_the_ready_pose(ready_board):
    board = ready_board
    ready = board.configure.ready
    assert board.telemetry.counts == ready
    away = [abs(a - b) for a, b in zip(board.bench.state().arms[:3], ready, strict=True)]
    assert max(away) <= 1  # microsteps: the switch is looked at once a millisecond
    pulses = board.finish()
    assert pulses.faults == ()


def test_a_switch_that_never_closes_ends_homing_with_a_fault(emulated_board):
    board = emulated_board()
    board.connect()
    board.enable()
    board.bench.hold(1, Circuit.CLOSED)  # as it is while it is not pressed
    board.begin_homing()
    board.until_state(BoardState.FAULT)
    assert board.telemetry.fault is Fault.HOMING_NO_SWITCH
    arms = board.bench.state().arms
    low = min(arm.low for arm in board.arms)
    assert arms[1] == low  # it stood at its mechanical end, and lost steps there


def test_the_e_stop_input_switches_the_drivers_off_at_the_next_millisecond(ready_board, steady):
    board = ready_board
    board.begin(steady(board, seconds=0.5, speed=1.0))
    board.let_pass(0.1)
    assert board.bench.state().drivers_on
    board.bench.estop(pressed=True)
    board.until_state(BoardState.ESTOP)
    told = board.telemetry
    assert told.fault is Fault.ESTOP_INPUT
    assert Inputs.ESTOP in told.inputs
    assert TelemetryFlags.HOMED not in told.flags
    assert not board.bench.state().drivers_on
    at = next(m.now for m in board.said if isinstance(m, Stopped) and m.cause is StopCause.ESTOP)
    pulses = board.finish()
    assert at % MS == 0
    last = max(int(steps.ticks[-1]) for steps in pulses.joints[:3])
    assert at - 10 * MS < last <= at  # moving until then, and never after


def test_a_limit_switch_in_motion_brakes_into_a_fault(ready_board, steady):
    board = ready_board
    board.begin(steady(board, seconds=0.5, speed=1.0))
    board.let_pass(0.1)
    board.bench.hold(2, Circuit.OPEN)
    board.until_state(BoardState.FAULT)
    assert board.telemetry.fault is Fault.LIMIT_SWITCH
    assert Inputs.SWITCH_2 in board.telemetry.inputs


@pytest.mark.parametrize(
    ("on", "angle", "us"),
    [(True, 0.0, 1500), (False, pi / 4, 2000), (True, -pi / 2, 500), (True, 9.0, 2500)],
)
def test_the_tool_and_its_servo(emulated_board, on, angle, us):
    board = emulated_board()
    board.connect()
    assert board.bench.state().servo_us == 0  # it does not move before it is told to
    board.enable()
    board.send(Tool(on=on, servo_angle=angle))
    board.until(lambda: Done("tool") in board.said, "the tool")
    seen = board.bench.state()
    assert seen.tool_on == on
    assert abs(seen.servo_us - us) <= 1


def test_garbage_between_frames_is_passed_over(emulated_board):
    board = emulated_board()
    board.send_bytes(b"AT\r\n" + bytes(range(256)) + write_frame(0x7F, 3, b"no message"))
    board.connect()
    board.send_bytes(b"\xff" * 600)
    board.enable()
