"""The session's tables: what leads where, as the rules for the wire tell it."""

from __future__ import annotations

import pytest

from deltaviz.link.session_states import MOTIONS, PHASES, Motion, News, Phase, Turn

WAY = [
    (Phase.GREETING, News.FITS),
    (Phase.CONFIGURING, News.TAKEN),
    (Phase.CONFIGURED, News.REPORTED),
]


def test_there_is_one_way_to_ready() -> None:
    phase = Phase.GREETING
    for at, news in WAY:
        assert phase is at
        phase = PHASES[phase, news]
    assert phase is Phase.READY
    others = {step: to for step, to in PHASES.items() if step not in WAY}
    assert set(others.values()) == {Phase.FAILED}


def test_each_phase_on_the_way_can_fail_and_none_is_left_after_that() -> None:
    for phase in Phase:
        leads = {to for (at, _), to in PHASES.items() if at is phase}
        assert (Phase.FAILED in leads) == (phase is not Phase.FAILED)


@pytest.mark.parametrize("motion", Motion)
def test_stops_are_taken_in_every_state(motion: Motion) -> None:
    stronger = Motion.ESTOPPING if motion is Motion.ESTOPPING else Motion.STOPPING
    assert MOTIONS[motion, Turn.STOP] is stronger
    assert MOTIONS[motion, Turn.ESTOP] is Motion.ESTOPPING


@pytest.mark.parametrize("motion", [Motion.STOPPING, Motion.ESTOPPING])
def test_nothing_begins_while_a_stop_is_under_way(motion: Motion) -> None:
    assert (motion, Turn.BEGIN) not in MOTIONS
    assert (motion, Turn.HOME) not in MOTIONS


def test_only_the_host_begins_a_motion() -> None:
    begins = {turn for (at, turn), to in MOTIONS.items() if to in (Motion.EPOCH, Motion.HOMING)}
    assert begins == {Turn.BEGIN, Turn.HOME}


def test_every_motion_can_end() -> None:
    for motion in set(Motion) - {Motion.NONE}:
        assert any(at is motion and to is Motion.NONE for (at, _), to in MOTIONS.items())
