"""The firmware's core on this machine, behind the same bench as the simulated board.

The environment's FIRMWARE_HOST names the target of firmware/Makefile: `host`, or `host-asan`.
"""

from __future__ import annotations

import ctypes as c
import fcntl
import os
import subprocess
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Any

from deltaviz.link.board.parameters import parameters_from
from deltaviz.link.board.plant import Plant, power_up_pose
from deltaviz.link.messages import BoardState, Configure, Fault, StopCause, Tool
from deltaviz.link.rules import TICK_HZ
from deltaviz.link.wire.codec import decode_host
from deltaviz.link.wire.description import load_description
from deltaviz.link.wire.errors import Malformed
from deltaviz.link.wire.frames import FrameReader

FIRMWARE = Path(__file__).parents[2] / "firmware"
ESTOP = 1 << 4  # enum dv_level
BOUNDARY = 0x100  # DV_PINS_BOUNDARY
_JOINTS = load_description().joints_max
_ROOM = 1 << 14


def run_make(target: str) -> None:
    with (FIRMWARE / "Makefile").open() as lock:  # one at a time
        fcntl.flock(lock, fcntl.LOCK_EX)
        command = ["make", "-s", "-C", str(FIRMWARE), target]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def make(target: str) -> Path:
    """The library that a target of the firmware's Makefile builds."""
    run_make(target)
    return FIRMWARE / "build" / target / "libdv.so"


class View(c.Structure):
    """`struct dv_host_view`."""

    _fields_ = [
        ("now", c.c_uint32),
        ("configuration", c.c_uint32),
        *((name, c.c_uint8) for name in ("state", "fault", "cause", "joints")),
        *((name, c.c_bool) for name in ("homed", "moving")),
        *((f"drivers_{name}", c.c_bool) for name in ("known", "on", "active_high")),
        ("tool_on", c.c_bool),
        ("servo_angle", c.c_float),
        ("fed", c.c_uint32),
        ("counts", c.c_int32 * _JOINTS),
        ("emitted", c.c_int32 * _JOINTS),
        ("positions", c.c_int64 * _JOINTS),
        ("travelled", c.c_int64 * _JOINTS),
    ]


@cache
def library() -> c.CDLL:
    host, u32, size = c.c_void_p, c.c_uint32, c.c_size_t
    dv = c.CDLL(str(make(os.environ.get("FIRMWARE_HOST", "host"))))
    arguments: dict[str, list[Any]] = {
        "new": [u32, u32, c.c_uint16, u32],
        "free": [host],
        "assume_homed": [host],
        "feed": [host, c.c_char_p, size],
        "take": [host, c.c_char_p, size],
        "set_write_room": [host, size],
        "run": [host, u32, c.POINTER(c.c_uint16)],
        "set_inputs": [host, c.c_uint8],
        "control": [host],
        "set_meanwhile": [host, u32],
        "look": [host, c.POINTER(View)],
    }
    for name, types in arguments.items():
        function = getattr(dv, f"dv_host_{name}")
        function.argtypes = types
        function.restype = None
    dv.dv_host_new.restype = host
    dv.dv_host_take.restype = size
    dv.dv_host_run.restype = u32
    return dv


