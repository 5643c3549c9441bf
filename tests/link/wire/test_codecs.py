"""Both codecs, in Python and in C, against one table of bytes, and against each other."""

from __future__ import annotations

import importlib.util
import json
import math
import random
import subprocess
from dataclasses import fields, replace
from enum import IntEnum, IntFlag
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from deltaviz.link import messages as m
from deltaviz.link.wire.codec import decode_board, decode_host, encode
from deltaviz.link.wire.description import FieldDescription, load_description
from deltaviz.link.wire.errors import Malformed, Unsendable
from deltaviz.link.wire.frames import FrameReader, write_frame
from deltaviz.link.wire.generate import CORE


def _beside(name: str) -> Any:
    spec = importlib.util.spec_from_file_location(name, Path(__file__).with_name(f"{name}.py"))
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


golden, c_codec = _beside("golden"), _beside("c_codec")
TABLE = json.loads((Path(__file__).parents[2] / "data" / "frames.json").read_text())
DESCRIPTION = load_description()
PROGRAM = Path(__file__).with_name("codec_program.c")
QUIET = settings(
    deadline=None,
    derandomize=True,
    max_examples=300,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)


def names(entries: list[Any]) -> list[str]:
    return [entry.get("what") or entry["message"] for entry in entries]


def message_of(entry: dict[str, Any]) -> Any:
    """The message that an entry of the table describes."""
    kind = getattr(m, entry["message"])
    described = {d.name: d for d in DESCRIPTION.message}[entry["message"]]
    values = dict(entry["fields"])
    for field in described.fields:
        parsed = field.parsed
        if parsed.of is not None:
            values[field.name] = getattr(m, parsed.of)(values[field.name])
        elif parsed.count is not None:
            values[field.name] = tuple(map(_number, values[field.name]))
        elif parsed.base != "joints" or field.name in values:
            values[field.name] = _number(values[field.name])
    return kind(**values)


def _number(value: Any) -> Any:
    return float(value) if value in ("inf", "-inf") else value


class PythonCodec:
    def write_frame(self, type_: int, sequence: int, payload: bytes) -> bytes:
        return write_frame(type_, sequence, payload)

    def read(self, data: bytes, *, pieces: int = 1) -> tuple[list[tuple[int, int, bytes]], int]:
        reader = FrameReader()
        frames = []
        for start in range(0, len(data), pieces):
            frames += [tuple(frame) for frame in reader.feed(data[start : start + pieces])]
        return frames, reader.dropped

    def encode(self, message: Any) -> bytes:
        try:
            return encode(message)[1]
        except Unsendable:
            return b""

    def decode(self, type_: int, payload: bytes) -> Any:
        try:
            return (decode_board if type_ >= 0x80 else decode_host)(type_, payload)
        except Malformed:
            return None


class WholePythonCodec(PythonCodec):
    def read(self, data: bytes, *, pieces: int = 1 << 20) -> Any:
        return super().read(data, pieces=pieces)


@pytest.fixture(scope="module")
def c(tmp_path_factory: pytest.TempPathFactory) -> Any:
    return c_codec.CCodec(c_codec.build(tmp_path_factory.mktemp("codec")))


@pytest.fixture(params=["Python", "Python, byte by byte", "C"])
def codec(request: pytest.FixtureRequest, c: Any) -> Any:
    """C is byte by byte at any rate."""
    if request.param == "C":
        return c
    return PythonCodec() if "byte" in request.param else WholePythonCodec()


# The table.


def test_the_table_is_what_its_script_writes():
    assert json.loads(golden.text()) == TABLE


def test_every_message_is_in_the_table():
    assert {e["message"] for e in TABLE["messages"]} == {d.name for d in DESCRIPTION.message}


@pytest.mark.parametrize("entry", TABLE["messages"], ids=names(TABLE["messages"]))
def test_a_message_is_these_bytes(codec, entry):
    message, payload = message_of(entry), bytes.fromhex(entry["payload"])
    assert codec.encode(message) == payload
    assert codec.decode(entry["type"], payload) == message


@pytest.mark.parametrize(
    "entry",
    [*TABLE["messages"], *TABLE["frames"]],
    ids=names([*TABLE["messages"], *TABLE["frames"]]),
)
def test_a_frame_is_these_bytes(codec, entry):
    frame, payload = bytes.fromhex(entry["frame"]), bytes.fromhex(entry["payload"])
    number = (entry["type"], entry["sequence"])
    assert codec.write_frame(*number, payload) == frame
    assert frame.index(0) == len(frame) - 1
    assert codec.read(frame) == ([(*number, payload)], 0)
    assert codec.read(frame[:-1]) == ([], 0)
    # A begun frame behind it, and one that nobody ended before it.
    assert codec.read(frame + frame[:-1]) == ([(*number, payload)], 0)
    assert codec.read(frame[1:-1] + b"\0" + frame) == ([(*number, payload)], 1)


