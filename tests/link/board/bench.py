"""A bench: a board on the table, a host's part played by hand, and a trace of what moved."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import inf
from typing import Any, Protocol, TypeVar

import pytest

from deltaviz.link.board import SimulatedBoard
from deltaviz.link.board.plant import Plant
from deltaviz.link.board.port import BoardPort
from deltaviz.link.messages import (
    PROTOCOL_VERSION,
    Arm,
    BoardMessage,
    BoardState,
    CartesianSegment,
    Configure,
    Enable,
    Fault,
    Hello,
    Home,
    HostMessage,
    Keep,
    Options,
    RobotKind,
    Segment,
    StopCause,
    Telemetry,
    Tool,
)
from deltaviz.link.rules import since
from deltaviz.link.wire.codec import decode_board, encode
from deltaviz.link.wire.commands import COMMANDS, next_sequence
from deltaviz.link.wire.frames import FrameReader, write_frame

MS = 200  # ticks
MASK = 0xFFFF_FFFF
PER_RAD = 1000.0
VELOCITY = 4000.0  # microsteps/s
ACCELERATION = 50_000.0  # microsteps/s²

M = TypeVar("M", bound=BoardMessage)


class Board(Protocol):
    """A board of any make: bytes in and out, time as it is told, and what there is to see."""

    now: int
    state: BoardState
    fault: Fault
    cause: StopCause
    homed: bool
    moving: bool
    counts: tuple[int, ...]
    positions: list[int]  # Q32
    tool: Tool
    plant: Plant  # on its pins, once it is configured

    def feed(self, data: bytes) -> None: ...
    def take(self) -> list[bytes]: ...
    def advance(self, ticks: int) -> None: ...
    def press_estop(self, pressed: bool) -> None: ...


class PythonBoard:
    """The simulated board, by bytes."""

    def __init__(self, **options: Any) -> None:
        self._board = SimulatedBoard(**options)
        self._port = BoardPort(self._board)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._board, name)

    def feed(self, data: bytes) -> None:
        self._port.feed(data)

    def take(self) -> list[bytes]:
        return self._port.take()


MakeBoard = Callable[..., Any]

# For tests that reach into the simulated board.
simulated_only = pytest.mark.parametrize("make_board", [PythonBoard])


class Host:
    """Messages to a board and back. Commands are numbered; nothing is lost, so none is repeated."""

    def __init__(self, board: Any) -> None:
        self.board: Board = board
        self._reader = FrameReader()
        self._sequence = 0

    def frame(self, message: HostMessage) -> bytes:
        number = 0
        if isinstance(message, COMMANDS):
            number = self._sequence = next_sequence(self._sequence)
        type_, payload = encode(message)
        return write_frame(type_, number, payload)

    def send(self, message: HostMessage) -> list[BoardMessage]:
        self.board.feed(self.frame(message))
        return self.hear()

    def hear(self) -> list[BoardMessage]:
        frames = self._reader.feed(b"".join(self.board.take()))
        return [decode_board(frame.type, frame.payload) for frame in frames]


def gantry(joints: int = 2, **changes: Any) -> Configure:
    """A robot without geometry: the board guards its joints alone. `changes` are in rad and s."""
    values: dict[str, Any] = {
        "joint_min": (-1.0,) * joints,
        "joint_max": (1.5,) * joints,
        "homing_direction": -1,
        "homing_switch": tuple(-1.1 - 0.01 * joint for joint in range(joints)),
        "homing_together": True,
        "ready": tuple(0.1 * joint for joint in range(joints)),
    } | changes

    def microsteps(angles: Sequence[float], unit: int = 1) -> tuple[int, ...]:
        return tuple(round(angle * PER_RAD * unit) for angle in angles)

    none = (0.0,) * joints
    return Configure(
        kind=RobotKind.JOINTS_ONLY,
        options=Options.HOMING_TOGETHER if values["homing_together"] else Options.NONE,
        homing_direction=values["homing_direction"],
        joint_min=microsteps(values["joint_min"], 1024),
        joint_max=microsteps(values["joint_max"], 1024),
        velocity=(round(VELOCITY * 65.536),) * joints,
        acceleration=(round(ACCELERATION * 2**24 / 1e6),) * joints,
        unhomed_velocity=(round(0.1 * PER_RAD * 65.536),) * joints,
        microsteps_per_rad=(PER_RAD,) * joints,
        inverted=(False,) * joints,
        homing_switch=microsteps(values["homing_switch"]),
        homing_fast=(round(2.0 * PER_RAD * 65.536),) * joints,
        homing_slow=(round(0.2 * PER_RAD * 65.536),) * joints,
        homing_backoff=microsteps([0.05] * joints),
        homing_max_travel=microsteps([3.0] * joints),
        ready=microsteps(values["ready"]),
        base_radius=none,
        effector_radius=none,
        upper_arm=none,
        forearm=none,
        azimuth=none,
        tool_offset=(0.0, 0.0, 0.0),
        workspace_x=(-inf, inf),
        workspace_y=(-inf, inf),
        workspace_z=(-inf, inf),
        workspace_radius=inf,
    )


class Bench:
    """`trace` has the positions (microsteps) at each millisecond that `run` let pass."""

    def __init__(
        self,
        configure: Configure,
        *,
        make_board: MakeBoard,
        homed: bool = True,
        now: int = 1000,
        last_epoch: int = 0,
        theta: Sequence[float] | None = None,
    ) -> None:
        self.configure = configure
        self.said: list[BoardMessage] = []
        self.trace: list[list[float]] = []
        self.counts_trace: list[tuple[int, ...]] = []
        self.seen = now
        self.epoch = last_epoch
        self.index = 0
        self.t_end = now
        self._make_board = make_board
        self._connect(make_board(start_homed=homed, now=now, last_epoch=last_epoch, theta=theta))
        self.send(configure)
        if not homed:
            self.send(Enable(on=True))

    def switch_off_and_on(self) -> None:
        self._connect(self._make_board())

    def _connect(self, board: Any) -> None:
        self._host = Host(board)
        self.board = self._host.board
        self.send(Hello(PROTOCOL_VERSION))

    def send(self, message: HostMessage) -> list[BoardMessage]:
        return self._note(self._host.send(message))

    def frame(self, message: HostMessage) -> bytes:
        """For a test that feeds it by itself."""
        return self._host.frame(message)

    def _note(self, heard: list[BoardMessage]) -> list[BoardMessage]:
        for message in heard:
            if isinstance(message, Telemetry):
                self.seen = message.now
        self.said += heard
        return heard

    def advance(self, ticks: int) -> list[BoardMessage]:
        self.board.advance(ticks)
        return self._note(self._host.hear())

    def run(self, ms: int, *, keep: bool = True) -> list[BoardMessage]:
        heard: list[BoardMessage] = []
        for _ in range(ms):
            heard += self.advance(MS)
            if keep:
                self.send(Keep(self.seen))
            self.trace.append([position / 2**32 for position in self.board.positions])
            self.counts_trace.append(self.board.counts)
        return heard

    def run_to_rest(self, *, keep: bool = True, most_ms: int = 20_000) -> list[BoardMessage]:
        heard: list[BoardMessage] = []
        for _ in range(most_ms):
            heard += self.run(1, keep=keep)
            if not self.board.moving:
                return heard
        raise AssertionError("it never came to rest")

    def home(self) -> list[BoardMessage]:
        """Until it stands at the ready pose, or has failed."""
        self.send(Keep(self.board.now))
        heard = self.send(Home())
        assert self.board.state is BoardState.HOMING
        return heard + self.run_to_rest()

    def arm(self, **changes: Any) -> list[BoardMessage]:
        self.epoch = (self.epoch + 1) & 0xFFFF
        self.index = 0
        self.t_end = self.board.now
        values: dict[str, Any] = {
            "epoch": self.epoch,
            "t_start": self.board.now,
            "counts": self.board.counts,
        }
        return self.send(Arm(**(values | changes)))

    def segment(
        self, p: Sequence[float], v: Sequence[float], *, ms: float = 10, **changes: Any
    ) -> list[BoardMessage]:
        """To `p` microsteps at `v` microsteps/s, right after the segment before."""
        duration = changes.get("duration", round(ms * MS))
        values: dict[str, Any] = {
            "epoch": self.epoch,
            "index": self.index,
            "t_end": (self.t_end + duration) & MASK,
            "duration": duration,
            "seen": self.seen,
            "p": tuple(round(x * 1024) for x in p),
            "v": tuple(round(x * 65.536) for x in v),
        }
        message = Segment(**(values | changes))
        self.index = (message.index + 1) & 0xFFFF
        self.t_end = message.t_end
        return self.send(message)

    def tip_segment(
        self, xyz: Sequence[float], v: Sequence[float], *, ms: float = 10, **changes: Any
    ) -> list[BoardMessage]:
        """The tip to `xyz` mm at `v` mm/s, right after the segment before."""
        duration = changes.get("duration", round(ms * MS))
        x, y, z = (round(value * 256_000) for value in xyz)
        vx, vy, vz = (round(value * 65_536) for value in v)
        values: dict[str, Any] = {
            "epoch": self.epoch,
            "index": self.index,
            "t_end": (self.t_end + duration) & MASK,
            "duration": duration,
            "seen": self.seen,
            "p": (x, y, z),
            "v": (vx, vy, vz),
        }
        message = CartesianSegment(**(values | changes))
        self.index = (message.index + 1) & 0xFFFF
        self.t_end = message.t_end
        return self.send(message)

    def speed_up(self, speed: float, *, share: float = 0.9) -> None:
        """Queues segments that bring joint 0 to `speed` microsteps/s, and a bit beyond."""
        joints = len(self.board.counts)
        if self.board.state is not BoardState.ARMED:
            self.arm()
        start = self.board.counts[0]
        rest = [float(count) for count in self.board.counts[1:]]
        step = ACCELERATION * share * 0.010
        p, v = float(start), 0.0
        while v < speed:
            faster = min(v + step, speed)
            p += (v + faster) / 2 * 0.010
            v = faster
            self.segment([p, *rest], [v] + [0.0] * (joints - 1))
        self.coast = (p, v)

    def go_on(self, segments: int) -> None:
        """Queues segments at the speed of `speed_up`."""
        p, v = self.coast
        rest = [float(count) for count in self.board.counts[1:]]
        for _ in range(segments):
            p += v * 0.010
            self.segment([p, *rest], [v] + [0.0] * len(rest))
        self.coast = (p, v)

    def last(self, kind: type[M]) -> M:
        return next(message for message in reversed(self.said) if isinstance(message, kind))

    def all(self, kind: type[M]) -> list[M]:
        return [message for message in self.said if isinstance(message, kind)]

    @property
    def now(self) -> int:
        return self.board.now

    def ticks_since(self, tick: int) -> int:
        return since(self.board.now, tick)


def top_acceleration(trace: Sequence[Sequence[float]], *, window: int = 5) -> float:
    """The largest acceleration (per s²) in a trace of 1 ms, by second differences over `window`
    ms: it knows nothing of how the board brakes.
    """
    h = window / 1000
    return max(
        (
            abs(after[i] - 2 * here[i] + before[i]) / (h * h)
            for before, here, after in zip(trace, trace[window:], trace[2 * window :], strict=False)
            for i in range(len(here))
        ),
        default=0.0,
    )
