"""What the surfaces see: one immutable picture of the machine, made by the controller only."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from deltaviz.link.capture.writer import CaptureStatus
from deltaviz.machine.mode import Mode
from deltaviz.motion.held import Held


class LinkPhase(StrEnum):
    CLOSED = "closed"
    OPENING = "opening"
    GREETING = "greeting"  # it is open, and the board has to answer
    READY = "ready"


@dataclass(frozen=True, slots=True)
class LinkStatus:
    """Times are in seconds; None where not known yet."""

    id: str
    phase: LinkPhase
    age: float | None = None  # since the last telemetry
    problem: str | None = None  # what happened and what to do, for a person
    note: str | None = None  # what became of a board that was met again
    board: str | None = None  # its name and the build of its firmware
    round_trip: float | None = None  # of the newest command
    dropped: int = 0  # frames that arrived damaged
    queued: int = 0  # segments that the board has
    queue_places: int = 0
    ahead: float = 0.0  # what these and those under way last

    @property
    def connected(self) -> bool:
        return self.phase is LinkPhase.READY


@dataclass(frozen=True, slots=True)
class Snapshot:
    """Lengths in mm, angles in rad, speeds in mm/s and rad/s; None where unknown, never NaN.

    `xyz` and `theta` are reported: made from the board's counts. `command_*` is where the last
    knot sent ends. `target_*` is what is being followed: the ghost. `margins` has one entry per
    joint: how far the joint is from its nearest limit, 1 in the open, 0 at the limit.
    """

    at: float  # monotonic time of this snapshot, s
    robot: str
    mode: Mode
    homed: bool
    theta: tuple[float, ...] | None
    xyz: tuple[float, ...] | None
    theta_speed: tuple[float, ...] | None
    xyz_speed: tuple[float, ...] | None
    command_theta: tuple[float, ...] | None
    command_xyz: tuple[float, ...] | None
    target_theta: tuple[float, ...] | None
    target_xyz: tuple[float, ...] | None
    margins: tuple[float, ...]
    held_by: tuple[Held, ...]
    link: LinkStatus
    holder: str | None  # the client in control
    stop_reason: str | None
    fault: str | None
    override: float
    next_step: str | None  # the one thing to do next, for a person
    board_time: float | None  # s
    underruns: int
    counts: tuple[int, ...] | None
    capture: CaptureStatus | None = None
