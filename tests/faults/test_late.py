"""What was asked for while the board heard nothing does not begin when it hears again."""

from __future__ import annotations

from random import Random

import pytest

from deltaviz.link.messages import BoardState
from deltaviz.machine import intent as i
from deltaviz.machine.sentences import NEVER_BEGAN
from deltaviz.machine.transitions import AT_REST
from tests.faults.phases import ACCEPTED, ME, idle, quick_robot
from tests.faults.wire_bench import WireBench

ASKED = {
    "home": i.Home(ME),
    "step": i.StepPoint(ME, (5.0, 0.0, 0.0)),
    "move": i.MoveToPoint(ME, (40.0, 0.0, -300.0), 1.0),
}


@pytest.fixture
def bench() -> WireBench:
    bench = WireBench(quick_robot(), seed=3)
    idle(bench)
    return bench


@pytest.mark.parametrize("deaf", [0.25, 3.0])  # s
@pytest.mark.parametrize("asked", ASKED)
def test_a_press_is_forgotten_with_the_wire_that_lost_it(
    bench: WireBench, asked: str, deaf: float
) -> None:
    start = bench.board.counts
    bench.deaf = True
    assert bench.do(ASKED[asked]) == ACCEPTED
    bench.run(deaf)
    bench.deaf = False
    bench.run(3.0)
    assert bench.board.counts == start
    assert bench.board.state in (BoardState.HALTED, BoardState.ARMED)
    assert bench.mode in AT_REST
    assert bench.snapshot.stop_reason == NEVER_BEGAN
    assert bench.do(ASKED[asked]) == ACCEPTED  # a fresh press is
    bench.run(0.5)
    assert bench.board.counts != start


@pytest.mark.parametrize("seed", range(5))
def test_a_home_that_is_lost_once_or_twice_is_repeated(bench: WireBench, seed: int) -> None:
    random = Random(seed)
    bench.deaf = True
    assert bench.do(ASKED["home"]) == ACCEPTED
    bench.run(random.uniform(0.01, 0.1))
    bench.deaf = False
    bench.run(0.3)
    assert bench.board.state is BoardState.HOMING
