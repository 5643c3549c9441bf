"""`protocol.toml`, read and checked: the one description of every message."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Annotated, Literal

import msgspec  # quick to load, which the simulated board's process has to be
from msgspec import Meta, Struct

TEXT_MAX = 31  # characters
FRAME_OVERHEAD = 6  # bytes: type, sequence, CRC-32

_TYPE = re.compile(
    r"(?P<base>u8\??|u16\??|u32|i8|i32|f32|bool|message|text|joints|(enum|flags):(?P<of>\w+))"
    r"(\[(?P<count>joints|[1-9])\])?"
)
_SIZES = {"u16": 2, "u16?": 2, "u32": 4, "i32": 4, "f32": 4, "text": 1 + TEXT_MAX}  # else 1


@dataclass(frozen=True, slots=True)
class FieldType:
    """`base` is the part before a colon or bracket; `of` names an enumeration in messages.py;
    `count` is a number, "joints", or None for what is no array.
    """

    base: str
    of: str | None
    count: Literal["joints"] | int | None


class FieldDescription(Struct, frozen=True, forbid_unknown_fields=True):
    name: Annotated[str, Meta(pattern=r"^[a-z][a-z0-9_]*$")]
    type: str
    unit: str | None = None
    doc: str | None = None

    def __post_init__(self) -> None:
        if not _TYPE.fullmatch(self.type):
            raise ValueError(f"there is no type {self.type!r}")

    @property
    def parsed(self) -> FieldType:
        match = _TYPE.fullmatch(self.type)
        assert match is not None
        count = match["count"]
        return FieldType(
            base=match["base"].split(":")[0],
            of=match["of"],
            count="joints" if count == "joints" else int(count) if count else None,
        )


class MessageDescription(Struct, frozen=True, forbid_unknown_fields=True):
    name: Annotated[str, Meta(pattern=r"^[A-Z]\w*$")]
    type: Annotated[int, Meta(ge=0x01, le=0xFF)]
    sender: Literal["host", "board"] = msgspec.field(name="from")
    fields: tuple[FieldDescription, ...]

    def __post_init__(self) -> None:
        if (self.type >= 0x80) != (self.sender == "board"):
            raise ValueError(f"{self.name}: types from 0x80 on are the board's")
        counted = False
        for field in self.fields:
            parsed = field.parsed
            counted = counted or parsed.base == "joints"
            if parsed.count == "joints" and not counted:
                raise ValueError(f"{self.name}.{field.name}: its length stands behind it")

    @property
    def snake(self) -> str:
        """HelloReply: hello_reply, EStop: estop."""
        return re.sub(r"(?<=[a-z])(?=[A-Z])", "_", self.name).lower()

    def size_max(self, joints: int) -> int:
        """The longest payload, in bytes."""
        return sum(
            _SIZES.get(parsed.base, 1) * (joints if parsed.count == "joints" else parsed.count or 1)
            for parsed in (field.parsed for field in self.fields)
        )


class Description(Struct, frozen=True, forbid_unknown_fields=True):
    version: int
    joints_max: int
    payload_max: int
    command_repeat_ms: int
    message: tuple[MessageDescription, ...]
    meaning: dict[str, dict[str, str]] = msgspec.field(  # of the enumerations' values
        default_factory=dict[str, dict[str, str]]
    )

    def __post_init__(self) -> None:
        for values in ([m.name for m in self.message], [m.type for m in self.message]):
            if len(set(values)) != len(values):
                raise ValueError(f"not unique: {values}")
        for message in self.message:
            if message.size_max(self.joints_max) > self.payload_max:
                raise ValueError(f"{message.name} may become longer than a payload")


@cache
def load_description() -> Description:
    text = Path(__file__).with_name("protocol.toml").read_bytes()
    return msgspec.toml.decode(text, type=Description)
