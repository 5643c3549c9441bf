"""One tick before, and one after, every time-out of the host's end, by a fake clock."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from deltaviz.link import messages as m
from deltaviz.link.session import Phase, Session
from tests.link.sessions import (
    DIGEST,
    HELLO,
    MS,
    listen,
    new_session,
    ready_session,
    telemetry,
)

TICK = 1e-6  # s

# Each rule as the protocol's description states it: not the constants that the code uses.
HELLO_REPEAT, GREETING, SILENCE, ANSWER_MS = 0.5, 10.0, 1.0, 1000
STOP_REPEAT, STALE, NEVER_ARMED_MS, HOME_LATE_MS = 0.010, 0.150, 100, 200
MOST_AT_ONCE = 0.1  # s that a turn of the loop counts as listening


def greeting() -> Session:
    session = new_session(10.0)
    session.take()
    return session


def configuring() -> Session:
    session = greeting()
    session.receive(HELLO, 10.0)
    session.take()
    return session


def configured() -> Session:
    session = configuring()
    session.receive(m.Configured(DIGEST), 10.0)
    return session


def in_epoch() -> Session:
    session = ready_session()
    session.begin()
    session.take()
    return session


def stopping() -> Session:
    session = in_epoch()
    session.stop(10.0)
    session.take()
    return session


def estopping() -> Session:
    session = in_epoch()
    session.estop(10.0)
    session.take()
    return session


def asked(name: str, **options: Any) -> Callable[[], Session]:
    def ask() -> Session:
        session = ready_session()
        getattr(session, name)(10.0, **options)
        session.take()
        return session

    return ask


REPEATS = [
    (greeting, HELLO_REPEAT, m.Hello(m.PROTOCOL_VERSION)),
    (stopping, STOP_REPEAT, m.Stop()),
    (estopping, STOP_REPEAT, m.EStop()),
]


@pytest.mark.parametrize(("lead", "after", "message"), REPEATS)
def test_what_is_repeated_is_so_at_its_time_and_not_before(
    lead: Callable[[], Session], after: float, message: m.HostMessage
) -> None:
    session = lead()
    session.tick(10.0 + after - TICK)
    assert session.take() == []
    session.tick(10.0 + after + TICK)
    assert session.take() == [message]
    session.tick(10.0 + 2 * after)
    assert session.take() == [], "counted from the repetition"
    session.tick(10.0 + 2 * after + 3 * TICK)
    assert session.take() == [message]


FAILS = [
    (greeting, GREETING, "No board answered"),
    (configuring, SILENCE, "'configure'"),
    (configured, SILENCE, "reported nothing"),
    (ready_session, SILENCE, "silent"),
    (in_epoch, SILENCE, "silent"),
    (stopping, SILENCE, "silent"),
]


@pytest.mark.parametrize(("lead", "after", "says"), FAILS)
def test_what_never_comes_fails_the_session_at_its_time_and_not_before(
    lead: Callable[[], Session], after: float, says: str
) -> None:
    session = lead()
    listen(session, since=10.0, until=10.0 + after - TICK)
    assert session.phase is not Phase.FAILED
    session.tick(10.0 + after + TICK)
    assert session.phase is Phase.FAILED
    assert says in str(session.problem)


@pytest.mark.parametrize(("lead", "after", "says"), FAILS)
def test_a_host_that_was_frozen_first_hears_what_was_said_meanwhile(
    lead: Callable[[], Session], after: float, says: str
) -> None:
    session = lead()
    listen(session, since=10.0, until=10.0 + after / 2)
    thawed = 10.0 + 3 * after
    session.tick(thawed)
    assert session.phase is not Phase.FAILED
    listen(session, since=thawed, until=thawed + after / 2 - MOST_AT_ONCE - TICK)
    assert session.phase is not Phase.FAILED
    session.tick(thawed + after / 2 - MOST_AT_ONCE + TICK)
    assert session.phase is Phase.FAILED
    assert says in str(session.problem)


@pytest.mark.parametrize(
    ("lead", "says"),
    [
        (asked("enable", on=True), "'enable'"),
        (asked("enable", on=False), "'enable'"),
        (asked("reset"), "'reset'"),
    ],
)
def test_a_command_has_a_second_of_the_boards_time_to_be_answered(
    lead: Callable[[], Session], says: str
) -> None:
    """Which may pass slowly: an emulated board's does."""
    session = lead()
    for ms, now in ((1, 10.9), (2, 11.8), (ANSWER_MS - 1, 12.7)):
        session.receive(telemetry(now=1000 + ms * MS), now)
        session.tick(now)
        assert session.phase is Phase.READY
    session.receive(telemetry(now=1000 + ANSWER_MS * MS - 1), 13.0)
    assert session.phase is Phase.READY
    session.receive(telemetry(now=1000 + ANSWER_MS * MS), 13.0)
    assert session.phase is Phase.FAILED
    assert says in str(session.problem)


