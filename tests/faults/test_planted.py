"""The same, with a check taken out of the board or the host, must be found wrong."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from deltaviz.link.board import board as board_module
from deltaviz.link.board.board import SimulatedBoard
from deltaviz.link.board.drive import Drive
from deltaviz.link.board.lease import Lease
from deltaviz.link.messages import Refusal
from deltaviz.link.wire import frames
from deltaviz.machine import core
from tests.faults.breaks import break_at
from tests.faults.faulty_line import Fault, Kind, Unit
from tests.faults.overtaken import overtaken
from tests.faults.test_breaks import assert_safe as assert_safe_break
from tests.faults.test_wire_faults import assert_safe as assert_safe_work
from tests.faults.wire_faults import work_with

Plant = Callable[[pytest.MonkeyPatch], None]


def without_crc(patch: pytest.MonkeyPatch) -> None:
    patch.setattr(frames, "crc32", lambda _: 0)


def without_epochs(patch: pytest.MonkeyPatch) -> None:
    real = board_module.segment_refusal

    def refusal(*args: Any, **values: Any) -> Refusal | None:
        found = real(*args, **values)
        return None if found is Refusal.EPOCH else found

    patch.setattr(board_module, "segment_refusal", refusal)


def without_a_lease(patch: pytest.MonkeyPatch) -> None:
    patch.setattr(Lease, "remaining", lambda *_: None)


def without_stop(patch: pytest.MonkeyPatch) -> None:
    patch.setattr(SimulatedBoard, "_stop", lambda board, _: board._control.say_stopped())


def stopped_dead(patch: pytest.MonkeyPatch) -> None:
    patch.setattr(Drive, "brake", lambda drive, _: setattr(drive, "path", None))


def braked_too_hard(patch: pytest.MonkeyPatch) -> None:
    real = Drive.brake

    def harder(drive: Drive, tick: int) -> None:
        drive._accelerations = tuple(a * 11 // 10 for a in drive._accelerations)
        real(drive, tick)

    patch.setattr(Drive, "brake", harder)


def without_a_word(patch: pytest.MonkeyPatch) -> None:
    patch.setattr(core.sentences, "STOPPED_BY", {})


def noisy() -> None:
    for seed in (1, 2):
        flipped = Fault(Kind.FLIPPED, Unit.BYTE, 0.01)
        assert_safe_work(work_with(flipped, seconds=2.0, seed=seed))


def late_frames() -> None:
    assert overtaken(seed=1).wrong == []


def broken(phase: str, how: str) -> Callable[[], None]:
    return lambda: assert_safe_break(break_at(phase, how, seed=1))


PLANTED: list[tuple[Plant, Callable[[], None]]] = [
    (without_crc, noisy),
    (without_epochs, late_frames),
    (without_a_lease, broken("homing", "the wire gone, unnoticed")),
    (without_stop, broken("moving", "5000 stops a second to the board")),
    (stopped_dead, broken("jogging", "the plug pulled")),
    (braked_too_hard, broken("jogging", "the plug pulled")),
    (without_a_word, broken("jogging", "the host stalled for 300 ms")),
]


@pytest.mark.parametrize("test", dict.fromkeys(test for _, test in PLANTED), ids=lambda _: "")
def test_all_is_well(test: Callable[[], None]) -> None:
    test()


@pytest.mark.parametrize(("plant", "test"), PLANTED, ids=[p.__name__ for p, _ in PLANTED])
def test_what_is_missing_is_found(
    monkeypatch: pytest.MonkeyPatch, plant: Plant, test: Callable[[], None]
) -> None:
    plant(monkeypatch)
    with pytest.raises(AssertionError) as found:
        test()
    print(found.value)
