"""Whether it is a message's turn: epochs, indices, times. Pure; the motion itself is `checks`."""

from __future__ import annotations

from collections.abc import Sequence

from deltaviz.link.board.queue import SegmentQueue
from deltaviz.link.messages import Arm, BoardState, CartesianSegment, Refusal, Segment
from deltaviz.link.rules import (
    AHEAD_MS,
    LATE_MS,
    SEGMENT_MAX_MS,
    SEGMENT_MIN_MS,
    since,
    since16,
)

KNOT_COUNTS = 1 << 21  # beyond, a count is no i32 of 2^-10 microsteps
HOMING_COUNTS = 1 << 30  # so far, the longest homing is within the integers of its arithmetic


def within(counts: Sequence[int], most: int) -> bool:
    return all(-most <= count < most for count in counts)


def arm_refusal(
    arm: Arm,
    *,
    now: int,
    last_epoch: int,
    counts: Sequence[int],
    idle: bool,
    ticks_per_ms: int,
) -> Refusal | None:
    if not idle:
        return Refusal.MOVING
    if since16(arm.epoch, last_epoch) <= 0:
        return Refusal.EPOCH
    if tuple(arm.counts) != tuple(counts) or not within(counts, KNOT_COUNTS):
        return Refusal.COUNTS
    if not _near(arm.t_start, now, ticks_per_ms):
        return Refusal.TIME
    return None


def segment_refusal(
    segment: Segment | CartesianSegment, *, state: BoardState, epoch: int, queue: SegmentQueue
) -> Refusal | None:
    """Why a segment is passed over, without harm to what runs."""
    if state is not BoardState.ARMED:
        return Refusal.STATE
    if segment.epoch != epoch:
        return Refusal.EPOCH
    if segment.index != queue.next_index:
        return Refusal.INDEX
    if queue.free == 0:
        return Refusal.QUEUE_FULL
    return None


def well_timed(
    segment: Segment | CartesianSegment,
    *,
    idle_at: int | None,
    queue: SegmentQueue,
    ticks_per_ms: int,
) -> bool:
    """`idle_at` is the present tick when nothing runs and nothing waits, else None."""
    if not SEGMENT_MIN_MS * ticks_per_ms <= segment.duration <= SEGMENT_MAX_MS * ticks_per_ms:
        return False
    start = segment.t_end - segment.duration
    if idle_at is not None:
        return _near(start, idle_at, ticks_per_ms)
    if not queue.knot.rests:
        return since(start, queue.nominal_end) == 0
    return (
        since(start, queue.nominal_end) >= 0 and since(start, queue.end) <= AHEAD_MS * ticks_per_ms
    )


def _near(start: int, now: int, ticks_per_ms: int) -> bool:
    return -LATE_MS * ticks_per_ms <= since(start, now) <= AHEAD_MS * ticks_per_ms
