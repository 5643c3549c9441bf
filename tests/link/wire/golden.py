"""Writes tests/data/frames.json: `python tests/link/wire/golden.py`.

The bytes are spelt out here by hand, from docs/protocol.md: nothing of deltaviz is used, nor the
libraries that it uses for COBS and CRC.
"""

from __future__ import annotations

import json
import struct
from pathlib import Path
from typing import Any

OUT = Path(__file__).parents[2] / "data" / "frames.json"
INF = float("inf")


def crc32(data: bytes) -> int:
    """Bit by bit: reflected, polynomial 0xEDB88320, from all ones, inverted at the end."""
    crc = 0xFFFFFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0xEDB88320 if crc & 1 else 0)
    return crc ^ 0xFFFFFFFF


def stuff(data: bytes) -> bytes:
    """COBS: runs without a zero, each behind its length and one; the zero behind a run is left
    out. A run of 254 ends by itself, and has no zero behind it.
    """
    out, run, owed = b"", b"", True
    for at, byte in enumerate(data):
        owed = True
        if byte:
            run += bytes([byte])
            if len(run) < 254:
                continue
            owed = at + 1 < len(data)
        out += bytes([len(run) + 1]) + run
        run = b""
    return out + bytes([len(run) + 1]) + run if owed else out


def frame(type_: int, sequence: int, payload: bytes) -> bytes:
    body = bytes([type_, sequence]) + payload
    return stuff(body + struct.pack("<I", crc32(body))) + b"\0"


def configure() -> tuple[dict[str, Any], bytes]:
    """A delta; numbers that single precision holds exactly."""
    fields: dict[str, Any] = {
        "kind": 1,
        "options": 0b111,
        "homing_direction": -1,
        "joint_min": [-400_000, -400_001, -(2**31)],
        "joint_max": [800_000, 800_001, 2**31 - 1],
        "velocity": [198_000, 198_001, 2**32 - 1],
        "acceleration": [671_000, 671_001, 256],
        "unhomed_velocity": [2900, 2901, 1],
        "microsteps_per_rad": [509.25, 509.5, 0.125],
        "inverted": [False, True, False],
        "homing_switch": [-444, -445, -(2**20)],
        "homing_fast": [11_650, 11_651, 1],
        "homing_slow": [1165, 1166, 2],
        "homing_backoff": [44, 45, 1],
        "homing_max_travel": [1511, 1512, 2**20],
        "ready": [0, 1, -1],
        "base_radius": [115.0, 115.5, 116.0],
        "effector_radius": [75.0, 75.5, 76.0],
        "upper_arm": [125.0, 125.5, 126.0],
        "forearm": [338.0, 338.5, 339.0],
        "azimuth": [0.0, 2.125, 4.25],
        "tool_offset": [0.0, -1.5, 12.25],
        "workspace_x": [-INF, INF],
        "workspace_y": [-100.0, 100.0],
        "workspace_z": [-440.0, -225.0],
        "workspace_radius": INF,
    }
    f = fields
    payload = struct.pack("<BBBb", 3, 1, 0b111, -1)
    payload += struct.pack("<3i3i", *f["joint_min"], *f["joint_max"])
    payload += struct.pack("<3I3I3I", *f["velocity"], *f["acceleration"], *f["unhomed_velocity"])
    payload += struct.pack("<3f3B3i", *f["microsteps_per_rad"], 0, 1, 0, *f["homing_switch"])
    payload += struct.pack("<3I3I", *f["homing_fast"], *f["homing_slow"])
    payload += struct.pack("<3I3I3i", *f["homing_backoff"], *f["homing_max_travel"], *f["ready"])
    payload += struct.pack("<3f3f", *f["base_radius"], *f["effector_radius"])
    payload += struct.pack("<3f3f3f", *f["upper_arm"], *f["forearm"], *f["azimuth"])
    payload += struct.pack("<3f", *f["tool_offset"])
    payload += struct.pack("<2f2f2ff", -INF, INF, -100, 100, -440, -225, INF)
    return fields, payload


CONFIGURE, CONFIGURE_PAYLOAD = configure()

