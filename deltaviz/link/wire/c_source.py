"""The C codec, written out from the description and the enumerations in messages.py."""

from __future__ import annotations

from collections.abc import Iterator
from enum import IntEnum, IntFlag
from string import Template

from deltaviz.link import messages as m
from deltaviz.link.wire.description import (
    TEXT_MAX,
    Description,
    FieldDescription,
    MessageDescription,
)

# The name of the type in C, and what its values begin with.
_ENUMS: dict[type[IntEnum | IntFlag], tuple[str, str]] = {
    m.BoardState: ("board_state", "STATE"),
    m.StopCause: ("stop_cause", "CAUSE"),
    m.Fault: ("fault", "FAULT"),
    m.Refusal: ("refusal", "REFUSAL"),
    m.Inputs: ("inputs", "INPUT"),
    m.TelemetryFlags: ("telemetry_flags", "FLAG"),
    m.RobotKind: ("robot_kind", "KIND"),
    m.Options: ("options", "OPTION"),
}
_TYPES = {
    "u16": "uint16_t",
    "u32": "uint32_t",
    "i8": "int8_t",
    "i32": "int32_t",
    "f32": "float",
    "bool": "bool",
    "u8?": "int16_t",
    "u16?": "int32_t",
}  # else uint8_t
_CALLS = {"u8?": "optional_u8", "u16?": "optional_u16"} | {
    base: base for base in ("u16", "u32", "i8", "i32", "f32", "bool")
}  # else u8

_HEADER = Template("""\
$notice
#ifndef DV_MESSAGES_H
#define DV_MESSAGES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define DV_PROTOCOL_VERSION $version
#define DV_JOINTS_MAX $joints_max
#define DV_PAYLOAD_MAX $payload_max /* bytes */
#define DV_COMMAND_REPEAT_MS $repeat_ms
#define DV_TEXT_MAX $text_max /* characters, without the NUL */

$enums

/* The longest payloads, in bytes. */
$sizes

$structs

/* False: malformed. Entries beyond `joints` are zero. What is -1 stands for "none". */
$decoders

/* The length of the payload; 0: no room, or values that the message cannot carry. */
$encoders

#endif
""")
_SOURCE = Template("""\
$notice
#include "messages.h"

#include "bytes.h"

#include <float.h>

_Static_assert(sizeof(float) == 4 && FLT_MANT_DIG == 24 && FLT_MAX_EXP == 128, "not IEEE 754");
_Static_assert(DV_TEXT_MAX < UINT8_MAX && DV_JOINTS_MAX <= 8, "too much for a byte");
$asserts

$checks

$codecs
""")
_NOTICE = (
    "/* Made from deltaviz/link/wire/protocol.toml by `python -m deltaviz.link.wire.generate`. */"
)


def header(description: Description) -> str:
    messages = description.message
    full = [message for message in messages if message.fields]
    joints = description.joints_max
    return _HEADER.substitute(
        notice=_NOTICE,
        version=description.version,
        joints_max=joints,
        payload_max=description.payload_max,
        repeat_ms=description.command_repeat_ms,
        text_max=TEXT_MAX,
        enums="\n\n".join([_type_enum(messages), *map(_enum, _ENUMS)]),
        sizes="\n".join(f"#define {_size_name(x)} {x.size_max(joints)}" for x in full),
        structs="\n\n".join(_struct(message) for message in full),
        decoders="\n".join(f"{_decoder(message)};" for message in messages),
        encoders="\n".join(f"{_encoder(message)};" for message in full),
    )


def source(description: Description) -> str:
    messages = description.message
    full = [message for message in messages if message.fields]
    plain = [enum for enum in _ENUMS if issubclass(enum, IntEnum)]
    checks = [
        _check("type", [f"DV_{message.snake.upper()}" for message in messages]),
        *(_check(_ENUMS[enum][0], [_value_name(value) for value in enum]) for enum in plain),
    ]
    codecs: list[str] = []
    for message in messages:
        codecs.append(_decode(message) if message.fields else _decode_empty(message))
        codecs.extend([_encode(message)] if message.fields else [])
    return _SOURCE.substitute(
        notice=_NOTICE,
        asserts="\n".join(
            f'_Static_assert({_size_name(x)} <= DV_PAYLOAD_MAX, "{x.name} is too long");'
            for x in full
        ),
        checks="\n\n".join(checks),
        codecs="\n\n".join(codecs),
    )


# Names.


def _size_name(message: MessageDescription) -> str:
    return f"DV_{message.snake.upper()}_SIZE_MAX"


def _value_name(value: IntEnum | IntFlag) -> str:
    return f"DV_{_ENUMS[type(value)][1]}_{value.name}"


def _decoder(message: MessageDescription) -> str:
    into = f", struct dv_{message.snake} *message" if message.fields else ""
    return f"bool dv_decode_{message.snake}(const uint8_t *payload, size_t size{into})"


