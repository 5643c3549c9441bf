"""A place to listen: what is put around a link's stream before messages are made of it."""

from __future__ import annotations

from collections.abc import Callable

from deltaviz.link.wire.stream import ByteStream

Tap = Callable[[ByteStream], ByteStream]


def untapped(stream: ByteStream) -> ByteStream:
    return stream
