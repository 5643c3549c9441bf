"""Who controls, and which press lives: one moment before and after each threshold."""

from __future__ import annotations

import pytest

from deltaviz.machine.control_lease import ControlLease
from deltaviz.machine.fresh_press import PAUSE, FreshPress
from deltaviz.machine.jog_lease import DRIFT, LEASE, DragLease, JogLease, PageClock, PageClocks

TICK = 1e-6


def test_a_first_input_takes_control_that_nobody_holds_at_rest() -> None:
    lease = ControlLease()
    assert lease.refusal("a", at_rest=False)
    assert lease.refusal("a", at_rest=True) is None
    lease.take("a")
    assert lease.holder == "a"
    assert lease.refusal("a", at_rest=False) is None
    assert lease.refusal("b", at_rest=True)


def test_control_changes_hands_only_at_rest() -> None:
    lease = ControlLease()
    lease.take("a")
    assert lease.request("b", at_rest=False)
    assert lease.holder == "a"
    assert lease.release("a", at_rest=False)
    assert lease.request("b", at_rest=True) is None
    assert lease.holder == "b"
    assert lease.release("a", at_rest=True) is None, "harmless for one who does not hold it"
    assert lease.holder == "b"
    assert lease.release("b", at_rest=True) is None
    assert lease.holder is None


def test_a_page_keeps_control_at_rest_and_a_program_only_while_it_moves() -> None:
    lease = ControlLease()
    lease.take("program")
    lease.rested()
    assert lease.holder is None
    lease.here("page")
    lease.take("page")
    lease.rested()
    assert lease.holder == "page"
    assert lease.gone("page")
    assert lease.holder is None
    lease.request("program", at_rest=True)
    lease.rested()
    assert lease.holder == "program"


def test_a_jog_lives_200_ms_after_the_sending_of_its_last_beat() -> None:
    lease = JogLease(PageClocks())
    assert lease.begin("a", "1", at=10.0, now=10.0) is None
    assert not lease.expired(10.0 + LEASE - TICK)
    assert lease.expired(10.0 + LEASE + TICK)
    # Sent at 5 s of the page's clock, 50 ms on the way at the fastest.
    assert beat(lease, seq=0, sent=5.000, at=10.05)
    assert beat(lease, seq=1, sent=5.100, at=10.25)  # 100 ms late
    assert not lease.expired(10.15 + LEASE - 1e-3)
    assert lease.expired(10.15 + LEASE + 1e-3)


def test_a_burst_that_was_held_up_revives_nothing() -> None:
    lease = JogLease(PageClocks())
    lease.begin("a", "1", at=10.0, now=10.0)
    beat(lease, seq=0, sent=0.0, at=10.0)
    for seq in range(1, 10):  # sent in time, all delivered 1 s late
        beat(lease, seq=seq, sent=seq * 0.05, at=11.0)
    assert lease.expired(11.0)


def test_an_old_or_repeated_beat_counts_for_nothing() -> None:
    lease = JogLease(PageClocks())
    lease.begin("a", "1", at=10.0, now=10.0)
    assert beat(lease, seq=5, sent=0.1, at=10.1)
    assert not beat(lease, seq=5, sent=0.2, at=10.2)
    assert not beat(lease, seq=4, sent=0.2, at=10.2)
    assert lease.expired(10.1 + LEASE + TICK)


def test_an_ended_press_never_lives_again() -> None:
    lease = JogLease(PageClocks())
    lease.begin("a", "1", at=10.0, now=10.0)
    lease.end()
    assert lease.begin("a", "1", at=10.5, now=10.5)
    assert not beat(lease, seq=9, sent=0.5, at=10.5)
    assert not lease.live
    assert lease.begin("a", "2", at=10.5, now=10.5) is None
    assert not beat(lease, seq=10, sent=0.6, at=10.6, press="1")