@pytest.mark.parametrize("entry", TABLE["damaged"], ids=names(TABLE["damaged"]))
def test_what_is_no_frame_is_dropped_and_counted(codec, entry):
    data = bytes.fromhex(entry["bytes"])
    assert codec.read(data) == ([], 1)
    assert codec.read(golden.STOP + data + golden.STOP) == ([(0x08, 0, b"")] * 2, 1)


@pytest.mark.parametrize("entry", TABLE["malformed"], ids=names(TABLE["malformed"]))
def test_what_is_no_message_is_malformed(codec, entry):
    assert codec.decode(entry["type"], bytes.fromhex(entry["payload"])) is None


def test_zeros_between_frames_are_nothing(codec):
    assert codec.read(b"\0\0" + golden.STOP + b"\0\0\0" + golden.STOP) == (
        [(0x08, 0, b"")] * 2,
        0,
    )


def test_with_garbage_between_all_frames_arrive(codec):
    """Noise ends with a zero, or spoils the frame behind it and nothing else."""
    noise = random.Random(5)
    data, expected, dropped = b"", [], 0
    for entry in [*TABLE["messages"], *TABLE["frames"]]:
        junk = bytes(noise.randrange(1, 256) for _ in range(noise.randrange(1, 700)))
        data += junk + b"\0" + bytes.fromhex(entry["frame"])
        dropped += 1
        expected.append((entry["type"], entry["sequence"], bytes.fromhex(entry["payload"])))
    assert codec.read(data) == (expected, dropped)


def test_no_flipped_bit_goes_unnoticed(codec):
    frame = bytes.fromhex(TABLE["messages"][6]["frame"])
    for at in range(len(frame)):
        for bit in range(8):
            frames, _ = codec.read(golden.flipped(frame, at, bit) + golden.STOP)
            assert frames in ([(0x08, 0, b"")], []), (at, bit)


def test_a_payload_that_is_too_long_is_not_framed(c):
    assert c.write_frame(0x70, 1, bytes(513)) == b""
    with pytest.raises(Unsendable, match="513 bytes"):
        write_frame(0x70, 1, bytes(513))


def test_c_writes_nothing_where_there_is_no_room(c):
    frame = c.write_frame(0x70, 1, b"\1" * 40)
    assert c.write_frame(0x70, 1, b"\1" * 40, room=len(frame)) == frame
    assert c.write_frame(0x70, 1, b"\1" * 40, room=len(frame) - 1) == b""
    for entry in TABLE["messages"]:
        payload = bytes.fromhex(entry["payload"])
        message = next(d for d in DESCRIPTION.message if d.name == entry["message"])
        if payload:
            assert c.encode_into(message, payload, len(payload)) == payload
            assert c.encode_into(message, payload, len(payload) - 1) == b""


# Values that a message cannot carry.

SEGMENT = m.Segment(1, 2, 3, 4, 5, (6, 7), (8, 9))
REFUSED = m.Refused("arm", m.Refusal.STATE)


@pytest.mark.parametrize(
    "message",
    [
        replace(SEGMENT, epoch=65536),
        replace(SEGMENT, index=-1),
        replace(SEGMENT, p=(2**31, 0)),
        replace(SEGMENT, p=(1, 2, 3)),
        replace(SEGMENT, p=(1,) * 5, v=(1,) * 5),
        replace(SEGMENT, v=(0.5, 1)),
        m.Tool(on=True, servo_angle=1e39),
        m.Tool(on=2, servo_angle=0.0),  # type: ignore[arg-type]
        replace(REFUSED, command="dance"),
        replace(REFUSED, reason=0),  # type: ignore[arg-type]
        replace(REFUSED, joint=255),
        replace(REFUSED, joint=-1),
        replace(REFUSED, index=65535),
    ],
    ids=str,
)
def test_what_does_not_fit_is_not_sent(message):
    with pytest.raises(Unsendable):
        encode(message)


@pytest.mark.parametrize("text", ["x" * 32, "a\tb", "ü"])
def test_text_that_does_not_fit_is_not_sent(text):
    hello = message_of(next(e for e in TABLE["messages"] if e["message"] == "HelloReply"))
    with pytest.raises(Unsendable):
        encode(replace(hello, board=text))


def test_messages_of_the_other_side_are_malformed():
    with pytest.raises(Malformed, match="a host has no messages of type 0x86"):
        decode_host(0x86, b"")
    with pytest.raises(Malformed, match="a board has no messages of type 0x08"):
        decode_board(0x08, b"")


# Anything.

NUMBERS: dict[str, Any] = {
    "u8": st.integers(0, 0xFF),
    "u16": st.integers(0, 0xFFFF),
    "u32": st.integers(0, 0xFFFF_FFFF),
    "i8": st.integers(-0x80, 0x7F),
    "i32": st.integers(-0x8000_0000, 0x7FFF_FFFF),
    "f32": st.floats(width=32, allow_nan=False),
    "bool": st.booleans(),
    "u8?": st.none() | st.integers(0, 0xFE),
    "u16?": st.none() | st.integers(0, 0xFFFE),
    "message": st.sampled_from([d.name.lower() for d in DESCRIPTION.message]),
    "text": st.text(st.characters(min_codepoint=32, max_codepoint=126), max_size=31),
}


