"""The C codec in the repository is the one that the description gives."""

from __future__ import annotations

import subprocess

import msgspec
import pytest

from deltaviz.link.wire import generate
from deltaviz.link.wire.description import Description

FLAGS = [
    "-std=c11",
    "-Wall",
    "-Wextra",
    "-pedantic",
    "-Wconversion",
    "-Wdouble-promotion",
    "-Wshadow",
    "-Werror",
]


def test_the_c_codec_is_up_to_date():
    assert generate.stale() == []
    assert generate.main(["--check"]) == 0


def test_a_codec_that_was_edited_by_hand_is_noticed(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(generate, "CORE", tmp_path)
    assert generate.main(["--check"]) == 1  # there is none yet
    generate.main([])
    assert generate.main(["--check"]) == 0
    header = tmp_path / "messages.h"
    header.write_text(header.read_text().replace("DV_STATE_HALTED = 1", "DV_STATE_HALTED = 2"))
    capsys.readouterr()
    assert generate.main(["--check"]) == 1
    assert "messages.h is out of date" in capsys.readouterr().err


@pytest.mark.parametrize(
    "compiler",
    [["gcc"], ["arm-none-eabi-gcc", "-mcpu=cortex-m4", "-mfloat-abi=hard", "-mfpu=fpv4-sp-d16"]],
    ids=lambda compiler: compiler[0],
)
@pytest.mark.parametrize("name", ["messages.c", "frames.c"])
def test_it_compiles_without_a_warning(tmp_path, compiler, name):
    command = [*compiler, *FLAGS, "-O2", "-c", str(generate.CORE / name), "-o"]
    done = subprocess.run([*command, str(tmp_path / "it.o")], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def message(**changes):
    return {"name": "Hello", "type": 1, "from": "host", "fields": []} | changes


@pytest.mark.parametrize(
    ("messages", "says"),
    [
        ([message(fields=[{"name": "a", "type": "u24"}])], "there is no type 'u24'"),
        ([message(type=0x81)], "types from 0x80 on are the board's"),
        ([message(), message(name="Home")], "not unique"),
        ([message(fields=[{"name": "p", "type": "i32[joints]"}])], "its length stands behind it"),
        ([message(fields=[{"name": c, "type": "text"} for c in "abcdefghijklmnopq"])], "longer"),
        ([message(sender="host")], "sender"),
    ],
)
def test_a_description_that_contradicts_itself_is_refused(messages, says):
    numbers = {"version": 1, "joints_max": 4, "payload_max": 512, "command_repeat_ms": 50}
    with pytest.raises(msgspec.ValidationError, match=says):
        msgspec.convert({**numbers, "message": messages}, Description)