def test_a_new_press_ends_the_one_before() -> None:
    lease = JogLease(PageClocks())
    lease.begin("a", "1", at=10.0, now=10.0)
    lease.begin("a", "2", at=10.1, now=10.1)
    assert not beat(lease, seq=0, sent=0.0, at=10.1, press="1")
    assert beat(lease, seq=0, sent=0.0, at=10.1, press="2")
    assert lease.begin("a", "1", at=10.2, now=10.2)


def test_a_press_that_waited_too_long_in_the_pipe_begins_nothing() -> None:
    lease = JogLease(PageClocks())
    assert lease.begin("a", "1", at=10.0, now=10.0 + LEASE)
    assert not lease.live
    assert lease.begin("a", "2", at=10.0, now=10.0 + LEASE - TICK) is None


def test_the_smallest_offset_wins_and_grows_only_by_drift() -> None:
    clock = PageClock()
    assert clock.sending(sent_ms=0.0, at=10.3) == pytest.approx(10.3)
    assert clock.sending(sent_ms=100.0, at=10.1) == pytest.approx(10.1)  # the fastest
    assert clock.sending(sent_ms=200.0, at=11.0) == pytest.approx(10.2, abs=2 * DRIFT)
    # An hour later the page's clock has lost 0.1 s, far less than what is allowed for.
    assert clock.sending(sent_ms=3_600_000.0, at=3610.1) == pytest.approx(3610.1)


def test_each_page_of_a_client_has_its_own_clock() -> None:
    lease = JogLease(PageClocks())
    lease.begin("a", "1", at=10.0, now=10.0)
    beat(lease, seq=0, sent=500.0, at=10.0, clock="old tab")
    lease.begin("a", "2", at=20.0, now=20.0)
    assert beat(lease, seq=0, sent=0.0, at=20.0, press="2", clock="new tab")
    assert not lease.expired(20.1)


def test_a_reloaded_page_starts_a_new_clock() -> None:
    clocks = PageClocks()
    lease = JogLease(clocks)
    lease.begin("a", "1", at=10.0, now=10.0)
    beat(lease, seq=0, sent=500.0, at=10.0)
    clocks.forget("a")
    lease.begin("a", "2", at=20.0, now=20.0)
    beat(lease, seq=0, sent=0.0, at=20.0, press="2")
    assert not lease.expired(20.1)


def test_a_drag_lives_by_the_consoles_word_whichever_comes_first() -> None:
    lease = DragLease(PageClocks())
    lease.alive("a", sent_ms=1000.0, clock="", at=10.0)
    assert not lease.live
    assert lease.begin("a", at=10.05, now=10.05) is None
    assert not lease.expired(10.05 + LEASE - TICK)
    lease.alive("a", sent_ms=1100.0, clock="", at=10.1)
    assert not lease.expired(10.1 + LEASE - 1e-3)
    assert lease.expired(10.1 + LEASE + 1e-3)
    for late in range(10):
        lease.alive("a", sent_ms=1110.0 + late, clock="", at=12.0)
    assert lease.expired(12.0)


def test_only_the_clients_own_page_keeps_its_drag_alive() -> None:
    lease = DragLease(PageClocks())
    lease.begin("a", at=10.0, now=10.0)
    lease.alive("b", sent_ms=100.0, clock="", at=10.1)
    assert lease.expired(10.0 + LEASE + TICK)


def test_a_slider_pulled_through_a_stop_is_dead_until_it_pauses() -> None:
    press = FreshPress()
    assert press.admits("a", 10.0)
    assert press.admits("a", 10.1)
    press.stopped(10.15)
    for k in range(20):
        assert not press.admits("a", 10.2 + 0.1 * k)
    assert not press.admits("a", 12.1 + PAUSE - TICK)
    assert press.admits("a", 12.1 + 2 * PAUSE)
    assert press.admits("b", 10.2), "another's first value is a fresh press"


def beat(
    lease: JogLease, *, seq: int, sent: float, at: float, press: str = "1", clock: str = ""
) -> bool:
    return lease.beat("a", press, seq=seq, sent_ms=sent * 1000, clock=clock, at=at)
