"""What a device seems to be by what it sends."""

from __future__ import annotations

import pytest

from deltaviz.link.impression import Kind, Listener, text_in
from deltaviz.link.wire.frames import write_frame
from tests.link.strangers import (
    Deaf,
    Gps,
    Machine,
    OtherBaud,
    OtherVersion,
    echo,
    encode_hello,
    silent,
)

HELLO = write_frame(encode_hello()[0], 77, encode_hello()[1])


@pytest.mark.parametrize(
    ("stranger", "kind"),
    [
        (silent, Kind.NOTHING),
        (echo, Kind.ECHO),
        (Machine(), Kind.TEXT),
        (Gps(), Kind.TEXT),
        (OtherBaud(), Kind.NOISE),
        (OtherVersion(9), Kind.BOARD),
        (Deaf(), Kind.BOARD),
    ],
    ids=lambda x: getattr(x, "__name__", type(x).__name__),
)
def test_strangers_are_told_apart(stranger, kind: Kind) -> None:
    listener = Listener()
    for _ in range(20):
        for byte in stranger(HELLO):
            listener.hear(bytes([byte]))
    assert listener.impression.kind is kind


def test_a_text_is_quoted_by_its_longest_line() -> None:
    listener = Listener()
    listener.hear(Machine()(b""))
    assert listener.impression.sample == "Grbl 1.1h ['$' for help]"
    assert text_in(b"x" * 500) == "x" * 40


def test_few_or_odd_bytes_are_no_text() -> None:
    assert text_in(b"ok") is None
    assert text_in(b"\r\n\r\n") is None
    assert text_in(bytes(range(256))) is None


def test_a_boards_frame_settles_it_whatever_came_before_and_comes_after() -> None:
    listener = Listener()
    listener.hear(b"Bootloader 1.0\r\n\0" + write_frame(0x85, 0, b""))
    listener.hear(b"text and more text\r\n" * 20)
    assert listener.impression.kind is Kind.BOARD