# Name, type, sequence, fields, payload.
MESSAGES: list[tuple[str, int, int, dict[str, Any], bytes]] = [
    ("Hello", 0x01, 255, {"version": 1}, b"\x01\x00"),
    ("Configure", 0x02, 2, CONFIGURE, CONFIGURE_PAYLOAD),
    ("Enable", 0x03, 3, {"on": True}, b"\x01"),
    ("Enable", 0x03, 4, {"on": False}, b"\x00"),
    ("Home", 0x04, 5, {}, b""),
    (
        "Arm",
        0x05,
        6,
        {"epoch": 0x1234, "t_start": 0xFFFFFF00, "counts": [1, -1, 70_000]},
        b"\x34\x12\x00\xff\xff\xff\x03" + struct.pack("<iii", 1, -1, 70_000),
    ),
    ("Arm", 0x05, 7, {"epoch": 0, "t_start": 0, "counts": []}, b"\x00\x00\x00\x00\x00\x00\x00"),
    (
        "Segment",
        0x06,
        0,
        {
            "epoch": 0xFFFF,
            "index": 0x0100,
            "t_end": 0x01020304,
            "duration": 2000,
            "seen": 0x80000000,
            "p": [-1, 0, 1024],
            "v": [-65536, 0, 2**31 - 1],
        },
        b"\xff\xff\x00\x01\x04\x03\x02\x01\xd0\x07\x00\x00\x00\x00\x00\x80\x03"
        b"\xff\xff\xff\xff\x00\x00\x00\x00\x00\x04\x00\x00"
        b"\x00\x00\xff\xff\x00\x00\x00\x00\xff\xff\xff\x7f",
    ),
    (
        "Segment",
        0x06,
        0,
        {
            "epoch": 1,
            "index": 65535,
            "t_end": 5,
            "duration": 6,
            "seen": 7,
            "p": [1, 2, 3, 4],
            "v": [5, 6, 7, 8],
        },
        struct.pack("<HHIIIB8i", 1, 65535, 5, 6, 7, 4, 1, 2, 3, 4, 5, 6, 7, 8),
    ),
    (
        "CartesianSegment",
        0x0C,
        0,
        {
            "epoch": 0x0102,
            "index": 3,
            "t_end": 0xFFFFFFFF,
            "duration": 800,
            "seen": 0xFFFFFF00,
            "p": [2**31 - 1, -(2**31), -76_800_000],
            "v": [65_536, -1, 0],
        },
        struct.pack("<HHIII", 0x0102, 3, 0xFFFFFFFF, 800, 0xFFFFFF00)
        + struct.pack("<3i3i", 2**31 - 1, -(2**31), -76_800_000, 65_536, -1, 0),
    ),
    ("Keep", 0x07, 0, {"seen": 0x0A000B00}, b"\x00\x0b\x00\x0a"),
    ("Stop", 0x08, 0, {}, b""),
    ("EStop", 0x09, 0, {}, b""),
    ("Reset", 0x0A, 10, {}, b""),
    ("Tool", 0x0B, 11, {"on": True, "servo_angle": -0.5}, b"\x01\x00\x00\x00\xbf"),
    (
        "HelloReply",
        0x81,
        255,
        {
            "version": 1,
            "board": "STM32F407G-DISC1",
            "build": "1.0 ~",
            "joints": 3,
            "tick_hz": 200_000,
            "queue_places": 64,
            "boot": 0xDEADBEEF,
            "last_epoch": 41,
            "homed": True,
            "configuration": 0x00C0FFEE,
            "last_stop": 3,
        },
        b"\x01\x00"
        b"\x10STM32F407G-DISC1"
        b"\x051.0 ~"
        b"\x03"
        b"\x40\x0d\x03\x00"
        b"\x40\x00"
        b"\xef\xbe\xad\xde"
        b"\x29\x00"
        b"\x01"
        b"\xee\xff\xc0\x00"
        b"\x03",
    ),
    (
        "HelloReply",
        0x81,
        1,
        {
            "version": 65535,
            "board": "",
            "build": "x" * 31,
            "joints": 0,
            "tick_hz": 40_000,
            "queue_places": 1,
            "boot": 0,
            "last_epoch": 0,
            "homed": False,
            "configuration": 0,
            "last_stop": 10,
        },
        struct.pack("<HBB31sBIHIHBIB", 65535, 0, 31, b"x" * 31, 0, 40_000, 1, 0, 0, 0, 0, 10),
    ),
    ("Configured", 0x82, 2, {"configuration": 0x01FF00FF}, b"\xff\x00\xff\x01"),
    (
        "Refused",
        0x83,
        0,
        {"command": "segment", "reason": 9, "joint": 2, "index": 65534},
        b"\x06\x09\x02\xfe\xff",
    ),
    (
        "Refused",
        0x83,
        6,
        {"command": "arm", "reason": 3, "joint": None, "index": None},
        b"\x05\x03\xff\xff\xff",
    ),
    ("Done", 0x84, 5, {"command": "home"}, b"\x04"),
    (
        "Telemetry",
        0x85,
        0,
        {
            "now": 0x00FF00FF,
            "state": 2,
            "fault": 0,
            "epoch": 258,
            "last_index": 65535,
            "t_queue_end": 0xFFFFFFFF,
            "free": 64,
            "inputs": 0x31,
            "flags": 0b1111,
            "counts": [-1, 0, 1],
        },
        b"\xff\x00\xff\x00\x02\x00\x02\x01\xff\xff\xff\xff\xff\xff\x40\x00\x31\x0f\x03"
        b"\xff\xff\xff\xff\x00\x00\x00\x00\x01\x00\x00\x00",
    ),
    (
        "Telemetry",
        0x85,
        0,
        {
            "now": 1,
            "state": 6,
            "fault": 5,
            "epoch": 0,
            "last_index": 0,
            "t_queue_end": 1,
            "free": 0,
            "inputs": 0,
            "flags": 0,
            "counts": [],
        },
        struct.pack("<IBBHHIHBBB", 1, 6, 5, 0, 0, 1, 0, 0, 0, 0),
    ),
    (
        "Stopped",
        0x86,
        0,
        {"epoch": 7, "cause": 4, "now": 2**32 - 1, "counts": [2**31 - 1, -(2**31)]},
        b"\x07\x00\x04\xff\xff\xff\xff\x02\xff\xff\xff\x7f\x00\x00\x00\x80",
    ),
]

