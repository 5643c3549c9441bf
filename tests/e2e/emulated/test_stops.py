"""Stopped in a move: by command, and by the button that is wired to the board."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from deltaviz.link.messages import BoardState, StopCause
from tests.emulator.hosted_board import (
    HostedBoard,
    assert_all_obeyed,
    assert_obeyed,
    assert_still,
)
from tests.emulator.overheard import Stop, Stopped

SOON = 15  # ms of board time: telemetry is up to 5 ms old, and a millisecond is planned ahead


def test_a_stop_brakes_and_keeps_the_position(
    served: Any, board: HostedBoard, move: Callable[..., None]
) -> None:
    offsets = board.offsets
    move()
    wire, after = board.wire, len(board.wire.passed)
    assert served.post("/api/stop") == 200
    wire.until_state(BoardState.HALTED)
    stopped = wire.all(Stopped, after=after)[0]
    assert stopped.cause is StopCause.HOST_STOP
    wire.let_pass(0.2)
    pulses, motion = board.pulses(), board.motions()[-1]
    assert_all_obeyed(board, pulses, [motion])
    assert board.offsets == offsets
    assert served.wait(lambda s: s["mode"] == "idle", "rest")["homed"]


def test_an_e_stop_by_command(served: Any, board: HostedBoard, move: Callable[..., None]) -> None:
    move()
    wire, after = board.wire, len(board.wire.passed)
    assert served.post("/api/estop") == 200
    wire.until_state(BoardState.ESTOP)
    said = next(each.at for each in wire.passed[after:] if each.said == Stop(at_once=True))
    cut_off(board, said, after)
    state = served.wait(lambda s: s["mode"] == "estop", "what the host makes of it")
    assert state["stop_reason"]
    assert served.post("/api/move", {"theta_deg": [10.0] * 3}) == 409


def test_an_e_stop_by_the_button(
    served: Any, board: HostedBoard, move: Callable[..., None]
) -> None:
    move()
    wire, after, pressed = board.wire, len(board.wire.passed), board.wire.now
    board.bench.estop(pressed=True)
    wire.until_state(BoardState.ESTOP)
    cut_off(board, pressed, after)
    state = served.wait(lambda s: s["mode"] == "estop", "what the host makes of it")
    assert "hardware emergency stop was pressed" in state["stop_reason"]
    assert served.post("/api/reset") == 200
    state = served.wait(lambda s: "still pressed" in (s["stop_reason"] or ""), "the refusal")
    assert state["mode"] == "estop"
    board.bench.estop(pressed=False)
    wire.until(lambda: not wire.telemetry.button, "the released button")
    assert served.post("/api/reset") == 200
    assert not served.wait(lambda s: s["mode"] == "disabled", "the reset")["homed"]


def cut_off(board: HostedBoard, when: int, after: int) -> None:
    """The drivers are off soon after the tick `when`, and no step leaves any more."""
    wire = board.wire
    wire.let_pass(0.1)
    stopped = wire.all(Stopped, after=after)[0]
    assert stopped.cause is StopCause.ESTOP
    assert not board.bench.state().drivers_on
    pulses, motion = board.pulses(), board.motions()[-1]
    assert_obeyed(board, pulses, motion)
    assert_still(pulses, since=stopped.now)
    last = max(int(steps.ticks[-1]) for steps in pulses.joints[:3])
    assert when - 5 * wire.ticks_per_ms < last < when + SOON * wire.ticks_per_ms
