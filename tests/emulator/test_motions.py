"""What passed on a wire becomes the motions that were commanded."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

import pytest

from deltaviz.link.messages import BoardState
from tests.emulator.motions import motions
from tests.emulator.overheard import (
    NONE_TAKEN,
    Arm,
    Ear,
    Greeting,
    Segment,
    Stop,
    Stopped,
    Telemetry,
)
from tests.emulator.wire import Passed

MS = 40  # ticks
PIECE = 10 * MS


def golden() -> list[dict[str, Any]]:
    return json.loads((Path(__file__).parents[1] / "data" / "frames.json").read_text())["messages"]


def test_the_golden_frames_are_read() -> None:
    """The same by which both codecs are held, with which this reader shares nothing."""
    kinds = {"HelloReply": Greeting, **{k.__name__: k for k in (Arm, Segment, Telemetry, Stopped)}}
    for row in golden():
        heard = Ear().feed(bytes.fromhex(row["frame"]))
        if row["message"] in ("Stop", "EStop"):
            assert heard == [Stop(at_once=row["message"] == "EStop")]
        elif row["message"] in kinds:
            (said,) = heard
            assert isinstance(said, kinds[row["message"]])
            told = json.loads(json.dumps(asdict(said)))
            assert told == {field: row["fields"][field] for field in told}


def segment(index: int, t_end: int, p: float, v: float) -> Segment:
    return Segment(7, index, t_end, PIECE, 0, (round(p * 1024),), (round(v * 65536),))


def told(now: int, index: int, queue_end: int, state: BoardState = BoardState.ARMED) -> Telemetry:
    return Telemetry(now, state, 7, index, queue_end, 0, 0, (0,))


TWICE = [
    Arm(7, 900, (0,)),
    told(1000, NONE_TAKEN, 1000),
    segment(0, 1000 + PIECE, 5, 1),
    segment(1, 1000 + 2 * PIECE, 10, 0),
    told(1100, 1, 1080 + 2 * PIECE),
    told(9000, 1, 9000),
    segment(2, 9000 + PIECE, 5, -1),
    segment(3, 9000 + 2 * PIECE, 0, 0),
    told(9100, 2, 9040 + PIECE),
    told(9040 + 3 * PIECE, 3, 9040 + 3 * PIECE),
]


def test_each_motion_from_rest_begins_when_the_board_says() -> None:
    (motion,) = motions([Passed(said, 0) for said in TWICE], ticks_per_ms=MS)
    assert motion.path.begins.tolist() == [1080, 1080 + PIECE, 9040, 9040 + PIECE]
    assert motion.until == motion.path.end + 200
    assert not motion.stopped
    at = motion.path.begins + PIECE
    assert motion.path.positions(at)[:, 0].tolist() == pytest.approx([5, 10, 5, 0])
    assert motion.path.positions(at[1:2] + 3000)[:, 0].tolist() == [10]  # the pause


def test_what_is_stopped_was_to_be_followed_as_long_as_the_board_took_it() -> None:
    braking = told(1200, 1, 1200, BoardState.BRAKING)
    said = [*TWICE[:5], told(1160, 1, 1080 + 2 * PIECE), Stop(at_once=False), braking]
    (motion,) = motions([Passed(each, 0) for each in said], ticks_per_ms=MS)
    assert motion.stopped
    assert motion.until == 1160


def test_what_is_stopped_before_it_has_begun_is_no_motion() -> None:
    said = [*TWICE[:4], Stop(at_once=False), told(1100, NONE_TAKEN, 1100, BoardState.HALTED)]
    assert motions([Passed(each, 0) for each in said], ticks_per_ms=MS) == []


def test_a_pause_in_a_motion_is_no_motion() -> None:
    said = [*TWICE[:4], told(1010, 0, 1080 + PIECE), told(1100, 1, 1085 + 2 * PIECE)]
    with pytest.raises(AssertionError, match="pause"):
        motions([Passed(each, 0) for each in said], ticks_per_ms=MS)
