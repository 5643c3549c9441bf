"""Frames: COBS(type, sequence, payload, CRC-32) and a zero byte, out of a stream of bytes.

A zero byte ends every frame and occurs nowhere else, so a reader that has lost its way finds it
again at the next one.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple, cast
from zlib import crc32

from cobs import cobs  # pyright: ignore[reportMissingTypeStubs]

from deltaviz.link.wire.description import FRAME_OVERHEAD, load_description
from deltaviz.link.wire.errors import Unsendable

PAYLOAD_MAX = load_description().payload_max
_DECODED_MAX = PAYLOAD_MAX + FRAME_OVERHEAD
ENCODED_MAX = _DECODED_MAX + _DECODED_MAX // 254 + 1

_stuffed: Callable[[bytes], bytes] = cast(Any, cobs).encode
_plain: Callable[[bytes], bytes] = cast(Any, cobs).decode


class Frame(NamedTuple):
    type: int
    sequence: int
    payload: bytes


def write_frame(type_: int, sequence: int, payload: bytes) -> bytes:
    if len(payload) > PAYLOAD_MAX:
        raise Unsendable(f"a payload of {len(payload)} bytes; {PAYLOAD_MAX} is the most")
    body = bytes((type_, sequence)) + payload
    return _stuffed(body + crc32(body).to_bytes(4, "little")) + b"\0"


class FrameReader:
    """Bytes in, frames out. `dropped` counts frames that were too short, too long or damaged."""

    def __init__(self) -> None:
        self.dropped = 0
        self._partial = b""

    def feed(self, data: bytes) -> list[Frame]:
        *ended, partial = data.split(b"\0")
        if ended:
            ended[0] = self._partial + ended[0]
        else:
            partial = self._partial + partial
        # What is too long stays so, and need not be kept.
        self._partial = partial[: ENCODED_MAX + 1]
        frames: list[Frame] = []
        for encoded in ended:
            frame = decode_frame(encoded)
            if frame is not None:
                frames.append(frame)
            elif encoded:
                self.dropped += 1
        return frames


def decode_frame(encoded: bytes) -> Frame | None:
    """What stands between two zero bytes; None if it is no frame."""
    if len(encoded) > ENCODED_MAX:
        return None
    try:
        decoded = _plain(encoded)
    except cobs.DecodeError:
        return None
    body, crc = decoded[:-4], decoded[-4:]
    if not FRAME_OVERHEAD <= len(decoded) <= _DECODED_MAX:
        return None
    if crc32(body) != int.from_bytes(crc, "little"):
        return None
    return Frame(body[0], body[1], body[2:])
