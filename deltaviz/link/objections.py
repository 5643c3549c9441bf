"""Why a board refuses a robot's configuration, in the words of the robot file."""

from __future__ import annotations

from collections.abc import Iterator

from deltaviz.link.configuration import A_UNIT, V_UNIT
from deltaviz.link.messages import Configure
from deltaviz.link.rules import TICK_HZ_MIN

STEP_TICKS = 2.004  # a step every other tick, and 0.2 % for the slack of speeds
BRAKE_MAX = 1.0  # s from top velocity
HOMING_MICROSTEPS_MAX = 1 << 20
HOMING_TIME_MAX = 600.0  # s


def objection(configure: Configure, *, tick_hz: int) -> str:
    """The first of the limits that every board has which this configuration breaks, and what to
    change. The limits are those that `Configure` states.
    """
    known = next(_broken(configure, tick_hz), None)
    if known is None:
        return (
            "The board cannot work with this robot's file; its firmware may be for another kind "
            "of robot. Choose another robot, or flash the firmware of this deltaviz."
        )
    return f"The board cannot drive this robot: {known} Then restart deltaviz."


def _broken(c: Configure, tick_hz: int) -> Iterator[str]:
    if tick_hz < TICK_HZ_MIN:
        yield (
            "an error of its clock, which deltaviz ports names, makes it too slow for any motion. "
            "Switch it off and on."
        )
    for joint, velocity in enumerate(c.velocity):
        name, rate = f"joint {joint + 1}", velocity / V_UNIT
        most = tick_hz / STEP_TICKS
        if rate > most:
            yield (
                f"{name} would take {rate:.0f} steps a second, and {most:.0f} is the most. "
                "Lower velocity_deg_s, microsteps or gear in the robot file."
            )
        brake = rate / (c.acceleration[joint] / A_UNIT)
        if brake > BRAKE_MAX:
            yield (
                f"{name} would brake for {brake:.1f} s, and {BRAKE_MAX:g} s is the most. "
                "Raise acceleration_deg_s2 or lower velocity_deg_s in the robot file."
            )
        yield from _homing(c, joint, name)


def _homing(c: Configure, joint: int, name: str) -> Iterator[str]:
    furthest = max(c.homing_backoff[joint], c.homing_max_travel[joint], abs(c.homing_switch[joint]))
    way = max(furthest, abs(c.ready[joint] - c.homing_switch[joint]))
    seconds = way / (min(c.homing_fast[joint], c.homing_slow[joint]) / V_UNIT)
    if furthest > HOMING_MICROSTEPS_MAX:
        yield (
            f"{name} would home {furthest} microsteps far, and {HOMING_MICROSTEPS_MAX} is the "
            "most. Lower max_travel_deg, backoff_deg or microsteps in the robot file."
        )
    elif seconds > HOMING_TIME_MAX:
        yield (
            f"{name} would home for {seconds / 60:.0f} minutes, and {HOMING_TIME_MAX / 60:.0f} "
            "are the most. Raise slow_deg_s or lower max_travel_deg in the robot file."
        )
