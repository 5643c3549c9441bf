"""The steps that left the pins, one joint after another, and whether a driver would take them.

Made from a trace of the pins alone. DIR high is forward, unless the robot's file inverts the joint.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

JOINTS = 4
Ints = NDArray[np.int64]


@dataclass(frozen=True)
class JointPulses:
    """`ticks` at which STEP rose, and the `directions` (+1, -1) in which it stepped."""

    ticks: Ints
    directions: Ints

    def counts(self, at: Ints) -> Ints:
        """Steps forward less steps backward, up to and with each tick of `at`."""
        sums = np.concatenate([[0], np.cumsum(self.directions)])
        return sums[np.searchsorted(self.ticks, at, side="right")]

    def between(self, begin: int, end: int) -> JointPulses:
        """Those after tick `begin`, up to and with `end`."""
        kept = (self.ticks > begin) & (self.ticks <= end)
        return JointPulses(self.ticks[kept], self.directions[kept])

    def without(self, index: int) -> JointPulses:
        """The same with one pulse lost."""
        return JointPulses(np.delete(self.ticks, index), np.delete(self.directions, index))


@dataclass(frozen=True)
class PulseTrain:
    """`faults` are pulses that a driver might not take as meant."""

    joints: tuple[JointPulses, ...]
    faults: tuple[str, ...]


def pulse_train(
    changes: Sequence[tuple[int, int]], *, inverted: Sequence[bool] = (False,) * JOINTS
) -> PulseTrain:
    """`changes` as `PinTrace` has them: (tick, levels: STEP of four joints, then their DIR)."""
    faults: list[str] = []
    joints = [
        _joint(changes, joint, faults, turned=inverted[joint]) for joint in range(len(inverted))
    ]
    return PulseTrain(tuple(joints), tuple(faults))


def _joint(
    changes: Sequence[tuple[int, int]], joint: int, faults: list[str], *, turned: bool
) -> JointPulses:
    ticks: list[int] = []
    directions: list[int] = []
    step = direction = False
    rose = fell = turned_at = -10
    for tick, levels in changes:
        is_high, points = bool(levels >> joint & 1), bool(levels >> joint + 4 & 1)
        if points != direction:
            direction, turned_at = points, tick
            if tick == rose:
                faults.append(f"joint {joint}: DIR changes with STEP at tick {tick}")
        if is_high == step:
            continue
        step = is_high
        if not is_high:
            fell = tick
            if tick != rose + 1:
                faults.append(f"joint {joint}: STEP high from tick {rose} to {tick}")
            continue
        rose = tick
        if tick in (fell, turned_at):
            faults.append(f"joint {joint}: STEP rises too soon at tick {tick}")
        ticks.append(tick)
        directions.append(1 if direction != turned else -1)
    return JointPulses(np.array(ticks, np.int64), np.array(directions, np.int64))
