"""The queue: what is taken, when it runs, and what happens when it runs dry."""

from __future__ import annotations

import pytest

from deltaviz.link.board.queue import Knot, SegmentQueue
from deltaviz.link.messages import (
    BoardState,
    Refusal,
    Refused,
    Segment,
    StopCause,
    Stopped,
    Telemetry,
)
from deltaviz.link.rules import QUEUE_PLACES, since

MS = 200
ACCELERATION = 50_000.0
MASK = 0xFFFF_FFFF


def refusals(messages):
    return [m.reason for m in messages if isinstance(m, Refused)]


def hold(bench, **changes):
    """A segment that stays where it is."""
    return bench.segment(bench.board.counts, [0.0] * len(bench.board.counts), **changes)


PLANNED = 2 * MS  # where a piece begins, two are planned


def first_motion(bench, ticks):
    """The ticks, out of so many, after which the board has begun to move; None: it has not."""
    here = bench.board.positions
    for tick in range(ticks):
        bench.advance(1)
        if bench.board.positions != here:
            return tick + 1
    return None


@pytest.mark.parametrize("into_a_piece", [0, 1, 120, MS - 1])
def test_from_rest_it_starts_where_the_plan_ends(bench, into_a_piece):
    """One to two milliseconds later."""
    bench.arm()
    bench.advance(into_a_piece)
    bench.t_end = bench.now
    bench.segment([2.4, 100], [480, 0])
    assert first_motion(bench, PLANNED + MS) == PLANNED - into_a_piece + 1


def test_it_arrives_at_the_tick_it_said(bench):
    bench.arm()
    bench.segment([2.25, 100], [0, 0], ms=20, t_end=(bench.now + 25 * MS) & MASK)
    bench.advance(25 * MS - 1)
    assert bench.board.positions[0] < round(2.25 * 2**32)
    assert bench.board.moving
    bench.advance(1)
    assert not bench.board.moving
    assert bench.board.positions == [round(2.25 * 2**32), 100 << 32]
    assert bench.board.counts == (2, 100)


@pytest.mark.parametrize("ticks", [50 * MS, 50 * MS + 77])
def test_a_start_in_the_future_is_waited_for(bench, ticks):
    """Between two boundaries, too: then the piece in which it lies begins to move."""
    bench.arm()
    bench.segment([2, 100], [0, 0], ms=20, t_end=(bench.now + ticks + 20 * MS) & MASK)
    bench.advance(50 * MS)
    assert first_motion(bench, MS) == 1
    bench.advance(20 * MS - 1)
    assert (bench.board.positions[0] == 2 << 32) == (ticks % MS == 0)
    bench.advance(MS)
    assert bench.board.positions[0] == 2 << 32


def test_what_comes_late_runs_late_and_what_follows_too(bench):
    bench.arm()
    bench.advance(7 * MS)
    bench.segment([1, 100], [200, 0])
    bench.segment([2, 100], [0, 0])
    bench.advance(PLANNED + 20 * MS - 1)
    assert bench.board.moving
    bench.advance(1)
    assert not bench.board.moving
    assert bench.board.state is BoardState.ARMED


def test_an_epoch_goes_on_after_a_rest(bench):
    bench.arm()
    bench.segment([2, 100], [0, 0], ms=20)
    bench.run(300)
    assert bench.board.state is BoardState.ARMED
    bench.t_end = bench.now
    bench.segment([4, 100], [0, 0], ms=20)
    bench.run(20)
    assert bench.board.counts == (4, 100)


def test_a_pause_may_follow_a_knot_at_rest_that_still_runs(bench):
    bench.arm()
    bench.segment([2, 100], [0, 0], ms=20)
    bench.t_end = (bench.t_end + 5 * MS) & MASK
    bench.segment([4, 100], [0, 0], ms=20)
    bench.advance(22 * MS)
    assert not bench.board.moving
    bench.advance(4 * MS)
    assert bench.board.moving
    bench.advance(19 * MS)
    assert not bench.board.moving
    assert bench.board.counts == (4, 100)


@pytest.mark.parametrize(("shift", "accepted"), [(-1, False), (0, True), (1, False)])
def test_no_gap_and_no_overlap_after_a_knot_that_moves(bench, shift, accepted):
    bench.arm()
    bench.segment([2.4, 100], [480, 0])
    bench.t_end = (bench.t_end + shift) & MASK
    messages = bench.segment([4.8, 100], [0, 0])
    assert refusals(messages) == ([] if accepted else [Refusal.TIME])


