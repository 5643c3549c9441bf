"""What the numbers in a payload mean.

A conversion is a pair of functions: from a number to its value, and back; both raise KeyError or
ValueError for what the field does not have.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from enum import IntEnum, IntFlag
from typing import Any, NamedTuple

from deltaviz.link import messages
from deltaviz.link.wire.description import TEXT_MAX, Description, FieldType

CODES = {"u16": "H", "u16?": "H", "u32": "I", "i8": "b", "i32": "i", "f32": "f"}  # else B

_PRINTABLE = re.compile(rb"[ -~]*")


class Conversion(NamedTuple):
    decode: Callable[[Any], Any]
    encode: Callable[[Any], Any]


def conversion_of(field: FieldType, description: Description) -> Conversion | None:
    """None where the number is the value."""
    if field.base == "text":
        return Conversion(_text, _bytes)
    if field.base == "bool":
        return _table({0: False, 1: True})
    if field.base == "message":
        return _table({message.type: message.name.lower() for message in description.message})
    if field.base == "u8?":
        return _optional(0xFF)
    if field.base == "u16?":
        return _optional(0xFFFF)
    if field.of is None:
        return None
    kind: type[IntEnum | IntFlag] = getattr(messages, field.of)
    if field.base == "flags":
        return _table({bits: kind(bits) for bits in range(256)})
    return _table({member.value: member for member in kind.__members__.values()})


def _table(values: dict[int, Any]) -> Conversion:
    numbers = {value: number for number, value in values.items()}
    return Conversion(values.__getitem__, numbers.__getitem__)


def _optional(none: int) -> Conversion:
    def decode(number: int) -> int | None:
        return None if number == none else number

    def encode(value: int | None) -> int:
        if value == none:
            raise ValueError(f"{value} stands for none")
        return none if value is None else value

    return Conversion(decode, encode)


def _text(data: bytes) -> str:
    if len(data) > TEXT_MAX or _PRINTABLE.fullmatch(data) is None:
        raise ValueError(f"{data!r} is no text")
    return data.decode("ascii")


def _bytes(text: str) -> bytes:
    data = text.encode("ascii")
    _text(data)
    return data
