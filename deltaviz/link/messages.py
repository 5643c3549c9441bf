"""Every message between host and board, as values. The bytes come with the codec.

Ticks are the board's step ticks and wrap at 2^32. Positions are in 2^-10 microsteps, velocities
in 2^-16 microsteps per millisecond, counts in microsteps; each has one entry per joint.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum, IntFlag


class BoardState(IntEnum):
    DISABLED = 0  # drivers off
    HALTED = 1  # at rest, segments refused until ARM
    ARMED = 2  # an epoch is open: segments run
    BRAKING = 3
    HOMING = 4
    ESTOP = 5
    FAULT = 6


class StopCause(IntEnum):
    """Why the board halted. The first cause wins until the next ARM."""

    NONE = 0
    HOST_STOP = 1
    UNDERRUN = 2
    LEASE = 3
    BAD_SEGMENT = 4
    LIMIT_SWITCH = 5
    ESTOP = 6
    DISABLED = 7
    HOMED = 8
    HOMING_FAILED = 9
    BOOT = 10


class Fault(IntEnum):
    NONE = 0
    LIMIT_SWITCH = 1
    HOMING_NO_SWITCH = 2
    HOMING_SWITCH_STUCK = 3
    ESTOP_INPUT = 4
    CONFIGURATION = 5


class Refusal(IntEnum):
    """Why the board refused a command."""

    STATE = 1
    EPOCH = 2
    COUNTS = 3
    MOVING = 4
    INDEX = 5
    TIME = 6
    QUEUE_FULL = 7
    JOINT_LIMIT = 8
    VELOCITY = 9
    ACCELERATION = 10
    BRAKE = 11
    WORKSPACE = 12
    CONFIGURATION = 13
    VERSION = 14
    UNHOMED_SPEED = 15


class Inputs(IntFlag):
    NONE = 0
    ESTOP = 1
    SWITCH_0 = 1 << 4
    SWITCH_1 = 1 << 5
    SWITCH_2 = 1 << 6
    SWITCH_3 = 1 << 7


class TelemetryFlags(IntFlag):
    NONE = 0
    HOMED = 1
    MOVING = 2
    LEASE_ALIVE = 4
    CONFIGURED = 8


# Host to board.


@dataclass(frozen=True, slots=True)
class Hello:
    version: int


@dataclass(frozen=True, slots=True)
class Configure:
    """What the board must know to guard itself. Angles in rad, lengths in mm.

    The board answers with its hash of these values; the host compares it with its own.
    """

    kind: str
    geometry: tuple[tuple[str, tuple[float, ...]], ...]
    tool_offset: tuple[float, ...]
    joint_min: tuple[float, ...]
    joint_max: tuple[float, ...]
    workspace_z: tuple[float, float] | None
    workspace_radius: float | None
    velocity: tuple[float, ...]
    acceleration: tuple[float, ...]
    unhomed_velocity: tuple[float, ...]
    microsteps_per_rad: tuple[float, ...]
    inverted: tuple[bool, ...]
    homing_direction: int  # +1 towards positive angles, -1 towards negative
    homing_switch: tuple[float, ...]
    homing_fast: float
    homing_slow: float
    homing_backoff: float
    homing_max_travel: float
    homing_together: bool
    ready: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Enable:
    on: bool


@dataclass(frozen=True, slots=True)
class Home:
    pass


@dataclass(frozen=True, slots=True)
class Arm:
    """Opens an epoch. Accepted only at rest, with an epoch unused since boot and true counts."""

    epoch: int
    t_start: int
    counts: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Segment:
    """The cubic from the last knot to (p, v), which it reaches at `t_end`."""

    epoch: int
    index: int
    t_end: int
    seen: int
    p: tuple[int, ...]
    v: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Keep:
    """Extends the board's lease: `seen` is the newest telemetry tick that the host had."""

    seen: int


@dataclass(frozen=True, slots=True)
class Stop:
    pass


@dataclass(frozen=True, slots=True)
class EStop:
    pass


@dataclass(frozen=True, slots=True)
class Reset:
    """Leaves ESTOP or FAULT for DISABLED."""


@dataclass(frozen=True, slots=True)
class Tool:
    on: bool
    servo_angle: float


# Board to host.


@dataclass(frozen=True, slots=True)
class HelloReply:
    version: int
    board: str
    build: str
    joints: int
    tick_hz: int
    queue_places: int
    boot: int  # names this power-up
    last_epoch: int
    homed: bool
    configuration: int  # hash, 0 when unconfigured
    last_stop: StopCause


@dataclass(frozen=True, slots=True)
class Configured:
    configuration: int


@dataclass(frozen=True, slots=True)
class Refused:
    """A command that was not carried out: which, and why."""

    command: str
    reason: Refusal
    joint: int | None = None


@dataclass(frozen=True, slots=True)
class Done:
    """A command that was carried out."""

    command: str


@dataclass(frozen=True, slots=True)
class Telemetry:
    now: int
    state: BoardState
    fault: Fault
    epoch: int
    last_index: int
    t_queue_end: int
    free: int
    inputs: Inputs
    flags: TelemetryFlags
    counts: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Stopped:
    """At rest after a stop of whatever cause; repeated in answer to every STOP."""

    epoch: int
    cause: StopCause
    now: int
    counts: tuple[int, ...]


HostMessage = (
    Hello | Configure | Enable | Home | Arm | Segment | Keep | Stop | EStop | Reset | Tool
)
BoardMessage = HelloReply | Configured | Refused | Done | Telemetry | Stopped
