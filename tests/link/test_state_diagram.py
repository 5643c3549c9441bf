"""A table drawn: every change is there once, what all states share is drawn from anywhere."""

from __future__ import annotations

from enum import IntEnum, StrEnum

from deltaviz.link.state_diagram import mermaid


class Light(StrEnum):
    OFF = "off"
    LOW = "half-on"
    HIGH = "on"


class Press(StrEnum):
    UP = "up"
    DOWN = "down"
    CUT = "fuse"


TABLE = {
    (Light.OFF, Press.UP): Light.LOW,
    (Light.LOW, Press.UP): Light.HIGH,
    (Light.HIGH, Press.UP): Light.HIGH,
    (Light.LOW, Press.DOWN): Light.OFF,
    (Light.LOW, Press.CUT): Light.OFF,
    (Light.HIGH, Press.CUT): Light.OFF,
}


def test_a_small_table() -> None:
    assert mermaid(TABLE, first=Light.OFF, anywhere="any light").splitlines() == [
        "stateDiagram-v2",
        '    state "any light" as any_light',
        '    state "half-on" as half_on',
        "    [*] --> off",
        "    any_light --> off: down (not on) / fuse",
        "    off --> half_on: up",
        "    half_on --> on: up",
    ]


def test_numbers_go_by_their_names() -> None:
    class State(IntEnum):
        ONE = 1
        TWO = 2
        THREE = 3
        FOUR = 4

    table = {(State.ONE, Press.UP): State.TWO, (State.TWO, Press.UP): State.FOUR}
    assert mermaid(table, first=State.ONE, anywhere="any").splitlines() == [
        "stateDiagram-v2",
        "    [*] --> ONE",
        "    ONE --> TWO: up",
        "    TWO --> FOUR: up",
    ]
