"""Wire, host or board break in every phase: the robot rests, says why, and begins nothing again."""

from __future__ import annotations

import pytest

from deltaviz.machine.mode import Mode
from tests.faults.breaks import BREAKS, Outcome, break_at
from tests.faults.measured import outcome
from tests.faults.phases import IN_MOTION, PHASES

RIDDEN_THROUGH = {"the host stalled for 20 ms"}
BRAKES_WITHIN = 0.45  # s: the lease, and the longest brake


def assert_safe(came: Outcome) -> None:
    assert came.wrong == []
    assert came.rested <= BRAKES_WITHIN
    if came.stopped or came.end is Mode.OFFLINE:
        assert came.told


@pytest.mark.parametrize("how", BREAKS)
@pytest.mark.parametrize("phase", PHASES)
def test_in_every_phase(phase: str, how: str) -> None:
    assert_safe(outcome(phase, how))


@pytest.mark.parametrize("how", sorted(RIDDEN_THROUGH))
@pytest.mark.parametrize("phase", ["homing", "jogging", "moving"])
def test_a_short_stall_is_ridden_through(phase: str, how: str) -> None:
    came = outcome(phase, how)
    assert came.moving
    assert not came.stopped
    assert sum(verdict.brakes for verdict in came.verdicts) == 0
    assert came.told is None


@pytest.mark.parametrize("how", sorted(set(BREAKS) - RIDDEN_THROUGH - {"the wire gone for 100 ms"}))
@pytest.mark.parametrize("phase", IN_MOTION)
def test_everything_longer_stops_what_moves(phase: str, how: str) -> None:
    came = outcome(phase, how)
    assert came.moving
    assert came.stopped
    assert came.told


@pytest.mark.long
@pytest.mark.timeout(3600)
@pytest.mark.parametrize("seed", range(2, 42))
@pytest.mark.parametrize("how", BREAKS)
@pytest.mark.parametrize("phase", PHASES)
def test_whatever_the_moment(phase: str, how: str, seed: int) -> None:
    assert_safe(break_at(phase, how, seed=seed))
