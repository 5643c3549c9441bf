"""What is told of a board that is met again: whose power-up it is, and whether it is homed."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import pytest

from deltaviz.link.configuration import configuration_hash, configure_from
from deltaviz.link.messages import StopCause
from deltaviz.machine.acquaintance import Acquaintance
from deltaviz.machine.known_robots import KnownRobots
from deltaviz.robots import load_robot


def session(*, boot: int, homed: bool, last_stop: StopCause = StopCause.HOST_STOP) -> Any:
    board = SimpleNamespace(boot=boot, last_stop=last_stop)
    return cast("Any", SimpleNamespace(board=board, homed=homed))


@pytest.mark.parametrize(
    ("before", "now", "says"),
    [
        ((1, True), (1, True), "kept its position"),
        ((1, True), (1, False), "not homed any more"),
        ((1, True), (2, False), "so home it"),
        ((1, True), (2, True), None),  # homed since, by somebody else: nothing of ours is lost
        ((1, False), (1, False), None),
        ((1, False), (2, False), None),
        ((1, False), (1, True), None),
    ],
)
def test_what_is_told(before: tuple[int, bool], now: tuple[int, bool], says: str | None) -> None:
    acquaintance = Acquaintance()
    acquaintance.note("ttyusb0", session(boot=before[0], homed=before[1]))
    told = acquaintance.greet("ttyusb0", session(boot=now[0], homed=now[1]))
    assert (told is None) if says is None else says in str(told)


@pytest.mark.parametrize(
    ("cause", "says"),
    [
        (StopCause.UNDERRUN, "ran out of motion"),
        (StopCause.LEASE, "did not hear from a computer for 150 ms"),
        (StopCause.LIMIT_SWITCH, "end switch"),
        (StopCause.HOMED, None),
        (StopCause.BOOT, None),
        (StopCause.NONE, None),
    ],
)
def test_a_board_that_braked_while_nobody_was_there_says_why(
    cause: StopCause, says: str | None
) -> None:
    met = session(boot=1, homed=True, last_stop=cause)
    first = Acquaintance().greet("ttyusb0", met)
    assert (first is None) if says is None else says in str(first)
    again = Acquaintance()
    again.note("ttyusb0", session(boot=1, homed=True))
    told = str(again.greet("ttyusb0", met))
    assert "kept its position" in told
    assert says is None or says in told


def test_a_board_on_another_link_is_not_met_again() -> None:
    acquaintance = Acquaintance()
    assert acquaintance.greet("ttyusb0", session(boot=1, homed=True)) is None
    acquaintance.note("ttyusb0", session(boot=1, homed=True))
    assert acquaintance.greet("ttyusb1", session(boot=1, homed=False)) is None


def test_a_configuration_is_told_by_its_robot(tmp_path) -> None:
    robots = KnownRobots({"stm32": "stm32", "trossen": "trossen", "gone": str(tmp_path / "none")})
    for name in ("stm32", "trossen"):
        assert robots.name_of(configuration_hash(configure_from(load_robot(name)))) == name
    assert robots.name_of(12345) is None