@pytest.mark.parametrize(
    ("shift", "accepted"), [(-1, False), (0, True), (100 * MS, True), (100 * MS + 1, False)]
)
def test_a_pause_after_a_knot_at_rest_is_at_most_100_ms(bench, shift, accepted):
    bench.arm()
    bench.segment([2, 100], [0, 0], ms=20, t_end=(bench.now + PLANNED + 20 * MS) & MASK)
    bench.t_end = (bench.t_end + shift) & MASK
    assert refusals(bench.segment([4, 100], [0, 0], ms=20)) == ([] if accepted else [Refusal.TIME])


@pytest.mark.parametrize(
    ("shift", "accepted"),
    [(-150 * MS - 1, False), (-150 * MS, True), (100 * MS, True), (100 * MS + 1, False)],
)
def test_at_rest_a_segment_starts_about_now(bench, shift, accepted):
    bench.arm()
    bench.run(200)
    bench.t_end = (bench.now + shift) & MASK
    assert refusals(hold(bench)) == ([] if accepted else [Refusal.TIME])


@pytest.mark.parametrize(
    ("duration", "accepted"),
    [(4 * MS - 1, False), (4 * MS, True), (50 * MS, True), (50 * MS + 1, False), (0, False)],
)
def test_a_segment_lasts_4_to_50_ms(bench, duration, accepted):
    bench.arm()
    messages = hold(bench, duration=duration)
    assert refusals(messages) == ([] if accepted else [Refusal.TIME])
    assert (bench.board.cause is StopCause.BAD_SEGMENT) != accepted


@pytest.mark.parametrize("index", [0, 2, 65535])
def test_out_of_turn_is_passed_over(bench, index):
    bench.arm()
    hold(bench)
    assert refusals(hold(bench, index=index)) == [Refusal.INDEX]
    assert bench.board.state is BoardState.ARMED


def test_a_full_queue_takes_no_more_and_loses_nothing(bench):
    bench.arm()
    for _ in range(QUEUE_PLACES):
        assert refusals(hold(bench)) == []
    assert refusals(hold(bench)) == [Refusal.QUEUE_FULL]
    bench.index -= 1
    bench.t_end = (bench.t_end - 10 * MS) & MASK
    bench.run(1)  # the first is taken up
    assert refusals(hold(bench)) == []


# Where a knot lies (ticks after the segment was sent), and when control plans what follows it.
KNOTS = [
    (15 * MS, 14 * MS),
    (15 * MS + 1, 14 * MS),
    (15 * MS - 1, 13 * MS),
    (15 * MS + 77, 14 * MS),
]


@pytest.mark.parametrize(("knot", "looks"), KNOTS)
def test_a_queue_that_ends_in_motion_brakes_from_that_very_knot(bench, knot, looks):
    """Noticed one to two milliseconds before, when the piece in which it lies is planned."""
    bench.arm()
    bench.segment([2.4, 100], [480, 0], t_end=(bench.now + knot) & MASK)
    bench.advance(looks - 1)
    assert bench.board.state is BoardState.ARMED
    bench.advance(1)
    assert bench.board.state is BoardState.BRAKING
    bench.advance(knot - looks)
    assert bench.board.positions[0] / 2**32 == pytest.approx(2.4, abs=0.01)
    bench.run_to_rest()
    time = 480 / ACCELERATION
    assert bench.board.positions[0] / 2**32 == pytest.approx(2.4 + 480 * time / 2, abs=0.01)
    assert bench.board.state is BoardState.HALTED
    assert bench.last(Stopped).cause is StopCause.UNDERRUN
    assert bench.last(Stopped).counts == bench.board.counts


@pytest.mark.parametrize(("knot", "looks"), KNOTS)
def test_the_next_segment_one_tick_before_that_is_in_time(bench, knot, looks):
    bench.arm()
    bench.segment([2.4, 100], [480, 0], t_end=(bench.now + knot) & MASK)
    bench.advance(looks - 1)
    bench.segment([4.8, 100], [0, 0])
    bench.run(25)
    assert bench.board.state is BoardState.ARMED
    assert bench.board.counts == (5, 100)  # the nearest to 4.8


def test_indices_wrap():
    queue = SegmentQueue(places=4)
    queue.open((0,), t_start=0, planned=0)
    queue.next_index = 65535
    queue.push(Segment(1, 65535, 2000, 2000, 0, (0,), (0,)), Knot((0,), (0,)), planned=0, idle=True)
    assert queue.next_index == 0


def test_telemetry_tells_what_was_taken_and_when_the_queue_ends(bench):
    bench.arm()
    start = bench.now
    for _ in range(3):
        hold(bench)
    bench.advance(5 * MS)
    told = bench.last(Telemetry)
    assert (told.epoch, told.last_index, told.free) == (bench.epoch, 2, QUEUE_PLACES - 2)
    assert since(told.t_queue_end, start) == PLANNED + 30 * MS
    bench.run(40)
    told = bench.last(Telemetry)
    assert told.t_queue_end == told.now
