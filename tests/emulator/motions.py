"""What a host has commanded, taken from what passed on the wire: one motion an epoch.

The host says where the robot is to be and how long each piece lasts; when a piece ends by the
board's clock, the board's telemetry says (`t_queue_end`), and the pulses are held against both.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from deltaviz.link.messages import BoardState
from tests.emulator.commanded_path import CommandedPath
from tests.emulator.judge import AFTER
from tests.emulator.overheard import NONE_TAKEN, Arm, Segment, Telemetry
from tests.emulator.wire import Passed


@dataclass(frozen=True)
class Motion:
    """`path` was to be followed until tick `until`: a while after its end, or the last that the
    board has told, before something stopped it if it was `stopped`.
    """

    epoch: int
    path: CommandedPath
    until: int
    stopped: bool


def motions(passed: Sequence[Passed], *, ticks_per_ms: int) -> list[Motion]:
    """Those of one board between power-up and its end, in which anything was begun: of an epoch
    that was stopped before, nothing was to be followed.
    """
    arms: dict[int, Arm] = {}
    segments: dict[int, list[Segment]] = {}
    told: dict[int, list[Telemetry]] = {}
    for each in passed:
        match each.said:
            case Arm() as arm if arm.epoch not in arms:  # the same again is a repetition
                arms[arm.epoch] = arm
            case Segment() as segment:
                segments.setdefault(segment.epoch, []).append(segment)
            case Telemetry() as telemetry:
                told.setdefault(telemetry.epoch, []).append(telemetry)
            case _:
                pass
    begun = (
        _motion(arms[epoch], pieces, told.get(epoch, []), ticks_per_ms)
        for epoch, pieces in segments.items()
    )
    return [motion for motion in begun if motion is not None]


def _motion(
    arm: Arm, pieces: list[Segment], told: list[Telemetry], ticks_per_ms: int
) -> Motion | None:
    assert [piece.index for piece in pieces] == list(range(len(pieces)))
    armed, stopped = _armed(told)
    ends = _ends(pieces, armed)
    if not ends:
        return None
    path = CommandedPath(
        arm.counts,
        np.array([end - piece.duration for end, piece in zip(ends, pieces, strict=False)]),
        np.array([piece.duration for piece, _ in zip(pieces, ends, strict=False)]),
        np.array([arm.counts, *(np.array(p.p) / 1024 for p in pieces[: len(ends)])]),
        np.array(
            [
                np.zeros(len(arm.counts)),
                *(np.array(p.v) / 65536 / ticks_per_ms for p in pieces[: len(ends)]),
            ]
        ),
    )
    return Motion(arm.epoch, path, min(armed[-1].now, path.end + AFTER), stopped)


def _armed(told: list[Telemetry]) -> tuple[list[Telemetry], bool]:
    """What the board told while it took segments, and whether something ended that with more to
    come.
    """
    armed: list[Telemetry] = []
    for telemetry in told:
        if telemetry.state is BoardState.ARMED:
            armed.append(telemetry)
        elif armed:
            return armed, telemetry.state is BoardState.BRAKING
    return armed, False


def _ends(pieces: list[Segment], armed: list[Telemetry]) -> list[int]:
    """When each piece ends by the board's clock. A piece from rest may begin at any time; the
    others follow without a pause, so one that telemetry tells of tells of its neighbours, too.
    Behind the last of which it tells, a motion from rest has never begun.
    """
    ends: list[int | None] = [None] * len(pieces)
    for telemetry in armed:
        if telemetry.last_index != NONE_TAKEN and telemetry.t_queue_end != telemetry.now:
            known = ends[telemetry.last_index]
            assert known in (None, telemetry.t_queue_end), "the queue's end has moved"
            ends[telemetry.last_index] = telemetry.t_queue_end
    for index in range(len(pieces) - 1, 0, -1):
        end = ends[index]
        if end is not None and ends[index - 1] is None and not pieces[index - 1].rests:
            ends[index - 1] = end - pieces[index].duration
    for index in range(1, len(pieces)):
        end = ends[index - 1]
        if end is not None and not pieces[index - 1].rests:
            assert ends[index] in (None, end + pieces[index].duration), "a pause in a motion"
            ends[index] = end + pieces[index].duration
    known = [end for end in ends if end is not None]
    assert len(known) == len(ends) or None not in ends[: len(known)], "a motion without telemetry"
    return known
