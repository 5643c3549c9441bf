"""Motion needs a host that saw recent telemetry: 150 ms after it, the brake has begun."""

from __future__ import annotations

from itertools import pairwise

import pytest

from deltaviz.link.board.lease import Lease
from deltaviz.link.messages import (
    BoardState,
    Home,
    Keep,
    Refusal,
    Refused,
    StopCause,
    Telemetry,
    TelemetryFlags,
)
from deltaviz.link.rules import since

MS = 200
MASK = 0xFFFF_FFFF


@pytest.fixture
def cruising(bench):
    """Half a second of motion in the queue, and a lease from this very tick."""
    bench.speed_up(500)
    bench.go_on(50)
    bench.run(30)
    bench.advance(MS)
    bench.send(Keep(bench.now))
    return bench


def speeds(bench, ms):
    """Of joint 0 in each millisecond, microsteps."""
    before, seen = bench.board.positions[0], []
    for _ in range(ms):
        bench.advance(MS)
        here = bench.board.positions[0]
        seen.append((here - before) / 2**32)
        before = here
    return seen


def test_it_ends_150_ms_after_what_the_host_saw(cruising):
    """Control decides it where the last piece begins."""
    cruising.advance(149 * MS - 1)
    assert cruising.board.state is BoardState.ARMED
    cruising.advance(1)
    assert cruising.board.state is BoardState.BRAKING
    assert cruising.board.cause is StopCause.LEASE


@pytest.mark.parametrize(("later", "cruises"), [(0, 150), (1, 150), (199, 150), (200, 151)])
def test_it_slows_from_the_last_whole_millisecond_on(cruising, later, cruises):
    """`later`: the ticks from a boundary to what the host saw."""
    start = cruising.now
    cruising.advance(later)
    cruising.send(Keep(cruising.now))
    cruising.advance(MS - cruising.ticks_since(start) % MS)
    passed = cruising.ticks_since(start) // MS
    seen = speeds(cruising, 160)
    assert seen[: cruises - passed] == pytest.approx([0.5] * (cruises - passed), abs=1e-3)
    slower = seen[cruises - passed :]
    assert all(b < a - 0.01 for a, b in pairwise(slower) if a > 0.05)
    assert slower[0] < 0.49


def test_one_tick_before_its_end_it_can_be_extended(cruising):
    cruising.advance(149 * MS - 1)
    cruising.send(Keep(cruising.now))
    cruising.advance(148 * MS)
    assert cruising.board.state is BoardState.ARMED
    cruising.advance(1)
    assert cruising.board.state is BoardState.BRAKING


@pytest.mark.parametrize("offset", [1, 100 * MS, 2**31 - 1], ids=str)
def test_a_tick_of_the_future_extends_nothing(cruising, offset):
    cruising.send(Keep((cruising.now + offset) & MASK))
    cruising.advance(150 * MS)
    assert cruising.board.state is BoardState.BRAKING


def test_an_older_tick_shortens_nothing(cruising):
    cruising.send(Keep((cruising.now - 100 * MS) & MASK))
    cruising.advance(149 * MS - 1)
    assert cruising.board.state is BoardState.ARMED


def test_a_burst_of_old_keepalives_keeps_nothing_moving(cruising):
    old = cruising.now
    for _ in range(200):
        cruising.send(Keep(old))
        cruising.advance(MS)
    assert cruising.board.state is not BoardState.ARMED


def test_segments_extend_it_too(cruising):
    cruising.advance(100 * MS)
    cruising.seen = cruising.now
    cruising.go_on(1)
    cruising.advance(149 * MS - 1)
    assert cruising.board.state is BoardState.ARMED


def test_at_rest_it_latches_nothing(bench):
    bench.arm()
    bench.run(400, keep=False)
    assert bench.board.state is BoardState.ARMED
    assert bench.board.cause is StopCause.NONE


def test_from_rest_a_stale_segment_does_not_begin(bench):
    bench.arm()
    bench.run(400)
    bench.advance(150 * MS)
    old = (bench.now - 150 * MS) & MASK
    bench.t_end = bench.now
    messages = bench.segment([0.5, 100], [0, 0], seen=old)
    assert [m.reason for m in messages if isinstance(m, Refused)] == [Refusal.LEASE]
    assert not bench.board.moving
    assert bench.board.cause is StopCause.LEASE


def test_from_rest_a_segment_that_is_fresh_by_one_tick_begins(bench):
    bench.arm()
    bench.run(400)
    bench.advance(150 * MS)
    bench.t_end = bench.now
    messages = bench.segment([0.5, 100], [0, 0], seen=(bench.now - 150 * MS + 1) & MASK)
    assert not any(isinstance(m, Refused) for m in messages)
    assert bench.board.state is BoardState.ARMED


def test_a_motion_that_begins_with_an_old_tick_needs_a_newer_one_to_go_on(bench):
    bench.arm()
    bench.run(400, keep=False)
    bench.t_end = bench.now
    bench.segment([0.5, 100], [0, 0], seen=(bench.now - 140 * MS) & MASK, ms=40)
    bench.advance(9 * MS - 1)
    assert bench.board.moving
    bench.advance(1)
    assert bench.board.cause is StopCause.LEASE


def test_homing_needs_it_from_the_start(make_bench):
    bench = make_bench(homed=False)
    messages = bench.send(Home())
    assert Refused("home", Refusal.LEASE) in messages
    assert bench.board.state is BoardState.HALTED


def test_homing_ends_with_it(make_bench):
    bench = make_bench(homed=False)
    bench.send(Keep(bench.now))
    bench.send(Home())
    bench.advance(149 * MS - 1)
    assert bench.board.state is BoardState.HOMING
    bench.advance(1)
    assert bench.board.state is BoardState.BRAKING
    bench.run_to_rest(keep=False)
    assert bench.board.cause is StopCause.LEASE
    assert not bench.board.homed


def test_telemetry_tells_of_it(bench):
    bench.send(Keep(bench.now))
    bench.advance(145 * MS)
    assert TelemetryFlags.LEASE_ALIVE in bench.last(Telemetry).flags
    bench.advance(5 * MS)
    assert TelemetryFlags.LEASE_ALIVE not in bench.last(Telemetry).flags


def test_an_expired_tick_is_never_compared_after_the_counter_has_wrapped():
    lease = Lease(30_000)
    lease.extend(100, 100)
    lease.expire()
    lease.extend(2**31 + 200, 2**31 + 200)  # older than 100 by the counter
    assert lease.remaining(2**31 + 200) == 30_000


def test_since_wraps():
    assert since(5, 2**32 - 5) == 10
    assert since(2**32 - 5, 5) == -10
