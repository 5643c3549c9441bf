"""What the board's telemetry means for the machine's mode."""

from __future__ import annotations

from deltaviz.link.messages import BoardState
from deltaviz.link.session import Phase, Session
from deltaviz.machine.transitions import Event

GREETING_WITHIN = 10.0  # s; a board may be starting, a simulated one is a process of its own
SILENT_AFTER = 1.0  # s without a word: the link is lost


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
        case BoardState.HALTED | BoardState.ARMED:
            if session.moving or session.homing:
                return None
            return Event.RESTS_HOMED if session.homed else Event.RESTS_UNHOMED


def lost(session: Session, now: float) -> str | None:
    """Why the link must be given up, with what to do about it; or None."""
    if session.phase is Phase.FAILED:
        return session.problem
    limit = SILENT_AFTER if session.ready else GREETING_WITHIN
    if session.silence(now) < limit:
        return None
    if session.ready:
        return (
            f"The board has been silent for {SILENT_AFTER:g} s; it brakes by itself when it hears "
            "nothing. Check its cable and power, then connect."
        )
    return (
        f"No board answered within {GREETING_WITHIN:g} s. Check its cable, its power and the "
        "chosen link, then connect."
    )
