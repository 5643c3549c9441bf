"""Segments that are lost on their way are sent again, until it is too late for them."""

from __future__ import annotations

from dataclasses import replace

import pytest

from deltaviz.link import messages as m
from deltaviz.link.session import Session
from deltaviz.link.timing import GAP_REPEAT, NOT_BEGUN, SEGMENT_REPEAT
from deltaviz.motion.knot import Knot
from tests.link.sessions import HOMED, TICK_HZ, ready_session, telemetry

EPOCH = 65535


def ticks(seconds: float) -> int:
    return round(seconds * TICK_HZ)


class Host:
    """A session in an epoch, that has sent `count` segments at board time 1000."""

    def __init__(self, count: int) -> None:
        self.session = ready_session()
        self.session.begin()
        for k in range(1, count + 1):
            self.session.segment(Knot(0.01, (0.2 + k / 1000, -0.2), (0.1, 0.0)), 10.0)
        _, *self.sent = self.session.take()

    def hears(self, *messages: m.BoardMessage) -> list[m.HostMessage]:
        for message in messages:
            self.session.receive(message, 10.0)
        self.session.tick(10.0)
        return self.session.take()


def at(seconds: float, *, taken: int = 0xFFFF, **changes: object) -> m.Telemetry:
    """`seconds` after the segments were sent."""
    now = 1000 + ticks(seconds)
    told = telemetry(epoch=EPOCH, now=now, last_index=taken, t_queue_end=now)
    return replace(told, **{"state": m.BoardState.ARMED, **changes})


def refused(index: int, reason: m.Refusal = m.Refusal.INDEX) -> m.Refused:
    return m.Refused("segment", reason, index=index)


TICK = 1 / TICK_HZ


def test_what_is_not_told_of_is_repeated_as_it_was() -> None:
    host = Host(3)
    host.hears(at(0.005, taken=0))
    assert host.hears(at(SEGMENT_REPEAT - TICK, taken=0)) == []
    again = host.hears(at(SEGMENT_REPEAT, taken=0))
    seen = 1000 + ticks(SEGMENT_REPEAT)
    assert again == [replace(segment, seen=seen) for segment in host.sent[1:]]


def test_a_gap_that_the_board_tells_of_is_closed_at_once() -> None:
    host = Host(3)
    assert host.hears(at(GAP_REPEAT - TICK, taken=0), refused(2)) == []
    again = host.hears(at(GAP_REPEAT, taken=0))
    assert [x.index for x in again if isinstance(x, m.Segment)] == [1, 2]


@pytest.mark.parametrize(
    "message",
    [refused(0), refused(1), refused(2, m.Refusal.BRAKE), m.Refused("tool", m.Refusal.STATE)],
)
def test_what_tells_of_no_gap_repeats_nothing(message: m.Refused) -> None:
    """A copy that came late, the missing one itself, another objection, another command."""
    host = Host(3)
    assert host.hears(at(GAP_REPEAT, taken=0), message) == []


def test_a_refused_copy_tells_of_no_gap() -> None:
    host = Host(3)
    host.hears(at(0.005, taken=0))
    host.hears(at(SEGMENT_REPEAT, taken=0))
    assert host.hears(at(SEGMENT_REPEAT + GAP_REPEAT, taken=0), refused(2)) == []


def test_a_slow_link_is_not_burdened() -> None:
    """The wait doubles, and follows the link's round trips."""
    host = Host(3)
    assert host.hears(at(SEGMENT_REPEAT)) != []
    assert host.hears(at(3 * SEGMENT_REPEAT - TICK)) == []
    slow = Host(3)
    assert slow.hears(at(0.020, taken=0), at(0.020, taken=0)) == []
    assert slow.hears(at(0.040 - TICK, taken=0)) == []
    assert slow.hears(at(0.040, taken=0)) != []


def test_a_motion_that_did_not_get_there_is_too_late() -> None:
    host = Host(2)
    host.hears(at(NOT_BEGUN - TICK))
    assert not host.session.never_began
    host.hears(at(NOT_BEGUN))
    assert host.session.never_began


def test_one_that_moves_has_begun() -> None:
    host = Host(2)
    host.hears(at(NOT_BEGUN, taken=0, flags=HOMED | m.TelemetryFlags.MOVING))
    assert not host.session.never_began


def test_one_that_the_board_has_ended_has_begun() -> None:
    host = Host(2)
    host.hears(at(NOT_BEGUN, taken=0, state=m.BoardState.HALTED))
    assert not host.session.never_began


PASSED_OVER = [m.Refusal.STATE, m.Refusal.EPOCH, m.Refusal.INDEX, m.Refusal.QUEUE_FULL]


@pytest.mark.parametrize("reason", PASSED_OVER)
def test_what_the_board_passes_over_ends_nothing(reason: m.Refusal) -> None:
    host = Host(2)
    host.hears(refused(1, reason))
    assert host.session.flight is not None
    assert host.session.refused is None


@pytest.mark.parametrize("reason", sorted(set(m.Refusal) - set(PASSED_OVER)))
def test_every_other_objection_is_told(reason: m.Refusal) -> None:
    host = Host(2)
    host.hears(refused(1, reason))
    assert host.session.refused == refused(1, reason)


def test_the_wire_is_told_from_the_computer() -> None:
    """A board that ran dry although its motion was sent in time, or not."""
    stopped = m.Stopped(EPOCH, m.StopCause.UNDERRUN, 5000, (1, 2))
    for host, lossy in ((Host(2), True), (Host(2), False)):
        host.hears(at(0.030, taken=0 if lossy else 1), stopped)
        assert host.session.lossy is lossy


def test_nothing_is_repeated_after_a_stop() -> None:
    host = Host(3)
    host.session.stop(10.0)
    host.session.take()
    assert host.hears(at(0.050)) == []


def test_a_session_without_an_epoch_has_nothing_to_repeat() -> None:
    session: Session = ready_session()
    session.tick(10.0)
    assert session.take() == []
    assert not session.never_began
