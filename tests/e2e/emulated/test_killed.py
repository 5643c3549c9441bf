"""Every process of the host is killed while the robot moves: the board brakes, and knows why."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from deltaviz.link.messages import BoardState, StopCause
from tests.emulator import judge
from tests.emulator.commanded_path import CommandedPath
from tests.emulator.hosted_board import (
    LEASE,
    SURE,
    HostedBoard,
    assert_obeyed,
    assert_slows_in_time,
    assert_still,
)
from tests.emulator.overheard import Greeting
from tests.emulator.pulse_train import PulseTrain
from tests.emulator.wire import Flow


def kill(host: Any, board: HostedBoard) -> tuple[PulseTrain, int]:
    """What left the pins until rest and for a while longer, and the last telemetry that the host
    is known to have had.
    """
    wire = board.wire
    wire.flow(Flow.RUNS)
    host.kill()
    wire.until_state(BoardState.HALTED)
    rested = wire.now
    wire.let_pass(0.3)
    pulses = board.pulses()
    assert_still(pulses, since=rested)
    begin = rested - board.tick_hz
    limits = {"begin": begin, "end": rested, "tick_hz": board.tick_hz}
    assert not judge.beyond_limits(pulses, board.robot, **limits)
    return pulses, wire.seen


def why(host: Any, board: HostedBoard) -> tuple[StopCause, str]:
    """What the board answers to the next hello, and what the next host makes of it."""
    board.wire.flow(Flow.WAITS)
    after = len(board.wire.passed)
    state = host.running().wait(lambda s: s["link"]["connected"], "the next host")
    return board.wire.all(Greeting, after=after)[0].last_stop, state["link"]["note"]


def test_in_a_move(served: Any, host: Any, board: HostedBoard, move: Callable[..., None]) -> None:
    move()
    pulses, seen = kill(host, board)
    motion = board.motions()[-1]
    assert_obeyed(board, pulses, motion)
    assert_slows_in_time(pulses, motion, seen=seen)
    cause, told = why(host, board)
    assert cause is StopCause.UNDERRUN
    assert "ran out of motion" in told


def test_while_homing(served: Any, host: Any, board: HostedBoard) -> None:
    assert served.post("/api/home") == 200
    board.wire.until_state(BoardState.HOMING)
    board.wire.let_pass(0.15)
    pulses, seen = kill(host, board)
    ms = board.wire.ticks_per_ms
    began = judge.brake_began(pulses, evenly(pulses, seen - 30 * ms, seen + 60 * ms), 0)
    assert seen + (LEASE - 10) * ms <= began <= seen + (LEASE + SURE) * ms
    cause, told = why(host, board)
    assert cause is StopCause.LEASE
    assert "did not hear from a computer for 150 ms" in told


def evenly(pulses: PulseTrain, begin: int, end: int) -> CommandedPath:
    """As if the first joint went on for a while as it did between these ticks."""
    steps = pulses.joints[0].between(begin, end)
    passed = np.cumsum(steps.directions) - steps.directions / 2
    speed, _ = np.polyfit(steps.ticks, passed, 1)
    middle = int(steps.ticks[0])
    return CommandedPath(
        (0,), np.array([middle]), np.array([1]), np.array([[0.0], [speed]]), np.full((2, 1), speed)
    ).going_on(40 * (end - begin))
