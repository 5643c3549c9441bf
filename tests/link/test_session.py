"""The host's session alone: what it sends, when, and what it makes of what the board says."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from deltaviz.link import messages as m
from deltaviz.link.session import Phase, Session
from deltaviz.link.timing import KEEP_PERIOD, STALE, STOP_REPEAT
from deltaviz.motion.knot import Knot
from tests.link.sessions import (
    CONFIGURATION,
    DIGEST,
    HELLO,
    MS,
    TICK_HZ,
    listen,
    new_session,
    ready_session,
    telemetry,
)


@pytest.fixture
def session() -> Session:
    return ready_session()


def knot(theta: tuple[float, ...], velocity: tuple[float, ...] = (0.0, 0.0)) -> Knot:
    return Knot(0.010, theta, velocity)


def test_it_greets_configures_and_arms_nothing_by_itself() -> None:
    new = new_session()
    assert new.take() == [m.Hello(m.PROTOCOL_VERSION)]
    new.tick(0.4)
    assert new.take() == []
    new.tick(0.5)
    assert new.take() == [m.Hello(m.PROTOCOL_VERSION)], "the first may have been missed"
    new.receive(HELLO, 0.6)
    assert new.take() == [CONFIGURATION]
    assert not new.ready
    new.receive(m.Configured(DIGEST), 0.7)
    assert not new.ready, "not before it has reported"
    new.receive(telemetry(), 0.7)
    assert new.ready
    for k in range(100):
        new.tick(0.7 + 0.005 * k)
    assert new.take() == []


@pytest.mark.parametrize(
    ("answers", "problem"),
    [
        ([replace(HELLO, version=9)], "version 9"),
        ([replace(HELLO, joints=3)], "3 joints"),
        ([HELLO, m.Configured(DIGEST + 1)], "configuration"),
        ([HELLO, telemetry(), m.Refused("configure", m.Refusal.STATE)], "another robot"),
        ([HELLO, m.Refused("configure", m.Refusal.STATE), telemetry()], "another robot"),
        (
            [replace(HELLO, tick_hz=10_000), m.Refused("configure", m.Refusal.CONFIGURATION)],
            "clock",
        ),
        (
            [HELLO, m.Configured(DIGEST), telemetry(), telemetry(flags=m.TelemetryFlags.NONE)],
            "restarted",
        ),
    ],
)
def test_a_board_that_does_not_fit_is_told_apart(answers: list[Any], problem: str) -> None:
    new = new_session()
    for answer in answers:
        new.receive(answer, 0.1)
    assert new.phase is Phase.FAILED
    assert problem in str(new.problem)


@pytest.mark.parametrize(
    ("reply", "problem"),
    [
        (replace(HELLO, version=9, tick_hz=0), "version 9"),  # no more is read of another version
        (replace(HELLO, tick_hz=0), "clock"),
    ],
)
def test_a_board_whose_time_cannot_be_told_is_named_and_breaks_nothing(
    reply: m.HelloReply, problem: str
) -> None:
    new = new_session()
    for answer in (telemetry(), reply, telemetry(now=2000)):
        new.receive(answer, 0.1)
        assert new.board_time is None
    assert new.phase is Phase.FAILED
    assert problem in str(new.problem)


@pytest.mark.parametrize("state", [m.BoardState.ESTOP, m.BoardState.FAULT])
@pytest.mark.parametrize("reports_first", [True, False])
def test_a_board_that_is_locked_is_configured_once_it_was_reset(
    state: m.BoardState, reports_first: bool
) -> None:
    """It is told in which state it is, and nothing is reset without a person."""
    new = new_session()
    locked = telemetry(state=state)
    refused = m.Refused("configure", m.Refusal.STATE)
    for answer in [HELLO, *([locked, refused] if reports_first else [refused, locked])]:
        new.receive(answer, 0.1)
    new.take()
    for k in range(1, 100):
        new.receive(locked, 0.1 * k)
        new.tick(0.1 * k)
    assert new.take() == []
    assert new.awaits_reset
    assert new.settled
    assert not new.homed, "its counts may be another robot's"
    new.reset(10.0)
    new.receive(m.Done("reset"), 10.01)
    assert new.take() == [m.Reset()]
    new.receive(telemetry(state=m.BoardState.DISABLED), 10.02)
    assert new.take() == [CONFIGURATION]
    new.receive(m.Configured(DIGEST), 10.03)
    new.receive(telemetry(state=m.BoardState.DISABLED), 10.04)
    assert new.ready
    assert not new.awaits_reset


def test_an_unanswered_command_ends_the_session(session: Session) -> None:
    session.enable(10.0, on=True)
    listen(session, since=10.0, until=10.99)
    assert session.phase is Phase.READY
    session.tick(11.01)
    assert session.phase is Phase.FAILED


def test_epochs_are_new_and_wrap(session: Session) -> None:
    epochs: list[int] = []
    for _ in range(3):
        session.begin()
        arm = session.take()[0]
        assert isinstance(arm, m.Arm)
        epochs.append(arm.epoch)
        assert arm.counts == (100, -60)
        assert arm.t_start == 1000
        session.receive(m.Refused("arm", m.Refusal.COUNTS), 10.0)
    assert epochs == [65535, 0, 1]


def test_only_a_halted_board_is_armed(session: Session) -> None:
    session.receive(telemetry(state=m.BoardState.ARMED), 10.0)
    with pytest.raises(RuntimeError, match="halted"):
        session.begin()


def test_segments_come_from_absolute_positions(session: Session) -> None:
    session.begin()
    for k in range(1, 1001):
        session.segment(knot((0.2 + 1e-4 * k, -0.2), (0.01, 0.0)), 10.0)
    segments = [x for x in session.take() if isinstance(x, m.Segment)]
    for k, segment in enumerate(segments, start=1):
        assert abs(segment.p[0] - (0.2 + 1e-4 * k) * 500 * 1024) <= 0.5
        assert segment.v[0] == round(0.01 * 500 / 1000 * 65536)
        assert segment.t_end == 1000 + 2000 * k
        assert segment.duration == 2000
        assert segment.index == k - 1
        assert segment.seen == 1000


def test_after_a_pause_motion_starts_at_the_boards_present_tick(session: Session) -> None:
    session.begin()
    session.segment(knot((0.2, -0.2)), 10.0)
    first = session.take()[-1]
    session.receive(telemetry(now=90_000, epoch=65535, last_index=0, t_queue_end=90_000), 10.4)
    session.segment(knot((0.2, -0.2), (0.1, 0.0)), 10.4)
    session.receive(telemetry(now=91_000, epoch=65535, last_index=1, t_queue_end=92_000), 10.4)
    session.segment(knot((0.2, -0.2)), 10.4)
    second, third = session.take()
    assert isinstance(first, m.Segment)
    assert isinstance(second, m.Segment)
    assert isinstance(third, m.Segment)
    assert first.t_end == 3000
    assert second.t_end - second.duration == 90_000
    assert third.t_end - third.duration == second.t_end, "no gap while it moves"


def test_the_horizon_counts_what_was_sent_and_what_time_has_passed(session: Session) -> None:
    session.begin()
    assert session.wants_knot(10.0, horizon=0.060)
    for k in range(6):
        assert session.ahead(10.0) == pytest.approx(0.010 * k)
        assert session.wants_knot(10.0, horizon=0.060)
        session.segment(knot((0.2, -0.2), (0.1, 0.0)), 10.0)
    assert not session.wants_knot(10.0, horizon=0.060)
    assert not session.wants_knot(10.001, horizon=0.060), "the board has told of none of them"
    # The board has taken four of the six; it began 3 ms late.
    session.receive(
        telemetry(now=1000 + 13 * MS, epoch=65535, last_index=3, t_queue_end=1000 + 43 * MS),
        10.013,
    )
    assert session.ahead(10.013) == pytest.approx(0.050)
    assert session.wants_knot(10.013, horizon=0.060)
    session.segment(knot((0.2, -0.2), (0.1, 0.0)), 10.013)
    assert not session.wants_knot(10.013, horizon=0.060)
    assert session.wants_knot(10.014, horizon=0.060), "a millisecond of it is over"
    assert session.ahead(10.053) == pytest.approx(0.020)


def test_places_are_counted_including_what_is_on_its_way(session: Session) -> None:
    session.receive(telemetry(free=2), 10.0)
    session.begin()
    session.segment(knot((0.2, -0.2), (0.1, 0.0)), 10.0)
    assert session.wants_knot(10.0, horizon=0.5)
    session.segment(knot((0.2, -0.2), (0.1, 0.0)), 10.0)
    assert not session.wants_knot(10.0, horizon=0.5)


def test_without_fresh_telemetry_nothing_is_sent(session: Session) -> None:
    session.begin()
    assert session.wants_knot(10.0 + STALE - 1e-6, horizon=0.06)
    assert not session.wants_knot(10.0 + STALE, horizon=0.06)


def test_indices_wrap(session: Session) -> None:
    session.begin()
    flight = session.flight
    assert flight is not None
    flight._index = 65530  # pyright: ignore[reportPrivateUsage]
    for k in range(65530, 65536 + 10):
        session.segment(knot((0.2, -0.2), (0.1, 0.0)), 10.0)
        session.receive(
            telemetry(epoch=65535, last_index=k & 0xFFFF, now=1000, t_queue_end=1000), 10.0
        )
        session.take()
    assert flight.free(telemetry()) == 64
    assert session.ahead(10.0) == 0.0


def test_board_time_survives_the_wrap_of_its_counter(session: Session) -> None:
    for k in range(1, 8):
        now = (1000 + k * 1_000_000_000) & 0xFFFF_FFFF
        session.receive(telemetry(now=now), 10.0 + k)
    assert session.board_time == pytest.approx(7 * 1_000_000_000 / TICK_HZ)


def test_a_stop_is_repeated_every_10_ms_until_it_is_answered(session: Session) -> None:
    session.begin()
    session.take()
    session.stop(10.0)
    times = [0.0]
    assert session.take() == [m.Stop()]
    for k in range(1, 36):
        session.tick(10.0 + 0.001 * k)
        times += [0.001 * k for _ in session.take()]
    assert times == pytest.approx([0.0, 0.010, 0.020, 0.030], abs=1.1e-3)
    session.receive(m.Stopped(65535, m.StopCause.HOST_STOP, 5000, (1, 2)), 10.04)
    assert not session.stopping
    session.tick(10.04 + 2 * STOP_REPEAT)
    assert session.take() == []


def test_a_late_answer_to_an_earlier_stop_says_nothing_about_this_motion(
    session: Session,
) -> None:
    late = m.Stopped(65534, m.StopCause.HOST_STOP, 900, (1, 2))
    session.begin()
    session.receive(late, 10.0)
    assert session.flight is not None
    session.stop(10.0)
    session.receive(late, 10.0)
    assert session.stopping


def test_a_stop_after_a_refused_arming_is_answered_by_the_old_epoch(session: Session) -> None:
    session.begin()
    session.receive(m.Refused("arm", m.Refusal.TIME), 10.0)
    session.stop(10.0)
    session.receive(m.Stopped(65534, m.StopCause.HOST_STOP, 900, (1, 2)), 10.0)
    assert not session.stopping


def test_a_stop_that_overruled_a_lost_arming_is_answered_by_the_old_epoch(
    session: Session,
) -> None:
    """100 ms of board time later, an Arm that came before the stop is not under way any more."""
    session.begin()
    session.stop(10.0)
    old = m.Stopped(epoch=65534, cause=m.StopCause.HOST_STOP, now=1000, counts=(100, -60))
    session.receive(telemetry(now=1000 + 100 * MS - 1), 10.1)
    session.receive(old, 10.1)
    assert session.stopping
    session.receive(telemetry(now=1000 + 100 * MS), 10.1)
    session.receive(old, 10.1)
    assert not session.stopping


def test_a_stop_waits_for_its_own_epoch_however_long_that_brakes(session: Session) -> None:
    session.begin()
    session.stop(10.0)
    session.receive(telemetry(now=1000 + 500 * MS, epoch=65535), 10.5)
    session.receive(m.Stopped(epoch=65534, cause=m.StopCause.HOST_STOP, now=0, counts=()), 10.5)
    assert session.stopping


def test_what_a_stop_overrules_need_not_be_answered(session: Session) -> None:
    session.enable(10.0, on=True)
    session.stop(10.1)
    session.receive(m.Stopped(epoch=0, cause=m.StopCause.HOST_STOP, now=0, counts=()), 10.1)
    session.receive(telemetry(), 12.0)
    session.tick(12.0)
    assert session.phase is Phase.READY


def test_an_estop_is_repeated_until_it_is_reported(session: Session) -> None:
    session.estop(10.0)
    session.tick(10.011)
    assert session.take() == [m.EStop(), m.EStop()]
    session.receive(telemetry(state=m.BoardState.ESTOP), 10.012)
    session.tick(10.1)
    assert session.take() == []


def test_keeping_alive_is_paced_and_carries_the_newest_tick(session: Session) -> None:
    session.keep(10.0)
    session.keep(10.0 + KEEP_PERIOD - 1e-6)
    session.receive(telemetry(now=7000), 10.02)
    session.keep(10.0 + KEEP_PERIOD)
    assert session.take() == [m.Keep(1000), m.Keep(7000)]


def test_nothing_is_kept_alive_by_ticking(session: Session) -> None:
    for k in range(100):
        session.tick(10.0 + 0.01 * k)
    assert session.take() == []


def test_homing_begins_with_a_live_lease(session: Session) -> None:
    session.home(10.0)
    assert session.take() == [m.Keep(1000), m.Home()]
    assert session.homing
    session.receive(m.Done("home"), 12.0)
    assert not session.homing
    assert not session.settled, "the telemetry is older than the answer"
    session.receive(telemetry(), 12.0)
    assert session.settled


def test_angles_come_from_counts(session: Session) -> None:
    assert session.theta == pytest.approx((100 / 500, -60 / 300))
    session.receive(telemetry(counts=()), 10.0)
    assert session.theta is None


def test_an_underrun_is_counted_once(session: Session) -> None:
    session.begin()
    for _ in range(3):
        session.receive(m.Stopped(65535, m.StopCause.UNDERRUN, 5000, (1, 2)), 10.0)
    assert session.underruns == 1
    assert session.flight is None
