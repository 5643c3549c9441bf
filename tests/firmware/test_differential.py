"""The firmware's core and the simulated board answer alike, byte for byte, whatever comes.

A longer search: `python -m pytest tests/firmware/test_differential.py -m long`.
"""

from __future__ import annotations

import os
import subprocess
import sys
from typing import Any

import pytest
from hypothesis import HealthCheck, Phase, given, settings

from deltaviz.link.board import brake as brake_module
from deltaviz.link.board import control as control_module
from deltaviz.link.board import drive as drive_module
from deltaviz.link.board import turn
from deltaviz.link.board.lease import Lease
from deltaviz.link.board.paths import Ramp
from deltaviz.link.messages import BoardState, StopCause
from tests.firmware.both_boards import Pair
from tests.firmware.c_board import make
from tests.firmware.scripts import Script, play, scripts, situations

QUIET = [HealthCheck.function_scoped_fixture, HealthCheck.too_slow, HealthCheck.data_too_large]
BOUNDED = settings(deadline=None, derandomize=True, database=None, suppress_health_check=QUIET)
SANITIZED = "FIRMWARE_SANITIZED"


@settings(BOUNDED, max_examples=100)
@given(script=scripts())
def test_both_boards_answer_alike(script: Script) -> None:
    play(script)


def test_under_sanitizers() -> None:
    """The same, with the core watched for what is out of bounds or undefined."""
    if SANITIZED in os.environ:
        return
    make("host-asan")
    runtime = subprocess.run(
        ["gcc", "-print-file-name=libasan.so"], capture_output=True, text=True, check=True
    ).stdout.strip()
    environment = os.environ | {
        "FIRMWARE_HOST": "host-asan",
        SANITIZED: "1",
        "LD_PRELOAD": runtime,
        "ASAN_OPTIONS": "detect_leaks=0",
    }
    command = [
        sys.executable,
        "-m",
        "pytest",
        __file__,
        "-q",
        "-k",
        "alike or each_way",
        "-p",
        "no:xdist",
    ]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert f"{1 + len(situations())} passed" in done.stdout


@pytest.mark.long
@pytest.mark.timeout(3600)
@settings(BOUNDED, derandomize=False, max_examples=5000)
@given(script=scripts(most=60))
def test_both_boards_answer_alike_for_long(script: Script) -> None:
    play(script)


@pytest.mark.parametrize("script", situations(), ids=lambda s: f"{s.steps[0][0]}-{s.configuration}")
def test_each_way_to_end_a_motion(script: Script) -> None:
    play(script)


def test_these_are_all_the_ways(monkeypatch: pytest.MonkeyPatch) -> None:
    """And every state is passed."""
    states: set[BoardState] = set()
    causes: set[StopCause] = set()
    compared = Pair.compare

    def watch(pair: Pair) -> None:
        compared(pair)
        states.add(pair.simulated.state)
        causes.add(pair.simulated.cause)

    monkeypatch.setattr(Pair, "compare", watch)
    for script in situations():
        play(script)
    assert states == set(BoardState)
    assert causes == set(StopCause)


def a_longer_brake(patch: pytest.MonkeyPatch) -> None:
    class Longer(Ramp):
        def __init__(self, *, ticks: int, **rest: Any) -> None:
            super().__init__(ticks=ticks + 1, **rest)

    patch.setattr(brake_module, "Ramp", Longer)


def a_longer_lease(patch: pytest.MonkeyPatch) -> None:
    real = Lease.remaining

    def longer(lease: Lease, tick: int) -> int | None:
        left = real(lease, tick)
        return None if left is None else left + 1

    patch.setattr(Lease, "remaining", longer)


def an_old_epoch(patch: pytest.MonkeyPatch) -> None:
    real = turn.since16
    patch.setattr(turn, "since16", lambda number, origin: real(number, origin) or 1)


def no_brake_after_an_underrun(patch: pytest.MonkeyPatch) -> None:
    patch.setattr(drive_module.Drive, "brake", lambda drive, tick: setattr(drive, "path", None))


def a_switch_that_is_no_limit(patch: pytest.MonkeyPatch) -> None:
    patch.setattr(control_module.Control, "_fail", lambda *_: None)


PLANTED = [
    a_longer_brake,
    a_longer_lease,
    an_old_epoch,
    no_brake_after_an_underrun,
    a_switch_that_is_no_limit,
]


@pytest.mark.parametrize("plant", PLANTED, ids=lambda plant: plant.__name__)
def test_a_planted_difference_is_found(monkeypatch: pytest.MonkeyPatch, plant: Any) -> None:
    """By scripts as in the test above."""
    plant(monkeypatch)

    @settings(BOUNDED, max_examples=300, phases=[Phase.generate])
    @given(script=scripts())
    def search(script: Script) -> None:
        play(script)

    with pytest.raises(AssertionError):
        search()
