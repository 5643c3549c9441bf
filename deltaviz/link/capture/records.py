"""What a capture file is made of, as bytes.

A capture is a sequence of frames like those of the wire: COBS(kind u8, number u8, payload, CRC-32)
and a zero byte. So it may be cut off anywhere, and a reader finds its way past what is damaged.
`number` counts records, modulo 256.

- HEAD begins a run of the program; its payload is JSON: format, program, started, link, robot. A
  file may have several, each with a clock of its own.
- All others begin with the time since their head, u48 in microseconds.
- OPENED and CLOSED: a text: the link, and why it ended (empty: it was closed).
- SENT and RECEIVED: bytes as they went to the board and came from it, however they were cut.
- LOST: u32, how many records could not be kept before this one.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from enum import IntEnum
from typing import Any

import msgspec

from deltaviz.link.wire.errors import Malformed
from deltaviz.link.wire.frames import PAYLOAD_MAX, Frame, write_frame

FORMAT = 1
_TIME = 6  # bytes
DATA_MAX = PAYLOAD_MAX - _TIME


class Kind(IntEnum):
    HEAD = 1
    OPENED = 2
    CLOSED = 3
    SENT = 4
    RECEIVED = 5
    LOST = 6


@dataclass(frozen=True, slots=True)
class Record:
    """`at` is in seconds since the head."""

    kind: Kind
    at: float
    data: bytes

    @property
    def text(self) -> str:
        return self.data.decode("utf-8", "replace")

    @property
    def count(self) -> int:
        return int.from_bytes(self.data, "little")


def write_record(record: Record, number: int) -> bytes:
    """One record as bytes; its data has at most DATA_MAX (a head's PAYLOAD_MAX) of them."""
    time = b"" if record.kind is Kind.HEAD else round(record.at * 1e6).to_bytes(_TIME, "little")
    return write_frame(record.kind, number & 0xFF, time + record.data)


def read_record(frame: Frame) -> Record:
    """Raises Malformed."""
    try:
        kind = Kind(frame.type)
    except ValueError:
        raise Malformed(f"there are no records of kind {frame.type}") from None
    if kind is Kind.HEAD:
        return Record(kind, 0.0, frame.payload)
    if len(frame.payload) < _TIME:
        raise Malformed(f"{kind.name} without a time")
    at = int.from_bytes(frame.payload[:_TIME], "little") / 1e6
    return Record(kind, at, frame.payload[_TIME:])


def head(about: dict[str, str]) -> Record:
    """`about`: short texts by short names."""
    return Record(Kind.HEAD, 0.0, json.dumps({"format": FORMAT, **about}).encode())


def about(record: Record) -> dict[str, Any]:
    """What a head says. Raises Malformed."""
    try:
        return msgspec.json.decode(record.data, type=dict[str, Any])
    except msgspec.MsgspecError as error:
        raise Malformed(f"the head is no JSON object: {error}") from error