def _encoder(message: MessageDescription) -> str:
    name = message.snake
    return (
        f"size_t dv_encode_{name}(const struct dv_{name} *message, uint8_t *payload, size_t room)"
    )


# Enumerations.


def _type_enum(messages: tuple[MessageDescription, ...]) -> str:
    values = [f"    DV_{message.snake.upper()} = 0x{message.type:02X}," for message in messages]
    return "\n".join(["enum dv_type {", *values, "};"])


def _enum(enum: type[IntEnum | IntFlag]) -> str:
    values = [f"    {_value_name(value)} = {value.value}," for value in enum.__members__.values()]
    return "\n".join([f"enum dv_{_ENUMS[enum][0]} {{", *values, "};"])


def _check(name: str, values: list[str]) -> str:
    cases = [f"    case {value}:" for value in values]
    body = ["    switch (value) {", *cases, "        return true;", "    default:"]
    head = f"static bool is_{name}(uint8_t value)"
    return "\n".join([head, "{", *body, "        return false;", "    }", "}"])


def _check_of(field: FieldDescription) -> str | None:
    """The function that knows which values a field may have."""
    parsed = field.parsed
    if parsed.base == "message":
        return "is_type"
    return f"is_{_ENUMS[getattr(m, parsed.of or '')][0]}" if parsed.base == "enum" else None


# Messages.


def _struct(message: MessageDescription) -> str:
    return "\n".join([f"struct dv_{message.snake} {{", *map(_member, message.fields), "};"])


def _member(field: FieldDescription) -> str:
    parsed = field.parsed
    if parsed.base == "text":
        declared = f"char {field.name}[DV_TEXT_MAX + 1]"
    else:
        count = "DV_JOINTS_MAX" if parsed.count == "joints" else parsed.count
        length = "" if count is None else f"[{count}]"
        declared = f"{_TYPES.get(parsed.base, 'uint8_t')} {field.name}{length}"
    notes = [note for note in (field.unit, field.doc) if note]
    if parsed.of:
        notes.insert(0, f"enum dv_{_ENUMS[getattr(m, parsed.of)][0]}")
    note = f"/* {'; '.join(notes)} */" if notes else ""
    line = f"    {declared}; {note}".rstrip()
    return line if len(line) <= 100 else f"    {note}\n    {declared};"


def _decode(message: MessageDescription) -> str:
    return "\n".join(
        [
            _decoder(message),
            "{",
            "    struct dv_reader reader = {payload, size, true};",
            "    memset(message, 0, sizeof *message);",
            *(line for field in message.fields for line in _read(field)),
            "    return dv_read_all(&reader);",
            "}",
        ]
    )


def _decode_empty(message: MessageDescription) -> str:
    body = ["{", "    (void)payload;", "    return size == 0;", "}"]
    return "\n".join([_decoder(message), *body])


def _encode(message: MessageDescription) -> str:
    return "\n".join(
        [
            _encoder(message),
            "{",
            "    struct dv_writer writer = {payload, room, true};",
            *(line for field in message.fields for line in _write(field)),
            "    return writer.good ? room - writer.left : 0;",
            "}",
        ]
    )


def _read(field: FieldDescription) -> Iterator[str]:
    base, name = field.parsed.base, f"message->{field.name}"
    if base == "text":
        yield f"    dv_read_text(&reader, {name}, sizeof {name});"
    elif base == "joints":
        yield f"    {name} = dv_read_count(&reader, DV_JOINTS_MAX);"
    else:
        yield from _each(field, f"{{}} = dv_read_{_CALLS.get(base, 'u8')}(&reader);")
    if check := _check_of(field):
        yield f"    reader.good = reader.good && {check}({name});"


def _write(field: FieldDescription) -> Iterator[str]:
    base, name = field.parsed.base, f"message->{field.name}"
    if check := _check_of(field):
        yield f"    writer.good = writer.good && {check}({name});"
    if base == "text":
        yield f"    dv_write_text(&writer, {name}, sizeof {name});"
    elif base == "joints":
        yield f"    size_t joints = dv_write_count(&writer, {name}, DV_JOINTS_MAX);"
    else:
        yield from _each(field, f"dv_write_{_CALLS.get(base, 'u8')}(&writer, {{}});", "joints")


def _each(
    field: FieldDescription, statement: str, joints: str = "message->joints"
) -> Iterator[str]:
    count, name = field.parsed.count, f"message->{field.name}"
    if count is None:
        yield f"    {statement.format(name)}"
        return
    most = joints if count == "joints" else str(count)
    yield f"    for (size_t i = 0; i < {most}; i++) {{"
    yield f"        {statement.format(f'{name}[i]')}"
    yield "    }"
