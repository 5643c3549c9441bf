"""What host and board say to each other, read off the wire: after docs/protocol.md, with no code of
either of them. Commands that no judge asks about are passed over.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from zlib import crc32

from cobs import cobs

from deltaviz.link.messages import BoardState, StopCause

NONE_TAKEN = 0xFFFF  # the last index in an epoch without any
_MOVING = 0x02
_ESTOP = 0x01


@dataclass(frozen=True, slots=True)
class Arm:
    epoch: int
    t_start: int
    counts: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Segment:
    """A cubic to p (2^-10 microsteps) and v (2^-16 microsteps per millisecond)."""

    epoch: int
    index: int
    t_end: int
    duration: int
    seen: int
    p: tuple[int, ...]
    v: tuple[int, ...]

    @property
    def rests(self) -> bool:
        return not any(self.v)


@dataclass(frozen=True, slots=True)
class Keep:
    seen: int


@dataclass(frozen=True, slots=True)
class Stop:
    at_once: bool  # an e-stop


@dataclass(frozen=True, slots=True)
class Greeting:
    """A board's answer to Hello."""

    tick_hz: int
    boot: int
    homed: bool
    last_stop: StopCause


@dataclass(frozen=True, slots=True)
class Telemetry:
    now: int
    state: BoardState
    epoch: int
    last_index: int
    t_queue_end: int
    inputs: int
    flags: int
    counts: tuple[int, ...]

    @property
    def moving(self) -> bool:
        return bool(self.flags & _MOVING) or self.state in (BoardState.BRAKING, BoardState.HOMING)

    @property
    def button(self) -> bool:
        """Whether the board sees the e-stop input active."""
        return bool(self.inputs & _ESTOP)


@dataclass(frozen=True, slots=True)
class Stopped:
    epoch: int
    cause: StopCause
    now: int


Said = Arm | Segment | Keep | Stop | Greeting | Telemetry | Stopped


class Ear:
    """Bytes of one direction in, messages out."""

    def __init__(self) -> None:
        self._partial = b""

    def feed(self, data: bytes) -> list[Said]:
        *frames, self._partial = (self._partial + data).split(b"\0")
        return [said for frame in frames if (said := _read(frame)) is not None]


def _read(frame: bytes) -> Said | None:
    try:
        plain = cobs.decode(frame)
    except cobs.DecodeError:
        return None
    body, crc = plain[:-4], plain[-4:]
    if len(plain) < 6 or crc32(body) != int.from_bytes(crc, "little"):
        return None
    read = _KINDS.get(body[0])
    return None if read is None else read(body[2:])


def _joints(payload: bytes, at: int, arrays: int) -> list[tuple[int, ...]]:
    joints = payload[at]
    values = struct.unpack_from(f"<{joints * arrays}i", payload, at + 1)
    return [values[k * joints : (k + 1) * joints] for k in range(arrays)]


def _arm(payload: bytes) -> Arm:
    return Arm(*struct.unpack_from("<HI", payload), *_joints(payload, 6, 1))


def _segment(payload: bytes) -> Segment:
    return Segment(*struct.unpack_from("<HHIII", payload), *_joints(payload, 16, 2))


def _greeting(payload: bytes) -> Greeting:
    board = 2
    build = board + 1 + payload[board]
    tick_hz, _, boot, _, homed, _, last_stop = struct.unpack_from(
        "<IHIH?IB", payload, build + 1 + payload[build] + 1
    )
    return Greeting(tick_hz, boot, homed, StopCause(last_stop))


def _telemetry(payload: bytes) -> Telemetry:
    now, state, _, epoch, last_index, t_queue_end, _, inputs, flags = struct.unpack_from(
        "<IBBHHIHBB", payload
    )
    (counts,) = _joints(payload, 18, 1)
    return Telemetry(now, BoardState(state), epoch, last_index, t_queue_end, inputs, flags, counts)


def _stopped(payload: bytes) -> Stopped:
    epoch, cause, now = struct.unpack_from("<HBI", payload)
    return Stopped(epoch, StopCause(cause), now)


_KINDS = {
    0x05: _arm,
    0x06: _segment,
    0x07: lambda payload: Keep(*struct.unpack("<I", payload)),
    0x08: lambda _: Stop(at_once=False),
    0x09: lambda _: Stop(at_once=True),
    0x81: _greeting,
    0x85: _telemetry,
    0x86: _stopped,
}
