"""What docs/protocol.md says of the messages is whole."""

from __future__ import annotations

import json
import re
from enum import IntEnum, IntFlag
from pathlib import Path

import pytest

from deltaviz.link import messages
from deltaviz.link.wire.description import load_description

ROOT = Path(__file__).parents[3]
PAGE = (ROOT / "docs" / "protocol.md").read_text()
ENUMERATIONS = [
    value
    for value in vars(messages).values()
    if isinstance(value, type) and issubclass(value, IntEnum | IntFlag)
    and value not in (IntEnum, IntFlag)
]  # fmt: skip


@pytest.mark.parametrize("kind", ENUMERATIONS, ids=lambda kind: kind.__name__)
def test_every_value_has_a_meaning_and_every_meaning_a_value(
    kind: type[IntEnum | IntFlag],
) -> None:
    meaning = load_description().meaning[kind.__name__]
    assert list(meaning) == list(kind.__members__)
    assert all(meaning.values())


def test_every_message_and_field_is_on_the_page() -> None:
    for message in load_description().message:
        section = PAGE.split(f"### {message.name}: 0x{message.type:02X}")[1].split("\n### ")[0]
        assert len(section.splitlines()[2]) > 10, f"{message.name} is explained"
        for field in message.fields:
            assert f"| `{field.name}` | `{field.type}` |" in section


def test_the_frame_that_is_taken_apart_is_the_real_one() -> None:
    frames = json.loads((ROOT / "tests" / "data" / "frames.json").read_text())["messages"]
    stop = next(frame["frame"] for frame in frames if frame["message"] == "Stop")
    assert " ".join(re.findall("..", stop)) in PAGE


def test_every_time_out_is_on_the_page() -> None:
    from deltaviz.link.timing import TIMEOUTS

    for timeout in TIMEOUTS:
        assert f"| {1000 * timeout.seconds:g} ms | {timeout.after}" in PAGE
