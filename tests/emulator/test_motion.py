"""What leaves the pins is what was commanded, no more and no less."""

from __future__ import annotations

from random import Random

import numpy as np
import pytest

from deltaviz.link.messages import BoardState, StopCause
from tests.emulator import judge
from tests.emulator.commanded_path import CommandedPath
from tests.emulator.emulated_board import EmulatedBoard
from tests.emulator.pulse_train import PulseTrain


def assert_within_limits(pulses: PulseTrain, board: EmulatedBoard, begin: int, end: int) -> None:
    assert not judge.beyond_limits(pulses, board.robot, begin=begin, end=end, tick_hz=board.tick_hz)


def assert_commanded(pulses: PulseTrain, path: CommandedPath, board: EmulatedBoard) -> None:
    assert pulses.faults == ()
    assert max(judge.position_error(pulses, path)) < 1.0
    assert_within_limits(pulses, board, path.begin, path.end)


def ride(board: EmulatedBoard, wander, *, seconds: float, seed: int) -> None:
    path = board.drive(wander(board, seconds=seconds, seed=seed))
    counts, arms = board.telemetry.counts, board.bench.state().arms
    pulses = board.finish()
    assert_commanded(pulses, path, board)
    assert arms[: len(counts)] == counts  # no step was lost on the way to the arms
    for joint, start in enumerate(path.counts):
        steps = pulses.joints[joint].between(path.begin, board.last_tick)
        assert start + steps.directions.sum() == counts[joint]
        assert_a_lost_step_is_noticed(pulses, path, joint)


def assert_a_lost_step_is_noticed(pulses: PulseTrain, path: CommandedPath, joint: int) -> None:
    steps = pulses.joints[joint]
    during = np.nonzero((steps.ticks > path.begin) & (steps.ticks < path.end))[0]
    lost = steps.without(int(Random(joint).choice(during)))
    joints = tuple(lost if i == joint else same for i, same in enumerate(pulses.joints))
    assert judge.position_error(PulseTrain(joints, ()), path)[joint] >= 1.0


def test_the_steps_are_the_commanded_path(ready_board, wander):
    ride(ready_board, wander, seconds=3.0, seed=1)


@pytest.mark.long
@pytest.mark.timeout(7200)
@pytest.mark.parametrize("seed", range(20))
def test_ten_minutes_of_steps(ready_board, wander, seed):
    """`pytest -m long tests/emulator`: twenty rides of half a minute of board time."""
    ride(ready_board, wander, seconds=30.0, seed=100 + seed)


def test_a_stop_brakes_within_limits_and_the_count_is_where_the_arms_are(ready_board, wander):
    board = ready_board
    board.begin(wander(board, seconds=1.0, seed=2))
    board.let_pass(0.3)
    began = board.telemetry.now
    board.stop()
    assert board.session.stopped is not None
    assert board.session.stopped.cause is StopCause.HOST_STOP
    counts, arms, rested = board.telemetry.counts, board.bench.state().arms, board.telemetry.now
    pulses = board.finish()
    assert pulses.faults == ()
    assert_within_limits(pulses, board, began - board.tick_hz // 10, rested)
    assert arms[: len(counts)] == counts


def test_a_silent_host_loses_its_lease_after_150_ms_of_board_time(ready_board, steady):
    board = ready_board
    board.begin(steady(board, seconds=1.0, speed=1.5), horizon=0.5)
    board.let_pass(0.15)
    board.until(lambda: board.telemetry.state is BoardState.HALTED, "rest", silent=True)
    assert board.session.stopped is not None
    assert board.session.stopped.cause is StopCause.LEASE, board.session.refused
    seen, rested, counts = board.seen, board.telemetry.now, board.telemetry.counts
    path, pulses = board.path(), board.finish()
    ms = board.tick_hz // 1000
    for joint in range(len(counts)):
        began = judge.brake_began(pulses, path, joint)
        assert 140 * ms < began - seen <= 151 * ms
    assert rested - seen < 250 * ms
    assert_within_limits(pulses, board, path.begin, rested)
