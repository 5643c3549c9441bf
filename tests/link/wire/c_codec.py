"""The C codec, called from Python: structs by ctypes, made from the description."""

from __future__ import annotations

import ctypes as c
import subprocess
from dataclasses import fields
from enum import IntEnum, IntFlag
from pathlib import Path
from typing import Any

from deltaviz.link import messages
from deltaviz.link.wire.description import (
    TEXT_MAX,
    FieldDescription,
    MessageDescription,
    load_description,
)
from deltaviz.link.wire.generate import CORE

_TYPES: dict[str, Any] = {
    "u16": c.c_uint16,
    "u32": c.c_uint32,
    "i8": c.c_int8,
    "i32": c.c_int32,
    "f32": c.c_float,
    "bool": c.c_bool,
    "u8?": c.c_int16,
    "u16?": c.c_int32,
    "text": c.c_char * (TEXT_MAX + 1),
}  # else uint8_t
_DESCRIPTION = load_description()
_BY_TYPE = {message.type: message for message in _DESCRIPTION.message}
_NAMES = {message.type: message.name.lower() for message in _DESCRIPTION.message}


class Frame(c.Structure):
    _fields_ = (
        ("type", c.c_uint8),
        ("sequence", c.c_uint8),
        ("payload", c.POINTER(c.c_uint8)),
        ("size", c.c_size_t),
    )


class Reader(c.Structure):
    _fields_ = (
        ("dropped", c.c_uint32),
        ("size", c.c_size_t),
        ("block", c.c_uint8),
        ("zero", c.c_bool),
        ("begun", c.c_bool),
        ("bytes", c.c_uint8 * (_DESCRIPTION.payload_max + 6)),
    )


def build(folder: Path, *options: str) -> Path:
    sources = [str(CORE / name) for name in ("messages.c", "frames.c")]
    out = folder / "codec.so"
    subprocess.run(
        ["gcc", "-std=c11", "-O2", "-shared", "-fPIC", *options, *sources, "-o", str(out)],
        check=True,
    )
    return out


class CCodec:
    def __init__(self, library: Path) -> None:
        self._c = c.CDLL(str(library))
        self._structs = {m.type: _struct(m) for m in _DESCRIPTION.message}

    # Frames.

    def write_frame(self, type_: int, sequence: int, payload: bytes, room: int = 2000) -> bytes:
        out = (c.c_uint8 * room)()
        write = self._c.dv_frame_write
        write.restype = c.c_size_t
        size = write(type_, sequence, payload, c.c_size_t(len(payload)), out, c.c_size_t(room))
        return bytes(out[:size])

    def read(self, data: bytes) -> tuple[list[tuple[int, int, bytes]], int]:
        """The frames in `data`, and how many were dropped."""
        reader, frame, frames = Reader(), Frame(), []
        self._c.dv_frame_reader_init(c.byref(reader))
        read = self._c.dv_frame_read
        read.restype = c.c_bool
        for byte in data:
            if read(c.byref(reader), c.c_uint8(byte), c.byref(frame)):
                payload = bytes(frame.payload[: frame.size])
                frames.append((frame.type, frame.sequence, payload))
        return frames, reader.dropped

    # Messages.

    def encode(self, message: Any) -> bytes:
        """Empty: it could not."""
        described = next(m for m in _DESCRIPTION.message if m.name == type(message).__name__)
        if not described.fields:
            return b""
        struct = self._structs[described.type]()
        for field in described.fields:
            _put(struct, field, message)
        return self._encode(described, struct, _DESCRIPTION.payload_max)

    def encode_into(self, message: MessageDescription, payload: bytes, room: int) -> bytes:
        """What `payload` is when it is decoded and encoded again, into `room` bytes."""
        struct = self._structs[message.type]()
        assert self._decode(message, payload, struct)
        return self._encode(message, struct, room)

    def _encode(self, message: MessageDescription, struct: Any, room: int) -> bytes:
        out = (c.c_uint8 * room)()
        encode = getattr(self._c, f"dv_encode_{message.snake}")
        encode.restype = c.c_size_t
        return bytes(out[: encode(c.byref(struct), out, c.c_size_t(room))])

    def decode(self, type_: int, payload: bytes) -> Any:
        """The message, or None for a malformed payload and for an unknown type."""
        message = _BY_TYPE.get(type_)
        if message is None:
            return None
        struct = self._structs[type_]()
        if not self._decode(message, payload, struct):
            return None
        kind = getattr(messages, message.name)
        described = {field.name: field for field in message.fields}
        return kind(*(_get(struct, described[field.name]) for field in fields(kind)))

    def _decode(self, message: MessageDescription, payload: bytes, struct: Any) -> bool:
        decode = getattr(self._c, f"dv_decode_{message.snake}")
        decode.restype = c.c_bool
        into = (c.byref(struct),) if message.fields else ()
        return bool(decode(payload, c.c_size_t(len(payload)), *into))


def _struct(message: MessageDescription) -> type[c.Structure]:
    members: list[tuple[str, Any]] = []
    for field in message.fields:
        parsed = field.parsed
        kind = _TYPES.get(parsed.base, c.c_uint8)
        if parsed.count is not None:
            kind = kind * (_DESCRIPTION.joints_max if parsed.count == "joints" else parsed.count)
        members.append((field.name, kind))
    return type(message.name, (c.Structure,), {"_fields_": members})


def _put(struct: Any, field: FieldDescription, message: Any) -> None:
    parsed = field.parsed
    if parsed.base == "joints":
        return
    value = getattr(message, field.name)
    if parsed.count == "joints":
        struct.joints = len(value)
    if parsed.count is not None:
        getattr(struct, field.name)[: len(value)] = value
    elif parsed.base == "text":
        setattr(struct, field.name, value.encode())
    elif parsed.base == "message":
        setattr(struct, field.name, {name: t for t, name in _NAMES.items()}[value])
    else:
        setattr(struct, field.name, -1 if value is None else value)


def _get(struct: Any, field: FieldDescription) -> Any:
    parsed = field.parsed
    value = getattr(struct, field.name)
    if parsed.count is not None:
        return tuple(value[: struct.joints if parsed.count == "joints" else parsed.count])
    if parsed.base == "text":
        return value.decode()
    if parsed.base == "message":
        return _NAMES[value]
    if parsed.base.endswith("?"):
        return None if value == -1 else value
    if parsed.of is not None:
        kind: type[IntEnum | IntFlag] = getattr(messages, parsed.of)
        return kind(value)
    return value