# Whole frames, with payloads that no message has: what the framing itself has to bear.
FRAMES: list[tuple[str, int, int, bytes]] = [
    ("253 bytes without a zero", 0x70, 1, b"\x01" * (253 - 6)),
    *((f"{n} ones in all", 0x70, 1, b"\x01" * (n - 6)) for n in range(252, 262)),
    *((f"{n} ones in all", 0x70, 1, b"\x01" * (n - 6)) for n in range(506, 516)),
    ("nothing but zeros", 0, 0, b"\0" * 300),
    ("the longest payload", 0x70, 1, bytes(i % 251 + 1 for i in range(512))),
    ("the longest payload, zeros in it", 0x70, 1, bytes(i % 256 for i in range(512))),
]

STOP = frame(0x08, 0, b"")


def flipped(data: bytes, at: int, bit: int) -> bytes:
    return data[:at] + bytes([data[at] ^ 1 << bit]) + data[at + 1 :]


# Frames that are dropped and counted.
DAMAGED: list[tuple[str, bytes]] = [
    ("too short for a CRC", stuff(b"\x08\x00\x01\x02\x03") + b"\0"),
    ("one byte", b"\x01\0"),
    ("a wrong CRC", stuff(b"\x08\x00\x01\x02\x03\x04") + b"\0"),
    ("a big-endian CRC", stuff(b"\x08\x00" + struct.pack(">I", crc32(b"\x08\x00"))) + b"\0"),
    ("a flipped bit", flipped(frame(0x07, 0, b"\x01\x02\x03\x04"), 4, 3)),
    ("a lost first byte", STOP[1:]),
    ("a lost middle byte", STOP[:3] + STOP[4:]),
    ("a doubled byte", STOP[:3] + STOP[2:]),
    ("a run that ends too soon", b"\x09\x08\x01\0"),
    ("a payload that is too long", frame(0x70, 1, b"\x01" * 513)),
    ("endless noise", b"\x55" * 5000 + b"\0"),
    ("text", b"Marlin 2.1 ready\r\n\0"),
]

