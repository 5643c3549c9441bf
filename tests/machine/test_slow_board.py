"""A board whose time passes more slowly than ours, or pauses, as an emulated one's does: nothing
that its clock should judge is judged by ours.
"""

from __future__ import annotations

from typing import Any

import pytest

from deltaviz.link.messages import BoardState, StopCause, Stopped
from deltaviz.link.rules import TICK_HZ
from deltaviz.machine import intent as i
from deltaviz.machine.mode import Mode
from tests.machine.conftest import ME, STEP, Bench

FAST = (150.0, 0.0, 0.0)  # mm/s


class SlowBench(Bench):
    """`pace` is how much of the board's time passes in ours."""

    pace = 1.0

    def _advance_board(self) -> None:
        if self.board is not None:
            self._ticks += round((1.0 - self.pace) * STEP * TICK_HZ)
        super()._advance_board()


@pytest.fixture
def slow_bench(stm32: Any) -> SlowBench:
    return SlowBench(stm32)


@pytest.mark.parametrize("pace", [0.5, 0.1])
def test_motion_takes_longer_and_is_the_same(slow_bench: SlowBench, pace: float) -> None:
    bench = slow_bench
    bench.pace = pace
    x, y, z = bench.snapshot.xyz or (0.0, 0.0, 0.0)
    assert bench.do(i.MoveToPoint(ME, (x + 20, y, z), 1.0)) == i.Accepted()
    bench.run_until(lambda: bench.mode is Mode.IDLE, within=5.0 / pace)
    bench.run(0.1 / pace)
    assert bench.snapshot.xyz == pytest.approx((x + 20, y, z), abs=0.2)
    assert bench.snapshot.stop_reason is None
    assert bench.snapshot.underruns == 0


@pytest.mark.parametrize("pause", [0.2, 0.9])
def test_a_board_that_paused_goes_on_where_it_was(slow_bench: SlowBench, pause: float) -> None:
    bench = slow_bench
    bench.jog(FAST, 0.3)
    bench.pace = 0.0
    bench.hold(FAST, pause)
    assert bench.mode is Mode.JOGGING
    assert len(bench.segments()) < 60, "no more than the queue takes while nothing is heard"
    bench.pace = 1.0
    bench.hold(FAST, 0.2)
    assert bench.mode is Mode.JOGGING
    assert bench.board.state is BoardState.ARMED
    assert not [m for m in bench.heard if isinstance(m, Stopped)]


def test_a_board_that_is_not_heard_has_braked_by_itself_and_says_so(bench: Bench) -> None:
    """The same silence, but the board's time went on."""
    bench.jog(FAST, 0.3)
    bench.cut = True
    bench.hold(FAST, 0.3)
    assert bench.board.cause in (StopCause.UNDERRUN, StopCause.LEASE)
    bench.cut = False
    bench.hold(FAST, 0.1)
    assert bench.mode is Mode.IDLE
    assert bench.snapshot.stop_reason is not None


def test_switching_off_and_on_may_take_a_slow_board_its_time(slow_bench: SlowBench) -> None:
    bench = slow_bench
    bench.pace = 0.01
    assert bench.do(i.Disable(ME)) == i.Accepted()
    bench.run_until(lambda: bench.mode is Mode.DISABLED, within=20.0)
    assert bench.do(i.Enable(ME)) == i.Accepted()
    bench.run_until(lambda: bench.mode is Mode.UNHOMED, within=20.0)
