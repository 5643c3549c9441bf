"""A kept capture runs again and comes out the same; a changed one does not."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from deltaviz.link import messages as m
from deltaviz.link.capture.reader import read_capture
from deltaviz.link.capture.records import Kind, Record
from deltaviz.link.capture.replay_board import replay_board
from deltaviz.link.capture.replay_session import replay_session
from deltaviz.link.capture.spoken import ReplayError, connections
from deltaviz.link.wire.codec import decode_board, decode_host, encode
from deltaviz.link.wire.frames import FrameReader, write_frame
from tests.link.capture.make import KEPT, make

Change = Callable[[Any], Any]


@pytest.fixture(scope="module")
def kept() -> list[Record]:
    (records,) = connections(read_capture(KEPT))
    return records


def changed(records: list[Record], change: Change) -> list[Record]:
    """The same capture with other messages; None leaves one out."""
    result: list[Record] = []
    readers = {Kind.SENT: FrameReader(), Kind.RECEIVED: FrameReader()}
    for record in records:
        if record.kind not in readers:
            result.append(record)
            continue
        decode = decode_host if record.kind is Kind.SENT else decode_board
        data = b""
        for frame in readers[record.kind].feed(record.data):
            message = change(decode(frame.type, frame.payload))
            if message is not None:
                data += write_frame(encode(message)[0], frame.sequence, encode(message)[1])
        result.append(replace(record, data=data))
    return result


def test_the_session_says_what_it_said_then(kept: list[Record]) -> None:
    events = list(replay_session(kept))
    assert [event.text for event in events if event.differs] == []
    told = [event.text for event in events]
    assert told[0] == "session configuring"
    assert "session ready" in told
    assert told.count("board ARMED") == 2
    assert told[-3:-1] == ["board ESTOP", "not homed"]
    assert sum(text.startswith("stopped by HOST_STOP") for text in told) == 1
    assert told[-1].startswith("stopped by ESTOP")


def test_the_simulated_board_answers_what_was_answered_then(kept: list[Record]) -> None:
    events = list(replay_board(kept))
    assert [event.text for event in events if event.differs] == []
    assert sum(event.text.startswith("Stopped") for event in events) == 2


def test_it_comes_out_the_same_every_time(kept: list[Record]) -> None:
    assert list(replay_session(kept)) == list(replay_session(kept))
    assert list(replay_board(kept)) == list(replay_board(kept))


def test_todays_program_makes_a_capture_that_replays(tmp_path: Path) -> None:
    make(tmp_path / "today.capture")
    (records,) = connections(read_capture(tmp_path / "today.capture"))
    for replay in (replay_session, replay_board):
        assert not [event for event in replay(records) if event.differs]


SPOILT: list[tuple[str, Change]] = [
    (
        "a segment at another time",
        lambda x: replace(x, t_end=x.t_end + 1) if _is(x, m.Segment, index=3) else x,
    ),
    ("a segment left out", lambda x: None if _is(x, m.Segment, index=3) else x),
    ("another epoch", lambda x: replace(x, epoch=9) if _is(x, m.Arm, epoch=2) else x),
    (
        "a keep of what was never seen",
        lambda x: replace(x, seen=5) if isinstance(x, m.Keep) else x,
    ),
]


def _is(message: object, kind: type, **fields: int) -> bool:
    return isinstance(message, kind) and all(
        getattr(message, name) == value for name, value in fields.items()
    )


@pytest.mark.parametrize(("_name", "change"), SPOILT, ids=[name for name, _ in SPOILT])
def test_the_session_does_not_say_what_it_would_not_have_said(
    kept: list[Record], _name: str, change: Change
) -> None:
    assert any(event.differs for event in replay_session(changed(kept, change)))


@pytest.mark.parametrize(
    "change",
    [
        lambda x: replace(x, cause=m.StopCause.LEASE) if isinstance(x, m.Stopped) else x,
        lambda x: replace(x, counts=(1, 2, 3)) if isinstance(x, m.Stopped) else x,
        lambda x: None if isinstance(x, m.Stop) else x,
        lambda x: replace(x, velocity=(9, 9, 9)) if isinstance(x, m.Configure) else x,
    ],
    ids=["another cause", "elsewhere", "no stop", "another robot"],
)
def test_the_board_answers_otherwise_when_it_was_otherwise(
    kept: list[Record], change: Change
) -> None:
    assert any(event.differs for event in replay_board(changed(kept, change)))


def test_what_cannot_be_replayed_says_why(kept: list[Record]) -> None:
    silent = [record for record in kept if record.kind is not Kind.RECEIVED]
    with pytest.raises(ReplayError, match="no board answered"):
        list(replay_board(silent))
    unconfigured = changed(kept, lambda x: None if isinstance(x, m.Configure) else x)
    with pytest.raises(ReplayError, match="no board was configured"):
        list(replay_session(unconfigured))
    later = changed(kept, lambda x: replace(x, configuration=5) if _is(x, m.HelloReply) else x)
    with pytest.raises(ReplayError, match="configured before"):
        list(replay_board(later))
