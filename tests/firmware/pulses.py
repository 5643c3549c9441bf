"""Pulse trains, judged by what left the pins alone: STEP and DIR of each joint, tick by tick."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

STEP, DIR = 0, 4  # the first joint's bits of what dv_stepper_tick returns


@dataclass(frozen=True)
class Pulses:
    """One joint's pins, a level a tick. `forward` is the level of DIR on which it turns forward."""

    step: np.ndarray
    dir: np.ndarray
    forward: int = 1

    @property
    def counts(self) -> np.ndarray:
        """The steps that have left after each tick, those backward taken off."""
        way = np.where(self.dir == self.forward, 1, -1)
        return np.cumsum(self.step * way)

    def check_timing(self) -> None:
        """STEP is high for one tick and never in the next; DIR stands a tick before STEP rises."""
        together = self.step[1:] & self.step[:-1]
        assert not together.any(), f"STEP was high for two ticks at {together.argmax()}"
        turned = self.dir[1:] != self.dir[:-1]
        hasty = self.step[1:] & turned
        assert not hasty.any(), f"DIR changed with STEP at {hasty.argmax()}"


def pulses(pins: Sequence[int], joint: int, *, forward: int = 1) -> Pulses:
    levels = np.array(pins, dtype=np.int64)
    return Pulses(levels >> (STEP + joint) & 1, levels >> (DIR + joint) & 1, forward)


def nearest(positions: np.ndarray) -> np.ndarray:
    """Whole microsteps of positions in 2^-32 microsteps."""
    return (positions + (1 << 31)) >> 32


def check_lag(train: Pulses, counts: np.ndarray, *, ticks: int = 2) -> None:
    """What has left is the count of now or of at most `ticks` ago. Both begin at 0."""
    left = train.counts
    late = np.concatenate((np.zeros(ticks, dtype=np.int64), counts))
    behind = np.stack([late[ticks - k : len(late) - k] for k in range(ticks + 1)])
    wrong = (behind != left).all(axis=0)
    at = int(wrong.argmax())
    assert not wrong.any(), (
        f"at tick {at} {left[at]} steps have left, and the count is {counts[at]}"
    )
