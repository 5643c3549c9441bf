"""The modes, as DESIGN's "Life" tells them, against the table."""

from __future__ import annotations

import re

import pytest

from deltaviz.machine.diagram import mermaid
from deltaviz.machine.mode import Mode
from deltaviz.machine.transitions import AT_REST, MOVING, REPORTED, TABLE, Event, after, refusal

ALWAYS = {"stop", "e-stop"}
LINK = {"connect", "disconnect", "select robot"}
MOTION = {"jog", "jog joints", "step", "drag", "follow"}
TAKEN = {
    "offline": LINK | ALWAYS,
    "disabled": LINK | ALWAYS | {"enable", "disable"},
    "unhomed": LINK | ALWAYS | {"enable", "disable", "home", "jog joints"},
    "homing": ALWAYS | {"enable"},
    "idle": LINK | ALWAYS | MOTION | {"enable", "disable", "home", "move"},
    "jogging": ALWAYS | MOTION | {"enable"},
    "moving": ALWAYS | {"enable", "pause"},
    "running": ALWAYS | {"enable", "pause"},
    "paused": ALWAYS | {"enable", "pause", "resume"},
    "stopping": ALWAYS | {"enable"},
    "fault": LINK | ALWAYS | {"reset"},
    "estop": LINK | ALWAYS | {"reset"},
}
PEOPLES = [event for event in Event if event not in REPORTED]


@pytest.mark.parametrize("mode", Mode)
@pytest.mark.parametrize("event", PEOPLES)
def test_each_mode_takes_what_it_should_and_nothing_else(mode: Mode, event: Event) -> None:
    assert (after(mode, event) is not None) == (event.value in TAKEN[mode.value])


@pytest.mark.parametrize("mode", Mode)
def test_stop_leads_to_stopping_wherever_something_could_move(mode: Mode) -> None:
    still = {Mode.OFFLINE, Mode.DISABLED, Mode.FAULT, Mode.ESTOP}
    assert after(mode, Event.STOP) is (mode if mode in still else Mode.STOPPING)


@pytest.mark.parametrize("mode", sorted(set(Mode) - {Mode.OFFLINE}))
def test_estop_leads_to_estop_from_everywhere(mode: Mode) -> None:
    assert after(mode, Event.ESTOP) is Mode.ESTOP


@pytest.mark.parametrize("mode", Mode)
def test_what_the_board_reports_wins_in_every_mode(mode: Mode) -> None:
    assert after(mode, Event.LOST) is Mode.OFFLINE
    assert after(mode, Event.FAULTS) is Mode.FAULT
    assert after(mode, Event.IS_ESTOPPED) is Mode.ESTOP
    assert after(mode, Event.OFF) is Mode.DISABLED


@pytest.mark.parametrize("mode", sorted(MOVING - {Mode.STOPPING}))
def test_nothing_leads_from_motion_to_motion_but_the_persons_own_wish(mode: Mode) -> None:
    for event in REPORTED:
        target = after(mode, event)
        assert target is None or target in AT_REST | {Mode.STOPPING}


def test_stopping_leads_to_rest_only() -> None:
    for target in TABLE[Mode.STOPPING].values():
        assert target in AT_REST | {Mode.STOPPING}


def test_every_mode_is_at_rest_or_moving() -> None:
    assert set(Mode) == AT_REST | MOVING
    assert not AT_REST & MOVING


@pytest.mark.parametrize("mode", Mode)
def test_every_refusal_is_a_sentence(mode: Mode) -> None:
    for event in PEOPLES:
        if after(mode, event) is None:
            assert re.fullmatch(r"[A-Z].{10,}\.", refusal(mode, event))


def test_the_picture_shows_every_change_of_mode_and_no_other() -> None:
    drawn: set[tuple[str, str, str]] = set()
    for line in mermaid().splitlines():
        match = re.fullmatch(r"    (\w+) --> (\w+): (.+)", line)
        if match is None:
            continue
        for label in match[3].split(" / "):
            exception = re.search(r" \(not (\w+)\)$", label)
            event = label[: exception.start()] if exception else label
            sources = [match[1]] if match[1] != "any_mode" else [m.value for m in Mode]
            drawn |= {
                (source, event, match[2])
                for source in sources
                if source != match[2] and not (exception and source == exception[1])
            }
    table = {
        (mode.value, event.value, target.value)
        for mode, row in TABLE.items()
        for event, target in row.items()
        if mode is not target
    }
    missing_by_design = {
        change for change in drawn - table if Event(change[1]) not in TABLE[Mode(change[0])]
    }
    assert drawn - missing_by_design == table
    assert not missing_by_design
