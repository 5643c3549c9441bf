"""What a surface may ask of the controller. Values here are already checked at the edge:
finite, of the robot's number of joints or axes, in mm, rad and seconds.

`client` is the session that asks. `at` is the monotonic time (s) at which this process
received the message; the system's monotonic clock is the same in every process.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class JogFrame(StrEnum):
    BASE = "base"  # mm/s along the base's axes
    JOINTS = "joints"  # rad/s of each joint


@dataclass(frozen=True, slots=True)
class Enable:
    client: str


@dataclass(frozen=True, slots=True)
class Disable:
    client: str


@dataclass(frozen=True, slots=True)
class Home:
    client: str


@dataclass(frozen=True, slots=True)
class Reset:
    client: str


@dataclass(frozen=True, slots=True)
class Pause:
    client: str


@dataclass(frozen=True, slots=True)
class Resume:
    client: str


@dataclass(frozen=True, slots=True)
class Stop:
    """A controlled stop. Anyone's; never refused."""

    client: str
    reason: str


@dataclass(frozen=True, slots=True)
class EStop:
    """Drivers off. Anyone's; never refused."""

    client: str
    reason: str


@dataclass(frozen=True, slots=True)
class MoveToPoint:
    """Straight to a tool tip position (mm), or refused before anything moves.

    `tool` is the angle (rad) to which a tool that turns turns on the way; None: as it stands.
    """

    client: str
    xyz: tuple[float, ...]
    speed: float
    tool: float | None = None


@dataclass(frozen=True, slots=True)
class MoveToAngles:
    client: str
    theta: tuple[float, ...]
    speed: float


@dataclass(frozen=True, slots=True)
class StepPoint:
    """One relative step of the tool tip (mm). While a step runs, more steps add to its target."""

    client: str
    xyz: tuple[float, ...]
    speed: float = 1.0


@dataclass(frozen=True, slots=True)
class StepAngles:
    client: str
    theta: tuple[float, ...]
    speed: float = 1.0


@dataclass(frozen=True, slots=True)
class JogStart:
    """A press. `id` names this press; an ended id never lives again."""

    client: str
    id: str
    frame: JogFrame
    velocity: tuple[float, ...]
    at: float


@dataclass(frozen=True, slots=True)
class JogBeat:
    """The sign of life of a held jog; `sent_ms` is the page's own clock."""

    client: str
    id: str
    seq: int
    sent_ms: float
    velocity: tuple[float, ...]
    at: float
    clock: str = ""  # names the page whose clock it is, when a session has several


@dataclass(frozen=True, slots=True)
class JogEnd:
    client: str
    id: str


@dataclass(frozen=True, slots=True)
class DragStart:
    """The handle in the scene was grabbed; the drag lives while `DragAlive` comes."""

    client: str
    at: float


@dataclass(frozen=True, slots=True)
class DragTo:
    """A target to be followed (mm), tool tip."""

    client: str
    xyz: tuple[float, ...]
    at: float


@dataclass(frozen=True, slots=True)
class DragAlive:
    """From the console, while the pointer is down in the scene's frame."""

    client: str
    seq: int
    sent_ms: float
    at: float
    clock: str = ""  # as in JogBeat


@dataclass(frozen=True, slots=True)
class DragEnd:
    """The handle was let go: the last target is still reached."""

    client: str


@dataclass(frozen=True, slots=True)
class FollowPoint:
    """A slider's target (mm): followed from where the robot is, sliding along its limits."""

    client: str
    xyz: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class FollowAngles:
    client: str
    theta: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class SetOverride:
    """Feed override, 0 to 1.5."""

    client: str
    value: float


@dataclass(frozen=True, slots=True)
class RequestControl:
    client: str


@dataclass(frozen=True, slots=True)
class ReleaseControl:
    client: str


@dataclass(frozen=True, slots=True)
class ClientHere:
    """A session's first socket opened. Whoever never says this (a program over HTTP) holds
    control for one motion only; a page keeps it until it releases it or is gone.
    """

    client: str


@dataclass(frozen=True, slots=True)
class ClientGone:
    """A session's last socket closed: what it held alive stops, what it controlled is free."""

    client: str


@dataclass(frozen=True, slots=True)
class Connect:
    """`link` is an id from the list of links, never a URL."""

    client: str
    link: str


@dataclass(frozen=True, slots=True)
class Disconnect:
    client: str


@dataclass(frozen=True, slots=True)
class SelectRobot:
    """`robot` is the id of a preset or of the file given at the start. Only at rest."""

    client: str
    robot: str


Intent = (
    Enable | Disable | Home | Reset | Pause | Resume | Stop | EStop
    | MoveToPoint | MoveToAngles | StepPoint | StepAngles
    | JogStart | JogBeat | JogEnd
    | DragStart | DragTo | DragAlive | DragEnd
    | FollowPoint | FollowAngles
    | SetOverride | RequestControl | ReleaseControl | ClientHere | ClientGone
    | Connect | Disconnect | SelectRobot
)  # fmt: skip


class RefusalKind(StrEnum):
    MODE = "mode"  # not in this mode: 409
    CONTROL = "control"  # another holds control: 409
    VALUE = "value"  # out of reach or beyond a limit: 422


@dataclass(frozen=True, slots=True)
class Accepted:
    """The intent was taken; the snapshots show what comes of it."""


@dataclass(frozen=True, slots=True)
class Refused:
    """Nothing moved. `detail` tells a person what was wrong and what would be right."""

    kind: RefusalKind
    detail: str


Answer = Accepted | Refused
