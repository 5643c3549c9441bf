"""Whether the steps that left the pins are the motion that was commanded, and within its limits."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tests.emulator.commanded_path import CommandedPath
from tests.emulator.pulse_train import JointPulses, PulseTrain

Floats = NDArray[np.float64]
WINDOW = 0.020  # s of the fit that gives velocity and acceleration
NEAR, FAR = 2, 7  # microsteps from the path, between which a deceleration is fitted
LEAST = 5  # steps in a window; fewer say little of the acceleration


def position_error(pulses: PulseTrain, path: CommandedPath, *, after: int = 200) -> list[float]:
    """How far each joint's count was from the path at worst, in microsteps, at any tick from the
    start of the path until `after` ticks behind its end.
    """
    at = np.arange(path.begin, path.end + after, dtype=np.int64)
    wanted = path.positions(at)
    errors: list[float] = []
    for joint, count in enumerate(path.counts):
        steps = pulses.joints[joint].between(path.begin, path.end + after)
        errors.append(float(np.abs(count + steps.counts(at) - wanted[:, joint]).max()))
    return errors


@dataclass(frozen=True)
class Peaks:
    """The highest speed (microsteps/s) and acceleration (microsteps/s²) of a joint."""

    speed: float
    acceleration: float


def peaks(steps: JointPulses, *, tick_hz: int) -> Peaks:
    """By least squares of a parabola through the steps of each window. A step leaves where the
    position passes the middle between two counts.
    """
    times = steps.ticks / tick_hz
    passed = np.cumsum(steps.directions) - steps.directions / 2
    speed = acceleration = 0.0
    for first, start in enumerate(times):
        last = int(np.searchsorted(times, start + WINDOW, side="right"))
        if last - first < LEAST or times[last - 1] - start < WINDOW / 2:
            continue
        t = times[first:last] - start - WINDOW / 2
        curve, slope, _ = np.polyfit(t, passed[first:last], 2)
        speed = max(speed, abs(slope))
        acceleration = max(acceleration, abs(2 * curve))
    return Peaks(speed, acceleration)


def brake_began(pulses: PulseTrain, path: CommandedPath, joint: int) -> float:
    """The tick at which a joint left its path, on which it was to go on at an even speed, for an
    even deceleration: its square root of the distance to the path grows evenly from there.
    """
    at = np.arange(path.begin, path.end, dtype=np.int64)
    steps = pulses.joints[joint].between(path.begin, path.end)
    counted = path.counts[joint] + steps.counts(at)
    away = np.abs(counted - path.positions(at)[:, joint])
    fitted = (away > NEAR) & (away < FAR)
    slope, offset = np.polyfit(at[fitted], np.sqrt(away[fitted]), 1)
    return float(-offset / slope)
