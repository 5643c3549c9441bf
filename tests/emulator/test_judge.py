"""The judge of what left the pins notices what it is there for."""

from __future__ import annotations

import numpy as np
import pytest

from deltaviz.link.messages import Segment
from tests.emulator import judge
from tests.emulator.commanded_path import CommandedPath, commanded_path
from tests.emulator.pin_trace import Reduction
from tests.emulator.pulse_train import JointPulses, PulseTrain, pulse_train

TICK_HZ, MS = 40_000, 40
STEP, DIR = 0x1, 0x10  # of the first joint


def line(address: str, value: int) -> bytes:
    return (
        f"memory_region_ops_write cpu 0 mr 0x55aa addr 0x{address} value 0x{value:x} size 4 "
        "name 'somewhere'\n"
    ).encode()


TICK = line("40000010", 0xFFFFFFFE)


def pins(levels: int) -> bytes:
    """PE8 to PE15, as one write sets them."""
    return line("40021018", levels << 8 | (~levels & 0xFF) << 24)


def test_a_trace_becomes_changes_of_levels_by_ticks():
    text = b"".join(
        [
            line("40021018", 0x0000_00FF),  # other pins of the port
            TICK + pins(0),
            TICK + pins(DIR),
            line("40020c18", 0x0001_0000),  # another port
            TICK + pins(DIR | STEP),
            TICK + pins(DIR),
            TICK + pins(DIR),
        ]
    )
    expected = [(2, DIR), (3, DIR | STEP), (4, DIR)]
    for size in (len(text), 1, 7, 100):
        reduction, changes = Reduction(), []
        for at in range(0, len(text), size):
            changes += reduction.feed(text[at : at + size])
        assert (changes, reduction.tick) == (expected, 5)


def test_pulses_are_counted_in_their_direction():
    levels = [DIR, DIR | STEP, DIR, DIR | STEP, DIR, 0, STEP, 0]
    train = pulse_train(list(enumerate(levels)))
    assert train.faults == ()
    assert train.joints[0].ticks.tolist() == [1, 3, 6]
    assert train.joints[0].directions.tolist() == [1, 1, -1]
    assert train.joints[0].counts(np.arange(8)).tolist() == [0, 1, 1, 2, 2, 2, 1, 1]
    turned = pulse_train(list(enumerate(levels)), inverted=(True,))
    assert turned.joints[0].directions.tolist() == [-1, -1, 1]


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ([(1, STEP), (3, 0)], "STEP high from tick 1 to 3"),
        ([(1, DIR | STEP), (2, DIR)], "rises too soon"),
        ([(1, STEP), (2, DIR), (2, DIR | STEP), (3, DIR)], "rises too soon"),
        ([(1, STEP), (1, DIR | STEP), (2, DIR)], "DIR changes with STEP"),
    ],
)
def test_what_a_driver_might_misread_is_a_fault(changes, says):
    assert says in " ".join(pulse_train(changes).faults)


def path_of(acceleration: float, ms: int) -> CommandedPath:
    """One joint, evenly faster from rest (microsteps/s²), then evenly slower to rest."""
    top, way = acceleration * ms / 1000, acceleration * (ms / 1000) ** 2 / 2
    knots = [(7 + way, top), (7 + 2 * way, 0.0)]
    segments = [
        Segment(
            epoch=1,
            index=index,
            t_end=100 + (index + 1) * ms * MS,
            duration=ms * MS,
            seen=0,
            p=(round(place * 1024),),
            v=(round(speed * 65.536),),
        )
        for index, (place, speed) in enumerate(knots)
    ]
    return commanded_path((7,), segments, late=20, ticks_per_ms=MS)


def steps_of(path: CommandedPath, *, lag: int = 0) -> PulseTrain:
    """The pulses that such a path gives, `lag` ticks late."""
    at = np.arange(path.begin, path.end + 1)
    counts = np.floor(path.positions(at)[:, 0] + 0.5).astype(np.int64)
    jumps = np.diff(counts)
    where = np.nonzero(jumps)[0]
    return PulseTrain((JointPulses(at[where + 1] + lag, np.sign(jumps[where])),), ())


def test_the_path_is_where_the_segments_say():
    path = path_of(40_000.0, 50)
    assert (path.begin, path.end) == (120, 120 + 100 * MS)
    at = path.begin + np.array([0, 25, 50, 75, 100, 200]) * MS
    ways = path.positions(at)[:, 0] - 7
    assert ways == pytest.approx([0, 12.5, 50, 87.5, 100, 100], abs=0.01)


def test_pulses_on_the_path_pass_and_one_that_is_lost_or_late_does_not():
    path = path_of(40_000.0, 50)
    good = steps_of(path)
    (error,) = judge.position_error(good, path)
    assert error <= 0.55
    joint = good.joints[0]
    for index in (0, len(joint.ticks) // 2, len(joint.ticks) - 1):
        (error,) = judge.position_error(PulseTrain((joint.without(index),), ()), path)
        assert error >= 1.0
    late = steps_of(path, lag=20)  # half a millisecond, at 2000 microsteps a second
    assert judge.position_error(late, path)[0] > 1.0


def test_speed_and_acceleration_are_seen_from_the_pulses():
    path = path_of(40_000.0, 50)
    peaks = judge.peaks(steps_of(path).joints[0], tick_hz=TICK_HZ)
    assert peaks.speed == pytest.approx(2000, rel=0.1)
    assert peaks.acceleration == pytest.approx(40_000, rel=0.05)


def test_the_begin_of_a_brake_is_found():
    """From 800 microsteps/s on, evenly slower by 40 000 microsteps/s²."""
    meant = commanded_path(
        (0,),
        [
            Segment(1, 0, 4000, 50 * MS, 0, (40 * 1024,), (round(800 * 65.536),)),
            Segment(1, 1, 4000 + 50 * MS, 50 * MS, 0, (80 * 1024,), (round(800 * 65.536),)),
        ],
        late=0,
        ticks_per_ms=MS,
    )
    begins = meant.begin + 60 * MS
    at = np.arange(meant.begin, meant.end)
    t = np.clip(at - begins, 0, 0.02 * TICK_HZ) / TICK_HZ
    positions = np.minimum(meant.positions(at)[:, 0], meant.positions(np.array([begins]))[0, 0])
    positions = np.where(at < begins, positions, positions + 800 * t - 20_000 * t * t)
    counts = np.floor(positions + 0.5).astype(np.int64)
    where = np.nonzero(np.diff(counts))[0]
    steps = JointPulses(at[where + 1], np.diff(counts)[where])
    found = judge.brake_began(PulseTrain((steps,), ()), meant, 0)
    assert abs(found - begins) < 2 * MS
