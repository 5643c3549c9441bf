"""The states of a board and what leads from one to another, as data.

What is not in the table does not happen: a command is refused with STATE.
"""

from __future__ import annotations

from enum import StrEnum

from deltaviz.link.messages import BoardState


class BoardEvent(StrEnum):
    ENABLE = "enable"
    DISABLE = "disable, at rest"
    ARM = "arm, at rest"
    HALT = "stop, at rest"
    BRAKE = "stop, underrun, end of the lease, bad segment or limit switch, while moving"
    HOME = "home, at rest"
    HOMED = "homed, at the ready pose"
    RESTED = "at rest"
    RESTED_DISABLE = "at rest, was disabled meanwhile"
    RESTED_FAULT = "at rest, with a fault"
    ESTOP = "e-stop"
    RESET = "reset"


# The drivers are on.
POWERED = frozenset(BoardState) - {BoardState.DISABLED, BoardState.ESTOP}

TRANSITIONS: dict[tuple[BoardState, BoardEvent], BoardState] = {
    (BoardState.DISABLED, BoardEvent.ENABLE): BoardState.HALTED,
    (BoardState.DISABLED, BoardEvent.DISABLE): BoardState.DISABLED,
    (BoardState.HALTED, BoardEvent.ENABLE): BoardState.HALTED,
    (BoardState.HALTED, BoardEvent.DISABLE): BoardState.DISABLED,
    (BoardState.HALTED, BoardEvent.ARM): BoardState.ARMED,
    (BoardState.HALTED, BoardEvent.HOME): BoardState.HOMING,
    (BoardState.ARMED, BoardEvent.ENABLE): BoardState.ARMED,
    (BoardState.ARMED, BoardEvent.DISABLE): BoardState.DISABLED,
    (BoardState.ARMED, BoardEvent.ARM): BoardState.ARMED,
    (BoardState.ARMED, BoardEvent.HALT): BoardState.HALTED,
    (BoardState.ARMED, BoardEvent.HOME): BoardState.HOMING,
    (BoardState.ARMED, BoardEvent.BRAKE): BoardState.BRAKING,
    (BoardState.BRAKING, BoardEvent.RESTED): BoardState.HALTED,
    (BoardState.BRAKING, BoardEvent.RESTED_DISABLE): BoardState.DISABLED,
    (BoardState.BRAKING, BoardEvent.RESTED_FAULT): BoardState.FAULT,
    (BoardState.HOMING, BoardEvent.HOMED): BoardState.HALTED,
    (BoardState.HOMING, BoardEvent.BRAKE): BoardState.BRAKING,
    (BoardState.ESTOP, BoardEvent.RESET): BoardState.DISABLED,
    (BoardState.FAULT, BoardEvent.RESET): BoardState.DISABLED,
    **{(state, BoardEvent.ESTOP): BoardState.ESTOP for state in BoardState},
}
