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
    LINE,
    LINE_CONTROL,
    LINE_SEGMENT,
    LOCK,
    MOTION,
    SEGMENT,
    SERIAL,
    STEP,
    TICK_HZ,
    budget,
    left,
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
    for context in (CONTROL, LINE_CONTROL):
        assert budget(joints)[context].worst.cycles < 0.12 * left(joints) * MS_CYCLES


@JOINTS
def test_no_message_keeps_control_waiting_for_more_than_300_us(joints):
    assert budget(joints)[LOCK].worst.cycles < 0.3 * left(joints) * MS_CYCLES


@JOINTS
def test_the_longest_message_and_control_are_done_within_half_a_piece(joints):
    """While every axis steps at its top speed and the link is full both ways; what is done later
    than at the end of its piece ends the motion.
    """
    costs = budget(joints)
    control = max(costs[context].worst.cycles for context in (CONTROL, LINE_CONTROL)) + INTERRUPT
    assert costs[LOCK].worst.cycles + control < 0.5 * left(joints) * MS_CYCLES


@JOINTS
def test_segments_are_judged_in_a_small_part_of_the_time_that_they_take(joints):
    for context, ms in ((SEGMENT, min(ms for ms, _ in MOTION)), (LINE_SEGMENT, LINE[0][0])):
        assert budget(joints)[context].worst.cycles < 0.1 * ms * left(joints) * MS_CYCLES


def test_kinematics_and_frames():
    costs = budget(3)
    assert costs["dv_forward"].worst.instructions <= 600
    assert costs["dv_inverse"].worst.instructions <= 700
    assert costs["dv_frame_read"].mean.instructions <= 50  # a byte
    assert costs[SERIAL].worst.instructions <= 60
