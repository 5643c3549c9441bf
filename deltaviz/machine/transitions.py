"""The machine's modes as one table: in which mode which event is taken, and where it leads.

An event that a mode's row does not name is refused when a person asks for it, and ignored when
the board reports it. The diagram in the docs is drawn from this table.
"""

from __future__ import annotations

from collections.abc import Mapping
from enum import StrEnum
from typing import Final

from deltaviz.machine.mode import Mode


class Event(StrEnum):
    # What a person asks for.
    CONNECT = "connect"
    DISCONNECT = "disconnect"
    SELECT_ROBOT = "select robot"
    ENABLE = "enable"
    DISABLE = "disable"
    HOME = "home"
    RESET = "reset"
    JOG = "jog"
    JOG_JOINTS = "jog joints"
    STEP = "step"
    DRAG = "drag"
    FOLLOW = "follow"
    MOVE = "move"
    PAUSE = "pause"
    RESUME = "resume"
    STOP = "stop"
    ESTOP = "e-stop"
    # What the board and the link report.
    RESTS_HOMED = "rests homed"
    RESTS_UNHOMED = "rests unhomed"
    BRAKES = "board brakes"
    OFF = "drivers off"
    FAULTS = "board faults"
    IS_ESTOPPED = "board e-stopped"
    LOST = "link lost"


REPORTED: Final = frozenset(
    {
        Event.RESTS_HOMED,
        Event.RESTS_UNHOMED,
        Event.BRAKES,
        Event.OFF,
        Event.FAULTS,
        Event.IS_ESTOPPED,
        Event.LOST,
    }
)

# Modes in which nothing moves and nothing is under way: here control may change hands.
AT_REST: Final = frozenset(
    {Mode.OFFLINE, Mode.DISABLED, Mode.UNHOMED, Mode.IDLE, Mode.FAULT, Mode.ESTOP}
)
MOVING: Final = frozenset(
    {Mode.HOMING, Mode.JOGGING, Mode.MOVING, Mode.RUNNING, Mode.PAUSED, Mode.STOPPING}
)

_EVERYWHERE = {
    Event.OFF: Mode.DISABLED,
    Event.FAULTS: Mode.FAULT,
    Event.IS_ESTOPPED: Mode.ESTOP,
    Event.LOST: Mode.OFFLINE,
}
_CONNECTED = {**_EVERYWHERE, Event.ESTOP: Mode.ESTOP}
_LINK = {
    Event.CONNECT: Mode.OFFLINE,
    Event.DISCONNECT: Mode.OFFLINE,
    Event.SELECT_ROBOT: Mode.OFFLINE,
}
_UNDER_WAY = {**_CONNECTED, Event.STOP: Mode.STOPPING, Event.BRAKES: Mode.STOPPING}
_RESTS = {Event.RESTS_HOMED: Mode.IDLE, Event.RESTS_UNHOMED: Mode.UNHOMED}

TABLE: Final[Mapping[Mode, Mapping[Event, Mode]]] = {
    Mode.OFFLINE: {
        **_EVERYWHERE,
        **_LINK,
        **_RESTS,
        Event.BRAKES: Mode.STOPPING,
        Event.STOP: Mode.OFFLINE,
        Event.ESTOP: Mode.OFFLINE,
    },
    Mode.DISABLED: {
        **_CONNECTED,
        **_LINK,
        **_RESTS,
        Event.ENABLE: Mode.DISABLED,  # left when the board reports its drivers on
        Event.DISABLE: Mode.DISABLED,
        Event.STOP: Mode.DISABLED,
    },
    Mode.UNHOMED: {
        **_UNDER_WAY,
        **_LINK,
        **_RESTS,
        Event.ENABLE: Mode.UNHOMED,
        Event.DISABLE: Mode.DISABLED,
        Event.HOME: Mode.HOMING,
        Event.JOG_JOINTS: Mode.JOGGING,
    },
    Mode.HOMING: {
        **_UNDER_WAY,
        **_RESTS,
        Event.ENABLE: Mode.HOMING,
    },
    Mode.IDLE: {
        **_UNDER_WAY,
        **_LINK,
        **_RESTS,
        Event.ENABLE: Mode.IDLE,
        Event.DISABLE: Mode.DISABLED,
        Event.HOME: Mode.HOMING,
        Event.JOG: Mode.JOGGING,
        Event.JOG_JOINTS: Mode.JOGGING,
        Event.STEP: Mode.JOGGING,
        Event.DRAG: Mode.JOGGING,
        Event.FOLLOW: Mode.JOGGING,
        Event.MOVE: Mode.MOVING,
    },
    Mode.JOGGING: {
        **_UNDER_WAY,
        **_RESTS,
        Event.ENABLE: Mode.JOGGING,
        Event.JOG: Mode.JOGGING,
        Event.JOG_JOINTS: Mode.JOGGING,
        Event.STEP: Mode.JOGGING,
        Event.DRAG: Mode.JOGGING,
        Event.FOLLOW: Mode.JOGGING,
    },
    Mode.MOVING: {
        **_UNDER_WAY,
        **_RESTS,
        Event.ENABLE: Mode.MOVING,
        Event.PAUSE: Mode.PAUSED,
    },
    Mode.RUNNING: {
        **_UNDER_WAY,
        **_RESTS,
        Event.ENABLE: Mode.RUNNING,
        Event.PAUSE: Mode.PAUSED,
    },
    Mode.PAUSED: {
        **_UNDER_WAY,
        Event.ENABLE: Mode.PAUSED,
        Event.PAUSE: Mode.PAUSED,
        Event.RESUME: Mode.MOVING,
    },
    Mode.STOPPING: {
        **_UNDER_WAY,
        **_RESTS,
        Event.ENABLE: Mode.STOPPING,
    },
    Mode.FAULT: {
        **_CONNECTED,
        **_LINK,
        Event.RESET: Mode.FAULT,  # left when the board reports its drivers off
        Event.STOP: Mode.FAULT,
    },
    Mode.ESTOP: {
        **_CONNECTED,
        **_LINK,
        Event.RESET: Mode.ESTOP,
        Event.STOP: Mode.ESTOP,
    },
}

_BECAUSE: Final[Mapping[Mode, str]] = {
    Mode.OFFLINE: "no board is connected; connect first",
    Mode.DISABLED: "the drivers are off; enable first",
    Mode.UNHOMED: "the robot does not know its pose; home first (or jog single joints, slowly)",
    Mode.HOMING: "the robot is homing; wait, or stop it",
    Mode.IDLE: "nothing is under way",
    Mode.JOGGING: "the robot is being jogged; let go, and it will be free",
    Mode.MOVING: "the robot is moving; wait, or stop it",
    Mode.RUNNING: "a program is running; pause or stop it",
    Mode.PAUSED: "a motion is paused; resume or stop it",
    Mode.STOPPING: "the robot is being stopped; wait until it rests, then press again",
    Mode.FAULT: "the board reports a fault; see to it, then reset",
    Mode.ESTOP: "the e-stop is active; make sure that all is safe, then reset",
}


def after(mode: Mode, event: Event) -> Mode | None:
    """The mode that `event` leads to, or None where it is not taken."""
    return TABLE[mode].get(event)


def refusal(mode: Mode, event: Event) -> str:
    """Why `mode` does not take `event`, as a sentence for a person."""
    if event is Event.RESET:
        return "Nothing to reset: there is no fault and no e-stop."
    if event is Event.RESUME:
        return "Nothing to resume: no motion is paused."
    return f"Cannot {event.value}: {_BECAUSE[mode]}."
