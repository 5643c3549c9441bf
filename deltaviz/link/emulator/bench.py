"""Who stands beside the emulated board: switches it on, presses its switches, looks at its arms.

The other end is firmware/port/stm32f407/emulator/bench.c, behind a serial port of its own.
"""

from __future__ import annotations

import contextlib
import socket
import struct
import time
from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum

from deltaviz.link.emulator.arms import Arm
from deltaviz.link.messages import Configure, Options
from deltaviz.link.wire.frames import FrameReader, write_frame

POWER, ARM, INPUT, ASK, STATE = 0x40, 0x41, 0x42, 0x43, 0xC0

_ESTOP = 4  # the input behind those of the switches
_POWER = struct.Struct("<I?")
_ARM = struct.Struct("<B??b4i")
_INPUT = struct.Struct("<BB")
_STATE = struct.Struct("<??H4i")
_REPEAT = 0.5  # s
_PATIENCE = 20.0  # s, of a loaded machine


class Circuit(IntEnum):
    """What an input is held at, whatever the arm does."""

    CLOSED = 0
    OPEN = 1  # as by a broken wire, or by the pressed e-stop button
    FREE = 2  # what hangs on it decides


@dataclass(frozen=True, slots=True)
class BenchState:
    drivers_on: bool
    tool_on: bool
    servo_us: int  # length of its pulses; 0: none
    arms: tuple[int, ...]  # microsteps from the true zero angle; of four, there or not


def power_on(configure: Configure, arms: Sequence[Arm], *, boot: int) -> bytes:
    """What is said before the board starts: what hangs on it. `boot` names the power-up."""
    by_high = Options.ENABLE_ACTIVE_HIGH in configure.options
    placed = [_place(joint, arm) for joint, arm in enumerate(arms)]
    return b"".join(placed) + write_frame(POWER, 0, _POWER.pack(boot, by_high))


def _place(joint: int, arm: Arm) -> bytes:
    payload = _ARM.pack(
        joint,
        arm.inverted,
        arm.switch_open,
        arm.direction,
        arm.at,
        arm.low,
        arm.high,
        arm.switch,
    )
    return write_frame(ARM, 0, payload)


class Bench:
    """Each call returns what is there to see once it has been carried out."""

    def __init__(self, sock: socket.socket) -> None:
        """`sock` leads to the bench of a board."""
        self._socket = sock
        self._reader = FrameReader()
        self._sequence = 0
        sock.settimeout(_REPEAT)

    def place(self, joint: int, arm: Arm) -> BenchState:
        return self._do(_place(joint, arm))

    def hold(self, joint: int, circuit: Circuit) -> BenchState:
        """The switch of a joint."""
        return self._do(write_frame(INPUT, 0, _INPUT.pack(joint, circuit)))

    def estop(self, *, pressed: bool) -> BenchState:
        """The button."""
        return self.hold(_ESTOP, Circuit.OPEN if pressed else Circuit.CLOSED)

    def state(self) -> BenchState:
        return self._do(b"")

    def _do(self, frame: bytes) -> BenchState:
        """Says it again until it is answered: who is not on yet does not hear."""
        self._sequence = (self._sequence + 1) & 0xFF
        until = time.monotonic() + _PATIENCE
        while time.monotonic() < until:
            self._socket.sendall(frame + write_frame(ASK, self._sequence, b""))
            with contextlib.suppress(TimeoutError):
                return self._answer()
        raise TimeoutError("the emulated board does not answer at its bench")

    def _answer(self) -> BenchState:
        while True:
            data = self._socket.recv(4096)
            if not data:
                raise ConnectionError("the emulator has ended")
            for answer in self._reader.feed(data):
                if answer.sequence == self._sequence:
                    drivers_on, tool_on, servo_us, *arms = _STATE.unpack(answer.payload)
                    return BenchState(drivers_on, tool_on, servo_us, tuple(arms))

    def close(self) -> None:
        self._socket.close()
