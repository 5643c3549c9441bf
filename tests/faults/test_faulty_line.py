"""The line does what its fault says, as often as it says, and alike from the same seed."""

from __future__ import annotations

from random import Random

import pytest

from tests.faults.faulty_line import HELD_UP, Fault, FaultyLine, Kind, Unit

FRAMES = [bytes([1 + k % 200, 7, 1 + k // 200]) + b"\0" for k in range(3000)]


def passed(fault: Fault | None, seed: int = 1) -> tuple[FaultyLine, bytes]:
    line = FaultyLine(Random(seed), fault)
    for k, frame in enumerate(FRAMES):
        line.put(frame, k * 0.01)
    return line, line.take(1e9)


def test_a_sound_line_is_a_wire() -> None:
    line, arrived = passed(None)
    assert arrived == b"".join(FRAMES)
    assert line.injected == 0
    assert line.frames == len(FRAMES)


@pytest.mark.parametrize("unit", Unit)
@pytest.mark.parametrize("kind", Kind)
def test_faults_are_as_many_as_was_said(kind: Kind, unit: Unit) -> None:
    line, _ = passed(Fault(kind, unit, 0.05))
    units = len(FRAMES) * (4 if unit is Unit.BYTE else 1)
    assert line.injected == pytest.approx(0.05 * units, rel=0.25)


@pytest.mark.parametrize("unit", Unit)
@pytest.mark.parametrize("kind", Kind)
def test_the_same_seed_does_the_same(kind: Kind, unit: Unit) -> None:
    fault = Fault(kind, unit, 0.05)
    assert passed(fault)[1] == passed(fault)[1]
    assert kind is Kind.DELAYED or passed(fault)[1] != passed(fault, seed=2)[1]


@pytest.mark.parametrize("kind", [k for k in Kind if k is not Kind.FLIPPED])
def test_what_becomes_of_frames(kind: Kind) -> None:
    line, arrived = passed(Fault(kind, Unit.FRAME, 0.05))
    came = [arrived[k : k + 4] for k in range(0, len(arrived), 4)]
    more = {Kind.LOST: -line.injected, Kind.DOUBLED: line.injected}.get(kind, 0)
    assert abs(len(came) - len(FRAMES) - more) <= (kind is Kind.REORDERED)
    assert set(came) <= set(FRAMES)
    in_order = sorted(came, key=FRAMES.index) == came
    assert in_order is (kind is not Kind.REORDERED)


def test_a_flipped_byte_has_one_other_bit() -> None:
    line, arrived = passed(Fault(Kind.FLIPPED, Unit.BYTE, 0.05))
    bits = [bin(a ^ b).count("1") for a, b in zip(arrived, b"".join(FRAMES), strict=True)]
    assert set(bits) == {0, 1}
    assert sum(bits) == line.injected


def test_what_is_delayed_holds_up_what_follows() -> None:
    line = FaultyLine(Random(1), Fault(Kind.DELAYED, Unit.FRAME, 1.0))
    shortest, longest = HELD_UP[Unit.FRAME]
    line.put(FRAMES[0] + FRAMES[1], 10.0)
    assert line.take(10.0 + shortest * 0.99) == b""
    assert line.take(10.0 + 2 * longest) == FRAMES[0] + FRAMES[1]
