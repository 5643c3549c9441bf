"""Every time that the host's end of a link goes by, in one place; the board's are in `rules`.

Seconds by the host's clock, except where it says board time. Those after which a session fails
are seconds of listening.
"""

from __future__ import annotations

from typing import Final, NamedTuple

from deltaviz.link.rules import LEASE_MS
from deltaviz.link.wire.description import load_description

COMMAND_REPEAT: Final = load_description().command_repeat_ms / 1000
HELLO_REPEAT: Final = 0.5  # a board that is still starting misses the first
STRANGE_AFTER: Final = 2.0  # of bytes that no board sends
GREETING_WITHIN: Final = 10.0  # a simulated or emulated board is a process that has to start
ANSWER_WITHIN: Final = 1.0  # board time, for what the board answers at once
SILENT_AFTER: Final = 1.0
LISTENS_FOR: Final = 0.1  # at most, in one turn of the control loop, which takes 20 ms or less
STALE: Final = LEASE_MS / 1000  # telemetry older than this can begin and continue no motion
STOP_REPEAT: Final = 0.010
KEEP_PERIOD: Final = 0.025  # well within the board's lease
SEGMENT_REPEAT: Final = 0.025  # board time: a round trip, and a link's hiccup
GAP_REPEAT: Final = 0.008  # board time: the board has said so, but may not have met the repetition
NOT_BEGUN: Final = 0.1  # board time: well before the board would think it too late to begin
HOME_NOT_BEGUN: Final = 0.2  # board time: a few repetitions, while who pressed still looks at it
LOSSY_FOR: Final = 0.2  # board time: more than the longest horizon
NEVER_ARMED: Final = 0.1  # board time after a stop: an Arm before it has come by then or was lost


class Timeout(NamedTuple):
    seconds: float
    after: str
    then: str


TIMEOUTS: Final = (
    Timeout(COMMAND_REPEAT, "a command that is not answered", "its frame is sent again, unchanged"),
    Timeout(HELLO_REPEAT, "Hello, while greeting", "a new Hello is sent"),
    Timeout(STRANGE_AFTER, "opening, if only bytes came that no board sends", "the session fails"),
    Timeout(GREETING_WITHIN, "opening without a HelloReply", "the session fails"),
    Timeout(ANSWER_WITHIN, "a command but Home, by the board's clock", "the session fails"),
    Timeout(SILENT_AFTER, "HelloReply, Configured or the last telemetry, without another",
            "the session fails"),
    Timeout(STALE, "the last telemetry", "no motion is begun, and none continued until the next"),
    Timeout(STOP_REPEAT, "Stop or EStop, while it is not answered", "it is sent again"),
    Timeout(KEEP_PERIOD, "the last Keep or Segment, while the robot moves", "Keep is sent"),
    Timeout(SEGMENT_REPEAT, "a segment, by the board's clock, that no telemetry says was taken",
            "it and all after it are sent again"),
    Timeout(GAP_REPEAT, "the same, when the board has refused a later one (INDEX)",
            "it and all after it are sent again"),
    Timeout(NOT_BEGUN, "the first segment from rest, by the board's clock, if it is not taken",
            "Stop is sent: it is too late to begin"),
    Timeout(HOME_NOT_BEGUN, "Home, by the board's clock, if no telemetry has shown it homing",
            "Stop is sent: it is too late to begin"),
    Timeout(NEVER_ARMED, "a Stop, by the board's clock",
            "an answer that names the epoch before counts, too: the Arm never came"),
)  # fmt: skip
