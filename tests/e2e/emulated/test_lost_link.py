"""The link to the board breaks in a move, or the board itself starts anew."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from deltaviz.link.messages import BoardState
from tests.emulator import judge
from tests.emulator.hosted_board import (
    HostedBoard,
    assert_obeyed,
    assert_slows_in_time,
    assert_still,
)
from tests.emulator.wire import Flow


@pytest.mark.parametrize("how", ["is pulled out", "breaks inside"])
def test_the_cable(how: str, served: Any, board: HostedBoard, move: Callable[..., None]) -> None:
    move()
    wire = board.wire
    wire.flow(Flow.RUNS)
    if how == "is pulled out":
        wire.pull()
    else:
        wire.deafen()
    wire.until_state(BoardState.HALTED)
    rested, seen = wire.now, wire.seen
    state = served.wait(lambda s: s["mode"] == "offline", "the loss")
    assert state["link"]["problem"]
    assert state["stop_reason"] == state["link"]["problem"]
    wire.plug()
    wire.mend()
    wire.flow(Flow.WAITS)
    assert served.post("/api/connect", {"link": "socket"}) == 200
    state = served.wait(lambda s: s["mode"] == "idle", "the board again")
    assert state["homed"]
    assert "kept its position" in state["link"]["note"]
    wire.let_pass(0.2)
    pulses, motion = board.pulses(), board.motions()[-1]
    assert_obeyed(board, pulses, motion)
    assert_slows_in_time(pulses, motion, seen=seen)
    assert_still(pulses, since=rested)


def test_the_board_restarts(served: Any, board: HostedBoard, move: Callable[..., None]) -> None:
    move()
    motion = board.motions()[-1]
    pulses = board.restart()
    assert pulses.faults == ()
    assert max(judge.position_error(pulses, motion.path, until=motion.until)) < 1.0
    state = served.wait(lambda s: s["mode"] == "offline", "the loss")
    assert state["link"]["problem"]
    assert not board.bench.state().drivers_on
    assert served.post("/api/connect", {"link": "socket"}) == 200
    state = served.wait(lambda s: s["mode"] == "disabled", "the board again")
    assert not state["homed"]
    assert "restarted" in state["link"]["note"]
    board.wire.let_pass(0.3)
    assert_still(board.pulses(), since=0)
    assert not board.bench.state().drivers_on