# Whole frames whose payload is no message of its type, or whose type is none.
MALFORMED: list[tuple[str, int, bytes]] = [
    ("no such type", 0x7F, b""),
    ("type zero", 0x00, b""),
    ("too short", 0x01, b"\x01"),
    ("too long", 0x01, b"\x01\x00\x00"),
    ("something where there is nothing", 0x08, b"\x00"),
    ("a bool of two", 0x03, b"\x02"),
    ("a bool of 255", 0x0B, b"\xff\0\0\0\0"),
    ("five joints", 0x05, struct.pack("<HIB5i", 1, 2, 5, 1, 2, 3, 4, 5)),
    ("fewer counts than joints", 0x05, struct.pack("<HIB2i", 1, 2, 3, 1, 2)),
    ("more counts than joints", 0x05, struct.pack("<HIB3i", 1, 2, 2, 1, 2, 3)),
    ("no such kind of robot", 0x02, b"\x03\x03" + CONFIGURE_PAYLOAD[2:]),
    ("half a bool array", 0x02, CONFIGURE_PAYLOAD[:76] + b"\x02" + CONFIGURE_PAYLOAD[77:]),
    ("no such state", 0x85, struct.pack("<IBBHHIHBBB", 1, 7, 0, 0, 0, 1, 0, 0, 0, 0)),
    ("no such fault", 0x85, struct.pack("<IBBHHIHBBB", 1, 6, 7, 0, 0, 1, 0, 0, 0, 0)),
    ("no such cause", 0x86, struct.pack("<HBIB", 1, 11, 2, 0)),
    ("no such refusal", 0x83, b"\x06\x00\xff\xff\xff"),
    ("a refused command that is none", 0x83, b"\x0d\x01\xff\xff\xff"),
    ("done with what is no message", 0x84, b"\x00"),
    (
        "text of 32",
        0x81,
        struct.pack("<HB32sBBIHIHBIB", 1, 32, b"x" * 32, 0, 0, 1, 1, 0, 0, 0, 0, 10),
    ),
    (
        "text with a tab",
        0x81,
        struct.pack("<HB3sBBIHIHBIB", 1, 3, b"a\tb", 0, 0, 1, 1, 0, 0, 0, 0, 10),
    ),
    (
        "text with a zero",
        0x81,
        struct.pack("<HB3sBBIHIHBIB", 1, 3, b"a\0b", 0, 0, 1, 1, 0, 0, 0, 0, 10),
    ),
    ("text beyond the end", 0x81, struct.pack("<HB3s", 1, 31, b"abc")),
]


def table() -> dict[str, Any]:
    return {
        "messages": [
            {
                "message": name,
                "type": type_,
                "sequence": sequence,
                "fields": {k: _plain(v) for k, v in fields.items()},
                "payload": payload.hex(),
                "frame": frame(type_, sequence, payload).hex(),
            }
            for name, type_, sequence, fields, payload in MESSAGES
        ],
        "frames": [
            {
                "what": what,
                "type": type_,
                "sequence": sequence,
                "payload": payload.hex(),
                "frame": frame(type_, sequence, payload).hex(),
            }
            for what, type_, sequence, payload in FRAMES
        ],
        "damaged": [{"what": what, "bytes": data.hex()} for what, data in DAMAGED],
        "malformed": [
            {"what": what, "type": type_, "payload": payload.hex()}
            for what, type_, payload in MALFORMED
        ],
    }


def _plain(value: Any) -> Any:
    """JSON has no infinity."""
    if isinstance(value, list):
        return [_plain(item) for item in value]
    return ("inf" if value > 0 else "-inf") if value in (INF, -INF) else value


def text() -> str:
    return json.dumps(table(), indent=1) + "\n"


if __name__ == "__main__":
    OUT.write_text(text(), encoding="utf-8")
