"""The firmware's table of states is the simulated board's, and its events are told alike."""

from __future__ import annotations

import ctypes as c
import re

from deltaviz.link.board.states import POWERED, TRANSITIONS, BoardEvent
from deltaviz.link.messages import BoardState
from tests.firmware.c_board import FIRMWARE, library


def events_of_c() -> list[str]:
    """In the order of enum dv_event, as the simulated board names them."""
    text = (FIRMWARE / "core" / "states.h").read_text()
    return re.findall(r"^    DV_EVENT_(\w+),", text, re.MULTILINE)


def test_the_tables_are_the_same():
    names = events_of_c()
    assert names == [event.name for event in BoardEvent]
    for state in BoardState:
        for number, event in enumerate(BoardEvent):
            after = library().dv_state_after(c.c_uint8(state), c.c_int(number))
            expected = TRANSITIONS.get((state, event))
            assert (None if after < 0 else BoardState(after)) is expected, (state, event)


def test_the_drivers_are_on_in_the_same_states():
    library().dv_state_is_powered.restype = c.c_bool
    powered = {s for s in BoardState if library().dv_state_is_powered(c.c_uint8(s))}
    assert powered == POWERED
