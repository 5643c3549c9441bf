"""Segments run only in an epoch; an epoch opens at rest, once, and from true counts."""

from __future__ import annotations

import pytest

from deltaviz.link.messages import (
    BoardState,
    Done,
    Enable,
    Refusal,
    Refused,
    Segment,
    Stop,
    StopCause,
)

MS = 200


def refusal(messages):
    return next(m.reason for m in messages if isinstance(m, Refused))


def test_arming_opens_an_epoch(bench):
    assert Done("arm") in bench.arm()
    assert bench.board.state is BoardState.ARMED
    assert bench.board.cause is StopCause.NONE


@pytest.mark.parametrize(
    ("epoch", "accepted"),
    [(7, False), (6, False), (8, True), (7 + 32767, True), (7 + 32768, False)],
)
def test_an_epoch_is_newer_than_the_last(make_bench, epoch, accepted):
    bench = make_bench(last_epoch=7)
    messages = bench.arm(epoch=epoch)
    assert (bench.board.state is BoardState.ARMED) == accepted
    if not accepted:
        assert refusal(messages) is Refusal.EPOCH


def test_epochs_wrap(make_bench):
    bench = make_bench(last_epoch=65535)
    bench.arm(epoch=0)
    assert bench.board.state is BoardState.ARMED
    bench.send(Stop())
    assert refusal(bench.arm(epoch=65535)) is Refusal.EPOCH


def test_an_epoch_is_never_opened_twice(bench):
    bench.arm()
    bench.send(Stop())
    assert refusal(bench.arm(epoch=bench.epoch)) is Refusal.EPOCH
    assert bench.board.state is BoardState.HALTED


@pytest.mark.parametrize("counts", [(0, 101), (1, 100), (), (0, 100, 0)])
def test_counts_must_be_the_boards_own(bench, counts):
    assert bench.board.counts == (0, 100)
    assert refusal(bench.arm(counts=counts)) is Refusal.COUNTS


@pytest.mark.parametrize(
    ("offset", "accepted"),
    [(-150 * MS - 1, False), (-150 * MS, True), (100 * MS, True), (100 * MS + 1, False)],
)
def test_the_host_means_now(bench, offset, accepted):
    bench.arm(t_start=(bench.now + offset) & 0xFFFF_FFFF)
    assert (bench.board.state is BoardState.ARMED) == accepted


def test_not_while_it_moves(bench):
    bench.speed_up(1000)
    bench.run(5)
    assert refusal(bench.arm()) is Refusal.MOVING
    bench.epoch -= 1


@pytest.mark.parametrize(("end", "rests"), [(20 * MS, 20), (20 * MS + 1, 21), (21 * MS - 1, 21)])
def test_it_rests_where_the_piece_ends_in_which_it_comes_to_rest(bench, end, rests):
    bench.arm()
    bench.segment([1, 100], [0, 0], ms=15, t_end=(bench.now + end) & 0xFFFF_FFFF)
    bench.advance(rests * MS - 1)
    assert refusal(bench.arm()) is Refusal.MOVING
    bench.epoch -= 1
    bench.advance(1)
    assert Done("arm") in bench.arm()
    assert bench.board.counts == (1, 100)


def test_not_while_disabled(make_bench, make_configure):
    bench = make_bench(homed=False)
    bench.send(Enable(on=False))
    assert refusal(bench.arm()) is Refusal.STATE


def test_segments_are_refused_without_an_epoch_and_do_no_harm(bench):
    assert refusal(bench.segment([1, 100], [0, 0])) is Refusal.STATE
    bench.arm()
    assert refusal(bench.segment([1, 100], [0, 0], epoch=bench.epoch + 1)) is Refusal.EPOCH
    assert bench.board.state is BoardState.ARMED
    assert not bench.board.moving


def test_after_a_stop_the_old_epochs_segments_are_dead(bench):
    bench.speed_up(1000)
    bench.run(5)
    bench.send(Stop())
    bench.run_to_rest()
    counts = bench.board.counts
    messages = bench.segment([500, 100], [0, 0])
    assert refusal(messages) is Refusal.STATE
    bench.run(50)
    assert bench.board.counts == counts


def test_arming_again_at_rest_closes_the_epoch_before(bench):
    bench.arm()
    old = bench.epoch
    bench.arm()
    assert refusal(bench.segment([1, 100], [0, 0], epoch=old)) is Refusal.EPOCH


def test_the_first_segment_starts_from_the_count(bench):
    """A brake may end between two microsteps: the fraction is forgotten by both sides."""
    bench.speed_up(1000)
    bench.run(13)
    bench.send(Stop())
    bench.run_to_rest()
    counts = bench.board.counts
    bench.arm()
    assert bench.board.positions == [count << 32 for count in counts]


def test_a_segment_carries_numbers_for_every_joint(bench):
    bench.arm()
    bad = Segment(bench.epoch, 0, bench.now + 2000, 2000, bench.seen, (0,), (0,))
    assert refusal(bench.send(bad)) is Refusal.CONFIGURATION
    assert bench.board.cause is StopCause.BAD_SEGMENT
