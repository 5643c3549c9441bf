"""Messages to payloads and back, as the description says; formats are compiled once."""

from __future__ import annotations

import struct
from dataclasses import fields
from typing import Any, NamedTuple

from deltaviz.link import messages
from deltaviz.link.messages import BoardMessage, HostMessage
from deltaviz.link.wire.conversions import CODES, conversion_of
from deltaviz.link.wire.description import (
    TEXT_MAX,
    Description,
    MessageDescription,
    load_description,
)
from deltaviz.link.wire.errors import Malformed, Unsendable
from deltaviz.link.wire.layout import Layout

Message = HostMessage | BoardMessage


class _Counter(NamedTuple):
    """A field that says how long others are, and how to come to it from the counter before."""

    is_text: bool
    most: int
    fixed: int  # bytes between
    per_joint: int  # and as many more for each joint
    measured: int  # which value has this length


class MessageCodec:
    """One kind of message."""

    def __init__(self, message: MessageDescription, description: Description) -> None:
        self.type = message.type
        self.sender = message.sender
        self.kind: type[Any] = getattr(messages, message.name)
        self._fields = message.fields
        self._conversions = [conversion_of(f.parsed, description) for f in message.fields]
        self._names = [field.name for field in message.fields if field.parsed.base != "joints"]
        if self._names != [field.name for field in fields(self.kind)]:
            raise TypeError(f"{message.name} has other fields than its description")
        self._counters = list(_counters(message, description))
        self._layouts: dict[tuple[int, ...], Layout] = {}

    def encode(self, message: Message) -> bytes:
        try:
            values = [getattr(message, name) for name in self._names]
            counts = tuple([len(values[counter.measured]) for counter in self._counters])
            self._check(counts)
            return self._layout(counts).encode(values)
        except (struct.error, OverflowError, LookupError, ValueError, TypeError) as error:
            raise Unsendable(f"{message} cannot be sent: {error}") from error

    def decode(self, payload: bytes) -> Any:
        try:
            return self.kind(*self._layout(self._count(payload)).decode(payload))
        except (struct.error, LookupError, ValueError) as error:
            raise Malformed(f"{self.kind.__name__}: {error}") from error

    def _count(self, payload: bytes) -> tuple[int, ...]:
        counts: list[int] = []
        at = joints = 0
        for counter in self._counters:
            at += counter.fixed + counter.per_joint * joints
            count = payload[at]
            counts.append(count)
            at += 1
            if counter.is_text:
                at += count
            else:
                joints = count
        found = tuple(counts)
        self._check(found)
        return found

    def _check(self, counts: tuple[int, ...]) -> None:
        for counter, count in zip(self._counters, counts, strict=True):
            if count > counter.most:
                raise ValueError(f"{count} where there may be {counter.most}")

    def _layout(self, counts: tuple[int, ...]) -> Layout:
        layout = self._layouts.get(counts)
        if layout is None:
            layout = self._layouts[counts] = Layout(self._fields, self._conversions, counts)
        return layout


def _counters(message: MessageDescription, description: Description) -> list[_Counter]:
    counters: list[_Counter] = []
    fixed = per_joint = measured = 0
    arrays = [f for f in message.fields if f.parsed.base != "joints"]
    first = next((i for i, f in enumerate(arrays) if f.parsed.count == "joints"), 0)
    for field in message.fields:
        parsed = field.parsed
        is_text = parsed.base == "text"
        if is_text or parsed.base == "joints":
            most = TEXT_MAX if is_text else description.joints_max
            counters.append(
                _Counter(is_text, most, fixed, per_joint, measured if is_text else first)
            )
            fixed = per_joint = 0
        elif parsed.count == "joints":
            per_joint += struct.calcsize("<" + CODES.get(parsed.base, "B"))
        else:
            fixed += struct.calcsize("<" + CODES.get(parsed.base, "B")) * (parsed.count or 1)
        measured += parsed.base != "joints"
    return counters


def _codecs(description: Description) -> dict[int, MessageCodec]:
    return {m.type: MessageCodec(m, description) for m in description.message}


_BY_TYPE = _codecs(load_description())
_BY_KIND = {codec.kind: codec for codec in _BY_TYPE.values()}


def encode(message: Message) -> tuple[int, bytes]:
    """Its type and payload. Raises Unsendable."""
    codec = _BY_KIND[type(message)]
    return codec.type, codec.encode(message)


def type_of(kind: type[Message]) -> int:
    return _BY_KIND[kind].type


def decode_host(type_: int, payload: bytes) -> HostMessage:
    """A message from a host. Raises Malformed, also for one that only a board sends."""
    return _decode("host", type_, payload)


def decode_board(type_: int, payload: bytes) -> BoardMessage:
    """A message from a board. Raises Malformed, also for one that only a host sends."""
    return _decode("board", type_, payload)


def _decode(sender: str, type_: int, payload: bytes) -> Any:
    codec = _BY_TYPE.get(type_)
    if codec is None or codec.sender != sender:
        raise Malformed(f"a {sender} has no messages of type {type_:#04x}")
    return codec.decode(payload)
