"""Messages between a boundary and its control, which waits for the main loop."""

from __future__ import annotations

import pytest

from deltaviz.link.messages import BoardState, Enable, EStop, Fault, Keep, Stop, StopCause, Stopped
from tests.firmware.c_board import CBoard
from tests.link.board.bench import ACCELERATION, Bench, gantry, top_acceleration

PIECE = 200  # ticks
WAITS = [0, 1, 57, PIECE - 1]


@pytest.fixture
def moving():
    bench = Bench(gantry(), make_board=CBoard, now=2**32 - 9000)
    bench.speed_up(2500)
    bench.go_on(30)
    bench.run(70)
    return bench


def waiting(bench: Bench) -> CBoard:
    """Its board, at a boundary, with control pending."""
    board = bench.board
    assert isinstance(board, CBoard)
    board.run(PIECE)
    return board


def go_on(bench: Bench, wait: int) -> None:
    """Control comes `wait` ticks late; then all is as ever."""
    board = bench.board
    assert isinstance(board, CBoard)
    board.run_without_control(wait)
    board.control(after=wait)
    bench.advance(PIECE - wait)
    bench.trace.append([position / 2**32 for position in board.positions])


def check_rest(bench: Bench) -> None:
    board = bench.board
    assert isinstance(board, CBoard)
    view = board.look()
    assert not view.moving
    assert list(view.emitted[:2]) == list(view.counts[:2])
    assert bench.last(Stopped).counts == board.counts
    assert board.fault is Fault.NONE


@pytest.mark.parametrize("wait", WAITS)
@pytest.mark.parametrize("message", [Stop(), Enable(on=False)], ids=["stop", "disable"])
def test_it_brakes_evenly(moving, message, wait):
    board = waiting(moving)
    moving.trace.append([position / 2**32 for position in board.positions])
    moving.send(message)
    assert board.state is BoardState.BRAKING
    go_on(moving, wait)
    moving.run_to_rest()
    check_rest(moving)
    assert top_acceleration(moving.trace) <= ACCELERATION * 1.02


@pytest.mark.parametrize("wait", WAITS)
def test_an_estop_cuts_it_for_good(moving, wait):
    board = waiting(moving)
    moving.send(EStop())
    counts = board.counts
    go_on(moving, wait)
    moving.run(5)
    assert board.counts == counts
    check_rest(moving)


@pytest.mark.parametrize("wait", WAITS)
def test_a_motion_begins_and_goes_on(wait):
    bench = Bench(gantry(), make_board=CBoard)
    board = waiting(bench)
    bench.arm()
    bench.segment([2.4, 100], [480, 0])
    go_on(bench, wait)
    waiting(bench)
    bench.segment([4.8, 100], [0, 0])
    go_on(bench, wait)
    bench.run(30)
    assert board.state is BoardState.ARMED
    assert board.cause is StopCause.NONE
    assert board.positions == [round(4.8 * 1024) << 22, 100 << 32]
    assert top_acceleration(bench.trace) <= ACCELERATION * 1.02


@pytest.mark.parametrize("wait", WAITS)
def test_a_lease_is_extended_in_time(moving, wait):
    """By the last message before the control that would have ended it."""
    moving.send(Keep(moving.now))
    moving.advance(148 * PIECE)
    board = waiting(moving)
    moving.send(Keep(moving.now))
    go_on(moving, wait)
    assert board.state is BoardState.ARMED
