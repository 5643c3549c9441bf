"""Bytes and frames are hurt on their way: the robot does what was commanded or rests, and says why.

A longer search: `python -m pytest tests/faults -m long`.
"""

from __future__ import annotations

import pytest

from deltaviz.machine.transitions import AT_REST
from tests.faults.faulty_line import Fault
from tests.faults.measured import meetings, work
from tests.faults.wire_faults import FAULTS, Work, work_with


def assert_safe(done: Work) -> None:
    assert done.wrong == []
    assert done.day.untold == 0
    assert done.end in AT_REST


def test_a_sound_wire_stops_nobody() -> None:
    done = work_with(None, seconds=4.0, seed=1)
    assert_safe(done)
    assert done.injected == done.day.count == sum(v.brakes for v in done.verdicts) == 0


@pytest.mark.parametrize("fault", FAULTS, ids=lambda f: f"{f} {f.rate:%}")
def test_a_robot_does_as_told_or_rests_and_says_why(fault: Fault) -> None:
    done = work(fault)
    assert_safe(done)
    assert done.injected > 0 or fault.rate * done.frames < 10


@pytest.mark.parametrize("fault", [f for f in FAULTS if f.rate <= 0.001], ids=str)
def test_one_fault_in_a_thousand_does_not_stop_the_work(fault: Fault) -> None:
    assert work(fault).day.count == 0


@pytest.mark.parametrize("fault", [f for f in FAULTS if f.rate == 0.01], ids=str)
def test_a_board_is_met_through_it_or_the_page_says_what_is_wrong(fault: Fault) -> None:
    for problem in meetings(fault):
        assert problem is None or "onnect" in problem


@pytest.mark.long
@pytest.mark.timeout(3600)
@pytest.mark.parametrize("seed", range(2, 22))
@pytest.mark.parametrize("fault", FAULTS, ids=lambda f: f"{f} {f.rate:%}")
def test_whatever_the_chance(fault: Fault, seed: int) -> None:
    assert_safe(work_with(fault, seconds=30.0, seed=seed))
