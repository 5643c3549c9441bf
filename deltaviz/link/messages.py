"""Every message between host and board, as values. As bytes: wire/protocol.toml.

Ticks are the board's step ticks and wrap at 2^32; epochs and indices wrap at 2^16. Positions are
in 2^-10 microsteps, velocities in 2^-16 microsteps per millisecond, counts in microsteps; each
has one entry per joint. A count is the whole number nearest to the position. Once homed, joint
angle = count / microsteps_per_rad; before that, counts begin at 0 where the board was switched on.

Board time is cut into pieces of 1 ms, counted from power-up. Where one begins, at its boundary, the
board looks at its inputs, judges the lease, notices rest, and plans the piece after it: a straight
line in time to where the path leads at that piece's end. So what moves is planned 1 to 2 ms ahead,
and every brake but that of an underrun begins where the plan ends; state and cause change at once.
EStop cuts the present piece, too.

What the board answers: `Refused(command, reason)` or `Done(command)` to Enable, Arm, Reset, Tool
and Home (Done("home") comes when it stands homed at the ready pose); `Configured` to Configure;
`HelloReply` to Hello; `Stopped` to Stop. A segment is answered only when refused, a Keep never.
`command` is the message's class name in lower case. These five are the board's events, too: it says
Stopped and Refused also where nobody waits for them, and there is no other message of events.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum, IntFlag

PROTOCOL_VERSION = 1


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
    LATE = 6  # the board did not plan in time: a piece began that was not planned


class Refusal(IntEnum):
    """Why the board refused a command. CONFIGURATION: values that make no sense, or a command
    that needs a configuration which the board does not have.
    """

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
    LEASE = 16  # `seen` is too old for a motion to begin
    INPUT = 17  # the e-stop input is still active
    KIND = 18  # a Cartesian segment, or a joint one, where only the other kind is possible


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


class RobotKind(IntEnum):
    """Which kinematics the board has: it guards the workspace by them, and turns Cartesian segments
    into motions of the joints.

    A rotary delta has three joints, or a fourth that turns its tool: the geometry speaks of the
    first three. A five-bar has two, the left one first, in the plane of x and z: half of its base
    and of its platform stand in the places of base and effector radius, and the azimuths are 0.
    """

    JOINTS_ONLY = 0
    ROTARY_DELTA = 1
    FIVE_BAR = 2


class Options(IntFlag):
    NONE = 0
    HOMING_TOGETHER = 1
    SWITCH_ACTIVE_OPEN = 2
    ENABLE_ACTIVE_HIGH = 4


# Host to board.


@dataclass(frozen=True, slots=True)
class Hello:
    """Begins a session: what still moves brakes (HOST_STOP), an open epoch is closed.

    Counts and homing stay, as the board never lost them. After a version that the board does not
    speak, all but Hello, Stop and EStop are refused (VERSION).
    """

    version: int


@dataclass(frozen=True, slots=True)
class Configure:
    """What the board must know to guard itself, in its own units, so that every board works with
    the same integers. Microsteps, and the units of knots: the reals are single precision.

    Arrays have one entry per joint, 1 to 4; the geometry is all zeros for a robot that the board
    guards by its joint limits alone, and for a joint that is no arm's. The board answers with the
    CRC-32 of these values as bytes; the host compares it with its own. Taken while DISABLED only;
    the same values again are answered in every state.

    Refused (CONFIGURATION): what is not finite, but for the bounds of the workspace; what has to be
    positive and is not; a ready pose outside the joint limits or out of reach; more than a step
    every other tick, less 0.2 % for the slack of speeds; homing faster than the joint's velocity,
    further than 2^20 microsteps or in more than ten minutes; a brake from top velocity that takes
    more than a second. A board of fewer than 20 000 ticks a second, whose clock did not come up,
    refuses them all.
    """

    kind: RobotKind
    options: Options
    homing_direction: int  # +1 towards positive angles, -1 towards negative
    joint_min: tuple[int, ...]  # 2^-10 microsteps
    joint_max: tuple[int, ...]
    velocity: tuple[int, ...]  # 2^-16 microsteps/ms
    acceleration: tuple[int, ...]  # 2^-24 microsteps/ms²
    unhomed_velocity: tuple[int, ...]
    microsteps_per_rad: tuple[float, ...]
    inverted: tuple[bool, ...]
    homing_switch: tuple[int, ...]  # microsteps
    homing_fast: tuple[int, ...]  # 2^-16 microsteps/ms
    homing_slow: tuple[int, ...]
    homing_backoff: tuple[int, ...]  # microsteps
    homing_max_travel: tuple[int, ...]
    ready: tuple[int, ...]
    base_radius: tuple[float, ...]  # mm
    effector_radius: tuple[float, ...]
    upper_arm: tuple[float, ...]
    forearm: tuple[float, ...]
    azimuth: tuple[float, ...]  # rad
    tool_offset: tuple[float, ...]  # mm
    workspace_x: tuple[float, float]  # mm; infinite: unbounded
    workspace_y: tuple[float, float]
    workspace_z: tuple[float, float]
    workspace_radius: float


@dataclass(frozen=True, slots=True)
class Enable:
    """On: DISABLED to HALTED. Off: brakes if it moves, then drivers off and unhomed."""

    on: bool


@dataclass(frozen=True, slots=True)
class Home:
    """Only at rest, and with a live lease (Keep), which homing needs as any motion does. Refused
    with COUNTS beyond 2^30 microsteps: whatever drove it there, switch the board off and on.
    """


@dataclass(frozen=True, slots=True)
class Arm:
    """Opens an epoch, at rest only: the first segment starts at exactly `counts`.

    `epoch` must be 1 to 32767 after the board's last one (`HelloReply.last_epoch`), `counts` the
    board's own (and within what a knot can say), `t_start` the board's present tick as the host
    knows it (at most 150 ms ago and 100 ms ahead). The next segment has index 0.
    """

    epoch: int
    t_start: int
    counts: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Segment:
    """The cubic from the last knot to (p, v), which it reaches at `t_end` or later.

    It lasts `duration` ticks, 4 to 50 ms, so its nominal start is `t_end - duration`:
    - After a knot that moves, the nominal start must equal the `t_end` of the segment before.
    - After a knot at rest (or Arm) there may be a pause: the nominal start must not be before the
      last `t_end` (or, once the board stands still, not more than 150 ms before now), nor more than
      100 ms after the queue's end or now. The board waits for the nominal start; one that lies
      within what is planned means where that ends, and all that follows without a pause is late by
      as much. So the host takes the board's present tick, as it knows it, as the start of a motion.
    An epoch whose queue ran dry at rest stays ARMED. A queue that ends in a moving knot brakes from
    that knot on (UNDERRUN); the board knows it when it plans the piece in which the knot lies, so
    the next segment has to be there 2 ms before. `Telemetry.t_queue_end` tells when the queue
    really ends.

    Refused, and nothing else happens: not ARMED, another epoch, an index that is not the next one,
    no place in the queue (send it again). Everything else that is wrong with a segment brakes,
    drops the queue and halts with BAD_SEGMENT; a `seen` too old for a motion to begin: with LEASE.
    Where an epoch began outside a limit it may lead no further out than that, and the tool tip
    no further out than it has come in since.
    """

    epoch: int
    index: int
    t_end: int
    duration: int
    seen: int
    p: tuple[int, ...]
    v: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class CartesianSegment:
    """As `Segment`, but of the tool tip (x, y, z): the cubic from the last knot to (p, v), which
    the board turns into angles itself, at each boundary. Joints beyond the arms stand still.

    p is in 2^-8 micrometres, v in 2^-16 micrometres per millisecond. Only for a homed robot with a
    geometry. It follows a Cartesian segment or a knot at rest, and a joint segment follows it only
    where it comes to rest; else KIND, which brakes like all that is wrong with a segment. From rest
    it starts where the tip is, by the board's own kinematics.

    A board computes in single precision: its counts may differ by one from those of another. What
    the joints would do is judged at both ends and at most 2 ms apart between them; out of reach, or
    on the wrong side of a singularity, is outside the workspace.
    """

    epoch: int
    index: int
    t_end: int
    duration: int
    seen: int
    p: tuple[int, int, int]
    v: tuple[int, int, int]


@dataclass(frozen=True, slots=True)
class Keep:
    """Extends the board's lease: `seen` is the newest telemetry tick that the host had.

    The lease ends 150 ms after `seen`; a motion under way brakes (LEASE), from the last boundary on
    that is not later than that. A `seen` in the future, or older than the one that counts now,
    changes nothing.
    """

    seen: int


@dataclass(frozen=True, slots=True)
class Stop:
    """Brakes and halts, in every state. Answered by Stopped as soon as the board is at rest: at the
    first boundary from which on nothing moves and nothing is planned to.
    """


@dataclass(frozen=True, slots=True)
class EStop:
    """Drivers off at once, homing lost. Answered by Stopped."""


@dataclass(frozen=True, slots=True)
class Reset:
    """Leaves ESTOP or FAULT for DISABLED."""


@dataclass(frozen=True, slots=True)
class Tool:
    """Refused while DISABLED, in ESTOP and in FAULT. It is off whenever the drivers are."""

    on: bool
    servo_angle: float  # rad


# Board to host.


@dataclass(frozen=True, slots=True)
class HelloReply:
    """Who the board is, and how it stands. `version` is the first field in every version of the
    protocol; of another one, a host reads no further.

    A board proves by `boot` and `homed` that it never lost its counts: they are lost with its
    power, and `homed` with its drivers or with another configuration.
    """

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
    """The configuration that the board has now, by the CRC-32 of Configure's payload."""

    configuration: int


