"""The tables of docs/protocol.md: messages, their fields, and what their values mean."""

from __future__ import annotations

import inspect
from enum import IntEnum, IntFlag

from deltaviz.link import messages
from deltaviz.link.wire.description import (
    Description,
    FieldDescription,
    MessageDescription,
    load_description,
)
from deltaviz.link.wire.frames import ENCODED_MAX


def message_tables(sender: str) -> str:
    """All messages of "host" or "board", each with what it is for and a table of its fields."""
    description = load_description()
    chosen = [message for message in description.message if message.sender == sender]
    return "\n\n".join(_message(message, description) for message in chosen)


def general() -> str:
    """The module's own words, which hold for all messages."""
    return inspect.cleandoc(messages.__doc__ or "").split("\n\n", 1)[1]


def numbers() -> str:
    description = load_description()
    rows = [
        ("protocol version", str(description.version)),
        ("joints", f"up to {description.joints_max}"),
        ("payload", f"up to {description.payload_max} bytes"),
        ("encoded frame", f"up to {ENCODED_MAX} bytes and the zero byte"),
        ("a command is repeated every", f"{description.command_repeat_ms} ms"),
    ]
    return _table(("", ""), rows)


def enumerations() -> str:
    meaning = load_description().meaning
    return "\n\n".join(_enumeration(name, values) for name, values in meaning.items())


def _message(message: MessageDescription, description: Description) -> str:
    kind = getattr(messages, message.name)
    most = message.size_max(description.joints_max)
    size = f"at most {most} byte{'s' if most > 1 else ''}" if most else "no payload"
    parts = [
        f"### {message.name}: 0x{message.type:02X}, {size}",
        inspect.cleandoc(kind.__doc__ or ""),
    ]
    if message.fields:
        rows = [_field(field) for field in message.fields]
        parts.append(_table(("field", "type", "unit", ""), rows))
    return "\n\n".join(parts)


def _field(field: FieldDescription) -> tuple[str, str, str, str]:
    return f"`{field.name}`", f"`{field.type}`", field.unit or "", field.doc or ""


def _enumeration(name: str, meaning: dict[str, str]) -> str:
    kind: type[IntEnum | IntFlag] = getattr(messages, name)
    shown = "0x{:02X}" if issubclass(kind, IntFlag) else "{}"
    rows = [
        (shown.format(member.value), f"`{member.name}`", meaning[str(member.name)])
        for member in kind.__members__.values()
    ]
    said = inspect.cleandoc(kind.__doc__ or "")
    return "\n\n".join(filter(None, [f"### {name}", said, _table(("", "", "meaning"), rows)]))


def _table(head: tuple[str, ...], rows: list[tuple[str, ...]]) -> str:
    lines = [head, tuple("---" for _ in head), *rows]
    return "\n".join("| " + " | ".join(cell for cell in line) + " |" for line in lines)