def values(field: FieldDescription, joints: int) -> st.SearchStrategy[Any]:
    parsed = field.parsed
    if parsed.of is None:
        number = NUMBERS[parsed.base]
    else:
        kind: type[IntEnum | IntFlag] = getattr(m, parsed.of)
        flags = st.integers(0, 255).map(kind)
        number = flags if parsed.base == "flags" else st.sampled_from(list(kind))
    if parsed.count is None:
        return number
    return st.tuples(*[number] * (joints if parsed.count == "joints" else parsed.count))


@st.composite
def any_message(draw: st.DrawFn) -> Any:
    described = draw(st.sampled_from(DESCRIPTION.message))
    joints = draw(st.integers(0, 4))
    kept = [field for field in described.fields if field.parsed.base != "joints"]
    return getattr(m, described.name)(*(draw(values(field, joints)) for field in kept))


@QUIET
@given(message=any_message(), sequence=st.integers(0, 255))
def test_any_message_goes_round_and_is_the_same_bytes_in_c(c, message, sequence):
    type_, payload = encode(message)
    assert PythonCodec().decode(type_, payload) == message
    assert c.encode(message) == payload
    assert c.decode(type_, payload) == message
    frame = write_frame(type_, sequence, payload)
    assert c.write_frame(type_, sequence, payload) == frame
    assert c.read(frame) == ([(type_, sequence, payload)], 0)


@QUIET
@given(
    type_=st.sampled_from([0, 0x0C, 0x80, 0x87, *(d.type for d in DESCRIPTION.message)]),
    payload=st.binary(max_size=90),
)
def test_random_payloads_mean_the_same_to_both(c, type_, payload):
    assert same(c.decode(type_, payload), PythonCodec().decode(type_, payload))


@QUIET
@given(
    at=st.integers(0, len(TABLE["messages"]) - 1),
    cut=st.integers(0, 90),
    patch=st.binary(max_size=4),
)
def test_nearly_right_payloads_mean_the_same_to_both(c, at, cut, patch):
    entry = TABLE["messages"][at]
    payload = bytes.fromhex(entry["payload"])
    payload = payload[:cut] + patch + payload[cut + len(patch) :]
    assert same(c.decode(entry["type"], payload), PythonCodec().decode(entry["type"], payload))


@QUIET
@given(data=st.lists(st.binary(max_size=40) | st.just(golden.STOP) | st.just(b"\0")).map(b"".join))
def test_random_bytes_hold_the_same_frames_for_both(c, data):
    assert c.read(data) == PythonCodec().read(data) == WholePythonCodec().read(data)


def same(one: Any, other: Any) -> bool:
    """Equal, also where both are no number."""
    if one is None or other is None:
        return one is other
    return all(_same(getattr(one, field.name), getattr(other, field.name)) for field in fields(one))


def _same(one: Any, other: Any) -> bool:
    if isinstance(one, tuple):
        return len(one) == len(other) and all(map(_same, one, other))
    if isinstance(one, float) and math.isnan(one):
        return math.isnan(other)
    return one == other


# Under the sanitizers.


def test_no_bytes_lead_c_astray(tmp_path):
    """All of the table, its frames cut and spoilt, and noise, under ASan and UBSan."""
    program = tmp_path / "program"
    sources = [*(CORE / f"{name}.c" for name in ("messages", "frames")), PROGRAM]
    sanitize = ["-fsanitize=address,undefined", "-fno-sanitize-recover=all", f"-I{CORE}"]
    subprocess.run(
        ["gcc", "-std=c11", "-g", "-O1", *sanitize, *map(str, sources), "-o", str(program)],
        check=True,
    )
    data = everything()
    out = subprocess.run([str(program)], input=data, capture_output=True, check=True).stdout
    frames, dropped = WholePythonCodec().read(data)
    expected = [f"{t:02x} {s:02x} {_again(t, payload)}" for t, s, payload in frames]
    assert out.decode().splitlines() == [*expected, f"{dropped} dropped"]
    assert sum(line.endswith("malformed") for line in expected) > 50
    assert dropped > 1000


def _again(type_: int, payload: bytes) -> str:
    """Decoding and encoding again changes nothing."""
    return "malformed" if PythonCodec().decode(type_, payload) is None else payload.hex()


def everything() -> bytes:
    noise = random.Random(9)
    data = bytearray()
    for entry in [*TABLE["messages"], *TABLE["frames"]]:
        frame = bytes.fromhex(entry["frame"])
        payload = bytes.fromhex(entry["payload"])
        data += frame
        for _ in range(30):
            at = noise.randrange(len(frame))
            data += golden.flipped(frame, at, noise.randrange(8)) + b"\0"
            data += frame[:at] + b"\0" + frame[at:]
            cut = payload[: noise.randrange(len(payload) + 1)] + noise.randbytes(3)
            data += write_frame(entry["type"], 0, cut[:512])
    for entry in TABLE["malformed"]:
        data += write_frame(entry["type"], 0, bytes.fromhex(entry["payload"]))
    return bytes(data + noise.randbytes(100_000) + b"\0")
