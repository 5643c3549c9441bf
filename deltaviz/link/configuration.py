"""What a board is told about its robot, and the number by which both sides name it."""

from __future__ import annotations

import hashlib
import struct
from collections.abc import Iterator
from dataclasses import fields
from typing import TYPE_CHECKING

from deltaviz.link.messages import Configure

if TYPE_CHECKING:  # the simulated board's process needs the hash, and none of the robots' imports
    pass


def configuration_hash(configure: Configure) -> int:
    """A number from 1 to 2^32 - 1 that is the same for equal values, on every machine."""
    digest = hashlib.sha256()
    for field in fields(configure):
        digest.update(field.name.encode())
        for part in _parts(getattr(configure, field.name)):
            digest.update(part)
    return int.from_bytes(digest.digest()[:4], "little") or 1


def _parts(value: object) -> Iterator[bytes]:
    if value is None:
        yield b"-"
    elif isinstance(value, str):
        yield b"s%d:" % len(value) + value.encode()
    elif isinstance(value, bool | int | float):
        yield b"f" + struct.pack("<d", value + 0.0)  # + 0.0: the two zeros are equal
    elif isinstance(value, tuple):
        yield b"("
        for item in value:  # pyright: ignore[reportUnknownVariableType]
            yield from _parts(item)  # pyright: ignore[reportUnknownArgumentType]
        yield b")"
    else:
        raise TypeError(f"a configuration has no {type(value).__name__}")
