"""How a session goes, as two tables: how far the conversation has come, and what motion it holds.

What a table does not name does not happen: of what the board says, it is ignored; a program that
asks for it is wrong. The diagrams in docs/protocol.md are drawn from these tables.
"""

from __future__ import annotations

from collections.abc import Mapping
from enum import StrEnum
from typing import Final


class Phase(StrEnum):
    GREETING = "greeting"  # Hello is repeated until the board answers
    CONFIGURING = "configuring"  # the board fits and is told about its robot
    CONFIGURED = "configured"  # it has taken that, and its next telemetry is waited for
    READY = "ready"
    FAILED = "failed"  # for good: only a new session may try again


class News(StrEnum):
    FITS = "HelloReply that fits"
    TAKEN = "Configured as given"
    REPORTED = "Telemetry, configured"
    UNFIT = "HelloReply that does not fit"
    STRANGE = "no board's bytes for 2 s"
    REFUSED = "Configure refused"
    DIFFERS = "Configured otherwise"
    UNANSWERED = "no answer in time"
    SILENT = "silence"
    RESTARTED = "Telemetry, not configured"


PHASES: Final[Mapping[tuple[Phase, News], Phase]] = {
    (Phase.GREETING, News.FITS): Phase.CONFIGURING,
    (Phase.GREETING, News.UNFIT): Phase.FAILED,
    (Phase.GREETING, News.STRANGE): Phase.FAILED,
    (Phase.GREETING, News.SILENT): Phase.FAILED,
    (Phase.CONFIGURING, News.TAKEN): Phase.CONFIGURED,
    (Phase.CONFIGURING, News.REFUSED): Phase.FAILED,
    (Phase.CONFIGURING, News.DIFFERS): Phase.FAILED,
    (Phase.CONFIGURING, News.UNANSWERED): Phase.FAILED,
    (Phase.CONFIGURED, News.REPORTED): Phase.READY,
    (Phase.CONFIGURED, News.UNANSWERED): Phase.FAILED,
    (Phase.READY, News.UNANSWERED): Phase.FAILED,
    (Phase.READY, News.SILENT): Phase.FAILED,
    (Phase.READY, News.RESTARTED): Phase.FAILED,
}


class Motion(StrEnum):
    NONE = "none"
    EPOCH = "epoch"  # armed, or on its way to be: segments may be sent
    HOMING = "homing"
    STOPPING = "stopping"  # Stop is repeated until it is answered
    ESTOPPING = "e-stopping"  # EStop is repeated until it is reported


class Turn(StrEnum):
    # What the host is asked for.
    BEGIN = "begin"
    HOME = "home"
    DISABLE = "disable"
    STOP = "stop"
    ESTOP = "e-stop"
    # What the board says.
    REFUSED = "Arm or Home refused"
    HOMED = "Done(home)"
    ENDED = "homing has ended"
    STOPPED = "Stopped"
    FAULTED = "FAULT reported"
    ESTOPPED = "ESTOP reported"


MOTIONS: Final[Mapping[tuple[Motion, Turn], Motion]] = {
    (Motion.NONE, Turn.BEGIN): Motion.EPOCH,
    (Motion.NONE, Turn.HOME): Motion.HOMING,
    (Motion.NONE, Turn.DISABLE): Motion.NONE,
    (Motion.NONE, Turn.STOPPED): Motion.NONE,
    (Motion.EPOCH, Turn.BEGIN): Motion.EPOCH,
    (Motion.EPOCH, Turn.HOME): Motion.HOMING,
    (Motion.EPOCH, Turn.DISABLE): Motion.NONE,
    (Motion.EPOCH, Turn.REFUSED): Motion.NONE,
    (Motion.EPOCH, Turn.STOPPED): Motion.NONE,
    (Motion.EPOCH, Turn.FAULTED): Motion.NONE,
    (Motion.EPOCH, Turn.ESTOPPED): Motion.NONE,
    (Motion.HOMING, Turn.HOMED): Motion.NONE,
    (Motion.HOMING, Turn.DISABLE): Motion.NONE,
    (Motion.HOMING, Turn.REFUSED): Motion.NONE,
    (Motion.HOMING, Turn.ENDED): Motion.NONE,
    (Motion.HOMING, Turn.FAULTED): Motion.NONE,
    (Motion.HOMING, Turn.ESTOPPED): Motion.NONE,
    (Motion.STOPPING, Turn.STOPPED): Motion.NONE,
    (Motion.STOPPING, Turn.DISABLE): Motion.STOPPING,
    (Motion.STOPPING, Turn.FAULTED): Motion.NONE,
    (Motion.STOPPING, Turn.ESTOPPED): Motion.NONE,
    (Motion.ESTOPPING, Turn.DISABLE): Motion.ESTOPPING,
    (Motion.ESTOPPING, Turn.STOP): Motion.ESTOPPING,
    (Motion.ESTOPPING, Turn.ESTOPPED): Motion.NONE,
    **{(motion, Turn.STOP): Motion.STOPPING for motion in Motion if motion is not Motion.ESTOPPING},
    **{(motion, Turn.ESTOP): Motion.ESTOPPING for motion in Motion},
}