def test_homing_may_take_its_time() -> None:
    session = asked("home")()
    for k in range(1, 6000):
        session.receive(telemetry(state=m.BoardState.HOMING), 10.0 + 0.1 * k)
        session.tick(10.0 + 0.1 * k)
    assert session.homing
    assert session.ready


@pytest.mark.parametrize(("ticks", "late"), [(-1, False), (0, True)])
def test_homing_that_has_not_begun_within_200_ms_of_board_time_is_too_late(
    ticks: int, late: bool
) -> None:
    session = asked("home")()
    session.receive(telemetry(now=1000 + HOME_LATE_MS * MS + ticks), 99.0)
    assert session.never_began is late


def test_homing_that_was_seen_is_not_too_late() -> None:
    session = asked("home")()
    session.receive(telemetry(now=1000 + MS, state=m.BoardState.HOMING), 10.0)
    session.receive(telemetry(now=1000 + 5000 * MS, state=m.BoardState.HOMING), 15.0)
    assert not session.never_began


def test_telemetry_is_news_for_150_ms() -> None:
    session = in_epoch()
    assert session.wants_knot(10.0 + STALE - TICK, horizon=0.06)
    assert not session.wants_knot(10.0 + STALE + TICK, horizon=0.06)


@pytest.mark.parametrize(("ticks", "still"), [(-1, True), (0, False)])
def test_an_arming_that_never_came_is_given_100_ms_of_board_time(ticks: int, still: bool) -> None:
    session = stopping()
    session.receive(telemetry(now=1000 + NEVER_ARMED_MS * MS + ticks), 10.05)
    session.receive(m.Stopped(65534, m.StopCause.HOST_STOP, 900, (100, -60)), 10.05)
    assert session.stopping is still


def test_a_flood_of_stops_does_not_hold_up_an_estop() -> None:
    session = estopping()
    sent: list[m.HostMessage] = []
    for k in range(1, 101):
        session.stop(10.0 + 0.001 * k)
        session.tick(10.0 + 0.001 * k)
        sent += session.take()
    assert sent.count(m.EStop()) in (9, 10)
    session.receive(telemetry(state=m.BoardState.ESTOP), 10.1)
    session.tick(10.2)
    assert session.take() == []


def test_homing_that_ends_without_a_word_is_noticed() -> None:
    """Stopped and the braking telemetry were lost: the board stands, halted and unhomed."""
    session = asked("home")()
    session.receive(telemetry(flags=m.TelemetryFlags.CONFIGURED), 10.0)
    assert session.homing, "it has not begun"
    session.receive(telemetry(state=m.BoardState.HOMING, flags=m.TelemetryFlags.CONFIGURED), 10.01)
    assert session.homing
    session.receive(telemetry(flags=m.TelemetryFlags.CONFIGURED), 11.0)
    assert not session.homing


def test_what_came_before_the_configuration_is_no_restart() -> None:
    """A report from before, held up on its way."""
    session = configured()
    session.receive(telemetry(flags=m.TelemetryFlags.NONE, counts=()), 10.1)
    assert session.phase is Phase.CONFIGURED
    session.receive(telemetry(), 10.1)
    assert session.phase is Phase.READY
    assert session.take() == []
