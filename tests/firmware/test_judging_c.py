"""Control goes on while the motion of a segment is judged: what may have changed by then."""

from __future__ import annotations

import pytest

from deltaviz.link.messages import BoardState, Fault, Refusal, Refused, StopCause, Telemetry
from tests.firmware.c_board import CBoard
from tests.link.board.bench import ACCELERATION, MS, Bench, gantry, top_acceleration

SPEED = 2000.0  # microsteps/s
PER_MS = SPEED / 1000


class JudgingBench(Bench):
    """With a board that is slow to judge: `pieces` pass over the next segment."""

    def __init__(self) -> None:
        super().__init__(gantry(), make_board=CBoard, now=2**32 - 9000)

    def let_pass(self, pieces: int) -> None:
        assert isinstance(self.board, CBoard)
        self.board.let_pass(pieces)

    def free(self) -> int:
        self.run(6)
        return self.last(Telemetry).free


@pytest.fixture
def bench() -> JudgingBench:
    return JudgingBench()


@pytest.fixture
def ending(bench: JudgingBench) -> JudgingBench:
    """It moves; its last segment ends at the boundary after the next."""
    bench.speed_up(SPEED)
    bench.go_on(1)
    while bench.board.positions[0] / 2**32 < bench.coast[0] - 2 * PER_MS - 0.01:
        bench.run(1)
    return bench


def test_a_motion_goes_on_evenly_while_the_next_segment_is_judged(bench):
    bench.speed_up(SPEED)
    bench.go_on(2)
    for _ in range(10):
        bench.run(7)
        before = bench.board.positions[0] / 2**32
        bench.let_pass(3)
        bench.go_on(1)
        after = bench.board.positions[0] / 2**32
        if bench.trace[-2][0] > bench.trace[-1][0] - PER_MS * 0.99:
            continue  # it still speeds up
        assert after - before == pytest.approx(3 * PER_MS, abs=0.05)
    assert bench.board.state is BoardState.ARMED
    assert not bench.all(Refused)


@pytest.mark.parametrize("to", [1.0, 100.0], ids=["well", "bad"])
def test_one_that_is_judged_too_slowly_is_an_underrun_and_nothing_else(ending, to):
    """It brakes already: whatever the segment was, it is passed over."""
    ending.let_pass(3)
    heard = ending.segment([ending.coast[0] + to * 10 * PER_MS, 100], [SPEED, 0])
    assert [m.reason for m in heard if isinstance(m, Refused)] == [Refusal.STATE]
    assert ending.board.state is BoardState.BRAKING
    assert ending.board.cause is StopCause.UNDERRUN
    assert ending.free() == 64
    ending.run_to_rest()
    assert ending.board.state is BoardState.HALTED


def test_an_estop_meanwhile_is_final(ending):
    ending.board.press_estop(True)
    ending.let_pass(1)
    counts = ending.board.counts
    heard = ending.segment([ending.coast[0] + 10 * PER_MS, 100], [SPEED, 0])
    assert [m.reason for m in heard if isinstance(m, Refused)] == [Refusal.STATE]
    assert ending.board.state is BoardState.ESTOP
    assert ending.board.fault is Fault.ESTOP_INPUT
    assert abs(ending.board.counts[0] - counts[0]) <= PER_MS + 1
    assert ending.free() == 64


@pytest.mark.parametrize(("pieces", "is_taken"), [(0, True), (3, False)])
def test_a_lease_that_ends_meanwhile_has_ended(bench, pieces, is_taken):
    bench.run(200, keep=False)
    bench.arm()
    bench.let_pass(pieces)
    heard = bench.segment([0.3, 100], [0, 0], seen=bench.board.now - 148 * MS)
    reasons = [m.reason for m in heard if isinstance(m, Refused)]
    assert reasons == ([] if is_taken else [Refusal.LEASE])


@pytest.mark.parametrize("pieces", [0, 1, 5])
def test_a_motion_from_rest_begins_whole_however_long_it_was_judged(bench, pieces):
    bench.run(5)
    bench.arm()
    bench.let_pass(pieces)
    bench.segment([2.4, 100], [480, 0])
    bench.segment([4.8, 100], [0, 0])
    bench.run(40)
    assert bench.board.positions == [round(4.8 * 1024) << 22, 100 << 32]
    assert top_acceleration(bench.trace) <= ACCELERATION * 1.02
    assert bench.board.cause is StopCause.NONE