@dataclass(frozen=True, slots=True)
class Refused:
    """A command that was not carried out: which, and why. Index 65535 is told as none."""

    command: str
    reason: Refusal
    joint: int | None = None
    index: int | None = None  # of a segment

    @property
    def of_segment(self) -> bool:
        return self.command in ("segment", "cartesiansegment")


@dataclass(frozen=True, slots=True)
class Done:
    """A command that was carried out."""

    command: str


@dataclass(frozen=True, slots=True)
class Telemetry:
    """Every 5 ms of board time, at boundaries, and whenever state, fault or inputs change.

    `epoch` is the last one armed, `last_index` the last segment accepted in it (65535: none yet).
    `t_queue_end` is when the queue ends, `now` when it is empty; the host's own estimate of it is
    `t_queue_end` plus the durations of what it sent after `last_index`. `counts` is empty until
    the board is configured.
    """

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
    """At rest after a stop of whatever cause (an end of homing, too); repeated in answer to
    every Stop that finds the board at rest.
    """

    epoch: int
    cause: StopCause
    now: int
    counts: tuple[int, ...]


HostMessage = (
    Hello
    | Configure
    | Enable
    | Home
    | Arm
    | Segment
    | CartesianSegment
    | Keep
    | Stop
    | EStop
    | Reset
    | Tool
)
BoardMessage = HelloReply | Configured | Refused | Done | Telemetry | Stopped