class CBoard:
    """A board that was just switched on, with arms on its pins once it is configured.

    `pins`, if it is a list, gets the pins at each tick.
    """

    def __init__(
        self,
        *,
        tick_hz: int = TICK_HZ,
        start_homed: bool = False,
        theta: Sequence[float] | None = None,
        boot: int = 1,
        now: int = 0,
        last_epoch: int = 0,
    ) -> None:
        self._dv = library()
        self._host = self._dv.dv_host_new(tick_hz, now, last_epoch, boot)
        self._tick_hz = tick_hz
        self._start_homed = start_homed
        self._theta = theta
        self._reader = FrameReader()
        self._offered: Configure | None = None  # the last one that was fed
        self._configure: Configure | None = None  # the one that it took
        self._configuration = 0
        self._travelled: list[int] = []
        self._estop = False
        self._to_boundary = tick_hz // 1000
        self._buffer = c.create_string_buffer(_ROOM)
        self._pins = (c.c_uint16 * (tick_hz // 1000))()
        self.plant: Plant = None  # type: ignore[assignment]
        self.pins: list[int] | None = None

    def __del__(self) -> None:
        self._dv.dv_host_free(self._host)

    # Bytes.

    def feed(self, data: bytes) -> None:
        for frame in self._reader.feed(data):
            self._note(frame.type, frame.payload)
        self._dv.dv_host_feed(self._host, data, len(data))
        self._follow_configuration()

    def take(self) -> list[bytes]:
        taken = b""
        while size := self._dv.dv_host_take(self._host, self._buffer, _ROOM):
            taken += self._buffer.raw[:size]
        return [taken]

    def set_write_room(self, room: int) -> None:
        self._dv.dv_host_set_write_room(self._host, room)

    def _note(self, type_: int, payload: bytes) -> None:
        try:
            message = decode_host(type_, payload)
        except Malformed:
            return
        if isinstance(message, Configure):
            self._offered = message

    def _follow_configuration(self) -> None:
        view = self.look()
        if view.configuration == self._configuration:
            return
        first, self._configuration = self._configuration == 0, view.configuration
        assert self._offered is not None
        self._configure = self._offered
        parameters = parameters_from(self._configure, tick_hz=self._tick_hz)
        assert parameters is not None
        homed = first and self._start_homed
        per_rad = self._configure.microsteps_per_rad
        ready = [r / m for r, m in zip(self._configure.ready, per_rad, strict=True)]
        theta = ready if homed else self._theta or power_up_pose(parameters.configure)
        self.plant = Plant(parameters, theta=theta)
        self._travelled = list(view.travelled[: view.joints])
        if homed:
            self._dv.dv_host_assume_homed(self._host)

    # Time.

    def advance(self, ticks: int) -> None:
        while ticks > 0:
            ticks -= self.run(ticks)
            if self._to_boundary == 0:
                self.control()

    def run(self, ticks: int) -> int:
        """At most to the next boundary, without control; the ticks passed."""
        ticks = min(ticks, self._to_boundary)
        passed = self._dv.dv_host_run(self._host, ticks, self._pins)
        assert passed == ticks
        if self.pins is not None:
            self.pins += self._pins[:passed]
        self._to_boundary -= passed
        return passed

    def run_without_control(self, ticks: int) -> None:
        """On from a boundary, as if the control interrupt were kept waiting."""
        while ticks > 0:
            ticks -= self._dv.dv_host_run(self._host, ticks, None)

    def control(self, *, after: int = 0) -> None:
        """What the pins did, what the inputs read, and what follows; `after` ticks too late."""
        self._to_boundary = self._tick_hz // 1000 - after
        self._dv.dv_host_set_inputs(self._host, self._levels())
        self._dv.dv_host_control(self._host)

    def let_pass(self, pieces: int) -> None:
        """From a boundary on: while the next segment is judged, with their control."""
        assert self._to_boundary == self._tick_hz // 1000
        self._dv.dv_host_set_inputs(self._host, self._levels())
        self._dv.dv_host_set_meanwhile(self._host, pieces)

    def press_estop(self, pressed: bool) -> None:
        self._estop = pressed

    def _levels(self) -> int:
        levels = ESTOP if self._estop else 0
        if self.plant is None:
            return levels
        view = self.look()
        travelled = list(view.travelled[: view.joints])
        self.plant.rebase(tuple(self._travelled))
        self.plant.step(tuple(travelled))
        self._travelled = travelled
        for joint, pressed in enumerate(self.plant.switches):
            levels |= (pressed == self._active_open) << joint
        return levels

    @property
    def _active_open(self) -> bool:
        assert self._configure is not None
        return bool(self._configure.options & 2)

    # What there is to see.

    def look(self) -> Any:
        view = View()
        self._dv.dv_host_look(self._host, c.byref(view))
        return view

    @property
    def now(self) -> int:
        return self.look().now

    @property
    def state(self) -> BoardState:
        return BoardState(self.look().state)

    @property
    def fault(self) -> Fault:
        return Fault(self.look().fault)

    @property
    def cause(self) -> StopCause:
        return StopCause(self.look().cause)

    @property
    def homed(self) -> bool:
        return self.look().homed

    @property
    def moving(self) -> bool:
        return self.look().moving

    @property
    def counts(self) -> tuple[int, ...]:
        view = self.look()
        return tuple(view.counts[: view.joints])

    @property
    def positions(self) -> list[int]:
        view = self.look()
        return list(view.positions[: view.joints])

    @property
    def tool(self) -> Tool:
        view = self.look()
        return Tool(on=view.tool_on, servo_angle=view.servo_angle)
