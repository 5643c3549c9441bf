"""Whether the steps that left the pins are the motion that was commanded, and within its limits."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deltaviz.robots import Robot
from tests.emulator.commanded_path import CommandedPath
from tests.emulator.pulse_train import JointPulses, PulseTrain

Floats = NDArray[np.float64]
WINDOW = 0.020  # s of the fit that gives velocity and acceleration
NEAR, FAR = 2, 7  # microsteps from the path, between which a deceleration is fitted
LEAST = 5  # steps in a window; fewer say little of the acceleration
AFTER = 200  # ticks behind the end of a path, in which it is to stand there
AT_ONCE = 1 << 20  # ticks
STRIDE = 0.002  # s from the start of a window to that of the next, at least
FIT = 1.03  # what the fit may find above a limit: the steps are a tick and half a microstep coarse


def position_error(
    pulses: PulseTrain, path: CommandedPath, *, until: int | None = None
) -> list[float]:
    """How far each joint's count was from the path at worst, in microsteps, at any tick from the
    start of the path until the tick `until`, or a while after its end.
    """
    until = path.end + AFTER if until is None else until
    steps = [joint.between(path.begin, until) for joint in pulses.joints]
    worst = np.zeros(len(path.counts))
    for begin in range(path.begin, until, AT_ONCE):
        at = np.arange(begin, min(begin + AT_ONCE, until), dtype=np.int64)
        counted = [count + steps[joint].counts(at) for joint, count in enumerate(path.counts)]
        worst = np.maximum(worst, np.abs(np.transpose(counted) - path.positions(at)).max(axis=0))
    return worst.tolist()


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
    due = -np.inf
    for first, start in enumerate(times):
        if start < due:
            continue
        due = start + STRIDE
        last = int(np.searchsorted(times, start + WINDOW, side="right"))
        if last - first < LEAST or times[last - 1] - start < WINDOW / 2:
            continue
        t = times[first:last] - start - WINDOW / 2
        curve, slope, _ = np.polyfit(t, passed[first:last], 2)
        speed = max(speed, abs(slope))
        acceleration = max(acceleration, abs(2 * curve))
    return Peaks(speed, acceleration)


def beyond_limits(
    pulses: PulseTrain, robot: Robot, *, begin: int, end: int, tick_hz: int
) -> list[str]:
    """What of the steps in these ticks is faster, or quicker to change, than its joint may be."""
    shares = limit_shares(pulses, robot, begin=begin, end=end, tick_hz=tick_hz)
    return [
        f"joint {joint}: {what} {share:.3f} of its limit"
        for joint, share_of in enumerate(shares)
        for what, share in (("speed", share_of.speed), ("acceleration", share_of.acceleration))
        if share > FIT
    ]


def limit_shares(
    pulses: PulseTrain, robot: Robot, *, begin: int, end: int, tick_hz: int
) -> list[Peaks]:
    """The peaks of each joint in these ticks, as shares of its limits."""
    shares: list[Peaks] = []
    for joint, per_rad in enumerate(robot.drive.microsteps_per_rad):
        seen = peaks(pulses.joints[joint].between(begin, end), tick_hz=tick_hz)
        limits = robot.limits.joint
        speed, acceleration = limits.velocity[joint], limits.acceleration[joint]
        shares.append(
            Peaks(seen.speed / per_rad / speed, seen.acceleration / per_rad / acceleration)
        )
    return shares


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
