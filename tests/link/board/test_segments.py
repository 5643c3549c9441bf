"""The queue: what is taken, when it runs, and what happens when it runs dry."""

from __future__ import annotations

import pytest

from deltaviz.link.board.queue import SegmentQueue
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
MASK = 0xFFFF_FFFF


def refusals(messages):
    return [m.reason for m in messages if isinstance(m, Refused)]


def hold(bench, **changes):
    """A segment that stays where it is."""
    return bench.segment(bench.board.counts, [0.0] * len(bench.board.counts), **changes)


def test_from_rest_it_starts_at_once(bench):
    bench.arm()
    bench.segment([2.4, 100], [480, 0])
    assert bench.board.moving


def test_it_arrives_at_the_tick_it_said(bench):
    bench.arm()
    bench.segment([2.25, 100], [0, 0], ms=20)
    bench.advance(20 * MS - 1)
    assert bench.board.moving
    bench.advance(1)
    assert not bench.board.moving
    assert bench.board.positions == [round(2.25 * 2**32), 100 << 32]
    assert bench.board.counts == (2, 100)


def test_a_start_in_the_future_is_waited_for(bench):
    bench.arm()
    bench.segment([2, 100], [0, 0], ms=20, t_end=(bench.now + 70 * MS) & MASK)
    bench.advance(50 * MS - 1)
    assert not bench.board.moving
    bench.advance(1)
    assert bench.board.moving


def test_what_comes_late_runs_late_and_what_follows_too(bench):
    bench.arm()
    bench.advance(7 * MS)
    bench.segment([1, 100], [200, 0])
    bench.segment([2, 100], [0, 0])
    bench.advance(20 * MS - 1)
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
    bench.segment([2, 100], [0, 0], ms=20)
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
    for _ in range(QUEUE_PLACES + 1):  # one runs, the others wait
        assert refusals(hold(bench)) == []
    assert refusals(hold(bench)) == [Refusal.QUEUE_FULL]
    bench.index -= 1
    bench.t_end = (bench.t_end - 10 * MS) & MASK
    bench.run(10)
    assert refusals(hold(bench)) == []


def test_a_queue_that_ends_in_motion_brakes_at_that_very_tick(bench):
    bench.arm()
    bench.segment([2.4, 100], [480, 0])
    bench.advance(10 * MS - 1)
    assert bench.board.state is BoardState.ARMED
    bench.advance(1)
    assert bench.board.state is BoardState.BRAKING
    bench.run_to_rest()
    assert bench.board.state is BoardState.HALTED
    assert bench.last(Stopped).cause is StopCause.UNDERRUN
    assert bench.last(Stopped).counts == bench.board.counts


def test_the_next_segment_one_tick_before_the_end_is_in_time(bench):
    bench.arm()
    bench.segment([2.4, 100], [480, 0])
    bench.advance(10 * MS - 1)
    bench.segment([4.8, 100], [0, 0])
    bench.run(20)
    assert bench.board.state is BoardState.ARMED
    assert bench.board.counts == (5, 100)  # the nearest to 4.8


def test_indices_wrap():
    queue = SegmentQueue(places=4)
    queue.open((0,), 0)
    queue.next_index = 65535
    queue.push(Segment(1, 65535, 2000, 2000, 0, (0,), (0,)), idle_at=0)
    assert queue.next_index == 0


def test_telemetry_tells_what_was_taken_and_when_the_queue_ends(bench):
    bench.arm()
    start = bench.now
    for _ in range(3):
        hold(bench)
    bench.advance(5 * MS)
    told = bench.last(Telemetry)
    assert (told.epoch, told.last_index, told.free) == (bench.epoch, 2, QUEUE_PLACES - 2)
    assert since(told.t_queue_end, start) == 30 * MS
    bench.run(40)
    told = bench.last(Telemetry)
    assert told.t_queue_end == told.now
