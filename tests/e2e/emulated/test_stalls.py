"""The host's processes get no time for a while, as under SIGSTOP: for 20 ms of the board's time the
robot moves on as commanded; for 300 ms and more it brakes, and stays where it is.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import pytest

from deltaviz.link.messages import BoardState, StopCause
from deltaviz.link.rules import since
from tests.e2e.conftest import PageSocket
from tests.emulator.hosted_board import (
    HostedBoard,
    assert_obeyed,
    assert_slows_in_time,
    assert_still,
)
from tests.emulator.overheard import Stopped
from tests.emulator.wire import Flow

TRIES = 12  # a page's lease ends by our clock: a loaded machine may break a jog off, and rightly


class Jog:
    """Held by somebody who stays alive whatever becomes of the host."""

    def __init__(self, served: Any, board: HostedBoard) -> None:
        self._served = served
        self._wire = board.wire
        self._hand = PageSocket(served.url)

    def __call__(self) -> None:
        """Into a jog, and some way on."""
        velocity = -60.0 if self._served.state()["xyz_mm"][0] > 0 else 60.0
        self._hand.press([velocity, 0.0, 0.0])
        self._wire.until(lambda: self._wire.telemetry.moving, "the jog")
        self._wire.let_pass(0.2)

    def let_go(self) -> None:
        self._hand.let_go()

    def close(self) -> None:
        self._hand.close()


@pytest.fixture
def jog(served: Any, board: HostedBoard) -> Iterator[Jog]:
    jog = Jog(served, board)
    yield jog
    jog.close()


def stall(host: Any, board: HostedBoard, ms: int) -> tuple[float, int]:
    """Freeze the host for so long. For how long it was, in ms of the board's time, and the newest
    telemetry that the host had answered.
    """
    wire = board.wire
    wire.hold()
    with host.frozen():
        began = wire.now
        wire.give(ms)
        took, seen = since(wire.now, began) / wire.ticks_per_ms, wire.seen
    wire.flow(Flow.WAITS)
    return took, seen


def test_20_ms_in_a_move_pass_unnoticed(
    served: Any, host: Any, board: HostedBoard, move: Callable[..., None]
) -> None:
    move()
    took, _ = stall(host, board, 20)
    assert took == 20
    board.wire.until(lambda: not board.wire.telemetry.moving, "the end of the move")
    motion = board.motions()[-1]
    assert not motion.stopped
    assert_obeyed(board, board.pulses(), motion)
    assert served.wait(lambda s: s["mode"] == "idle", "rest")["stop_reason"] is None


def test_20_ms_in_a_jog_pass_unnoticed(
    served: Any, host: Any, board: HostedBoard, jog: Jog
) -> None:
    took, state = 0.0, served.state()
    for _ in range(TRIES):
        jog()
        took, _ = stall(host, board, 20)
        board.wire.let_pass(0.2)
        state = served.state()
        jog.let_go()
        rest = served.wait(lambda s: s["mode"] == "idle", "rest")
        if not any((s["stop_reason"] or "").startswith("The jog broke off") for s in (state, rest)):
            break
    assert took == 20
    assert (state["mode"], state["stop_reason"]) == ("jogging", None)
    motion = board.motions()[-1]
    assert not motion.stopped
    assert_obeyed(board, board.pulses(), motion)


@pytest.mark.parametrize(("what", "ms"), [("move", 300), ("jog", 300), ("move", 1500)])
def test_longer_and_it_brakes_and_stays_there(
    what: str, ms: int, request: pytest.FixtureRequest, served: Any, host: Any, board: HostedBoard
) -> None:
    wire = board.wire
    request.getfixturevalue(what)()
    after = len(wire.passed)
    _, seen = stall(host, board, ms)
    wire.until_state(BoardState.HALTED)
    state = served.wait(lambda s: s["mode"] == "idle", "what the host makes of it")
    assert state["stop_reason"]
    wire.let_pass(0.5)
    stopped = wire.all(Stopped, after=after)[0]
    assert stopped.cause in (StopCause.UNDERRUN, StopCause.LEASE)  # by how far it was ahead
    pulses, motion = board.pulses(), board.motions()[-1]
    assert_obeyed(board, pulses, motion)
    assert_still(pulses, since=stopped.now)
    assert_slows_in_time(pulses, motion, seen=seen)
    assert served.state()["mode"] == "idle"
