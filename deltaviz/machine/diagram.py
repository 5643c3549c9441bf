"""The machine's modes as a picture, drawn from the table that the controller runs."""

from __future__ import annotations

from deltaviz.link.state_diagram import mermaid as draw
from deltaviz.machine.mode import Mode
from deltaviz.machine.transitions import TABLE


def mermaid() -> str:
    flat = {(mode, event): to for mode, row in TABLE.items() for event, to in row.items()}
    return draw(flat, first=Mode.OFFLINE, anywhere="any mode")
