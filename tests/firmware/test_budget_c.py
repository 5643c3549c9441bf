"""The processor is quick enough, by count: the images for silicon, run in Unicorn.

Cycles are estimated without the flash's wait states, most of which the chip's caches hide; the
bounds leave room for the others.
"""

from __future__ import annotations

import pytest

from tests.firmware.budget import (
    CONTROL,
    CPU_HZ,
    INTERRUPT,
    LINE_CONTROL,
    LINE_SEGMENT,
    SEGMENT,
    SERIAL,
    STEP,
    TICK_HZ,
    budget,
    share,
)

TICK_CYCLES = CPU_HZ / TICK_HZ
MS_CYCLES = CPU_HZ / 1000

JOINTS = pytest.mark.parametrize("joints", [3, 4])


@JOINTS
def test_a_tick_is_over_before_the_next_one(joints):
    worst = budget(joints)[STEP].worst
    assert worst.instructions <= 260
    assert worst.cycles + INTERRUPT + 2 * (budget(joints)[SERIAL].worst.cycles + INTERRUPT) < (
        TICK_CYCLES * 0.75
    )


def test_three_axes_at_100_khz_take_less_than_half_of_the_processor():
    step = budget(3)[STEP].mean
    assert step.instructions * TICK_HZ < 0.20 * CPU_HZ
    assert share(3) < 0.5


@JOINTS
def test_control_is_done_long_before_the_piece_that_it_plans(joints):
    left = 1 - (budget(joints)[STEP].mean.cycles + INTERRUPT) / TICK_CYCLES
    for context in (CONTROL, LINE_CONTROL):
        assert budget(joints)[context].worst.cycles < 0.1 * left * MS_CYCLES


@JOINTS
def test_carrying_a_segment_out_keeps_control_waiting_for_less_than_300_us(joints):
    left = 1 - (budget(joints)[STEP].mean.cycles + INTERRUPT) / TICK_CYCLES
    assert budget(joints)[SEGMENT].worst.cycles < 0.3 * left * MS_CYCLES


def test_judging_the_longest_straight_segment_takes_less_than_a_piece():
    left = 1 - (budget(3)[STEP].mean.cycles + INTERRUPT) / TICK_CYCLES
    assert budget(3)[LINE_SEGMENT].worst.cycles < left * MS_CYCLES


def test_kinematics_and_frames():
    costs = budget(3)
    assert costs["dv_forward"].worst.instructions <= 600
    assert costs["dv_inverse"].worst.instructions <= 700
    assert costs["dv_frame_read"].mean.instructions <= 50  # a byte
    assert costs[SERIAL].worst.instructions <= 60
