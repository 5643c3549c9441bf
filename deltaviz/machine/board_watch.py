"""What the board's telemetry means for the machine's mode."""

from __future__ import annotations

from deltaviz.link.messages import BoardState
from deltaviz.link.session import Session
from deltaviz.machine.transitions import Event


def reported(session: Session) -> Event | None:
    """The event that the newest telemetry stands for; None while it moves as asked."""
    telemetry = session.telemetry
    if telemetry is None:
        return None
    match telemetry.state:
        case BoardState.DISABLED:
            return Event.OFF
        case BoardState.ESTOP:
            return Event.IS_ESTOPPED
        case BoardState.FAULT:
            return Event.FAULTS
        case BoardState.BRAKING:
            return Event.BRAKES
        case BoardState.HOMING:
            return None if session.homing else Event.BRAKES
        case BoardState.HALTED if session.flight is not None and (
            telemetry.epoch == session.flight.epoch
        ):
            return Event.BRAKES  # it has, and what it said of it was lost
        case BoardState.HALTED | BoardState.ARMED:
            if session.moving or session.homing:
                return None
            return Event.RESTS_HOMED if session.homed else Event.RESTS_UNHOMED
