"""A configuration as the board works with it: checked once, in its own units."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import isfinite

from deltaviz.link.board.kinematics import GEOMETRY, ForwardKinematics, RotaryDeltaForward
from deltaviz.link.messages import Configure

V_UNIT = 65.536  # 2^-16 microsteps per ms in one microstep per second
A_UNIT = 2**32 / 1e6  # 2^-32 microsteps per ms² in one microstep per s²


@dataclass(frozen=True, slots=True)
class Parameters:
    """Accelerations in 2^-32 microsteps per ms², homing speeds in 2^-16 microsteps per ms,
    homing distances and angles in microsteps.
    """

    configure: Configure
    joints: int
    accelerations: tuple[int, ...]
    forward: ForwardKinematics | None
    fast: tuple[int, ...]
    slow: tuple[int, ...]
    backoff: tuple[int, ...]
    max_travel: tuple[int, ...]
    switch: tuple[int, ...]
    ready: tuple[int, ...]


def parameters_from(configure: Configure, *, tick_hz: int) -> Parameters | None:
    """None for a configuration that makes no sense, or asks for more than a step every other
    tick.
    """
    if not _makes_sense(configure, tick_hz):
        return None
    per_rad = configure.microsteps_per_rad

    def microsteps(angles: Sequence[float]) -> tuple[int, ...]:
        return tuple(round(angle * m) for angle, m in zip(angles, per_rad, strict=True))

    def speeds(speed: float) -> tuple[int, ...]:
        return tuple(
            max(1, int(min(speed, top) * m * V_UNIT))
            for top, m in zip(configure.velocity, per_rad, strict=True)
        )

    joints = len(per_rad)
    forward = (
        RotaryDeltaForward(dict(configure.geometry), configure.tool_offset)
        if configure.geometry
        else None
    )
    if forward is not None and forward.tip(configure.ready) is None:
        return None
    return Parameters(
        configure=configure,
        joints=joints,
        accelerations=tuple(
            int(a * m * A_UNIT) for a, m in zip(configure.acceleration, per_rad, strict=True)
        ),
        forward=forward,
        fast=speeds(configure.homing_fast),
        slow=speeds(configure.homing_slow),
        backoff=microsteps([configure.homing_backoff] * joints),
        max_travel=microsteps([configure.homing_max_travel] * joints),
        switch=microsteps(configure.homing_switch),
        ready=microsteps(configure.ready),
    )


def _makes_sense(configure: Configure, tick_hz: int) -> bool:
    joints = len(configure.microsteps_per_rad)
    per_joint = (
        configure.joint_min,
        configure.joint_max,
        configure.velocity,
        configure.acceleration,
        configure.unhomed_velocity,
        configure.inverted,
        configure.homing_switch,
        configure.ready,
    )
    if not 1 <= joints <= 4 or any(len(values) != joints for values in per_joint):
        return False
    return (
        all(isfinite(value) for value in _numbers(configure))
        and all(value > 0 for value in _positive(configure))
        and all(lo < hi for lo, hi in zip(configure.joint_min, configure.joint_max, strict=True))
        and all(
            lo <= ready <= hi
            for lo, ready, hi in zip(
                configure.joint_min, configure.ready, configure.joint_max, strict=True
            )
        )
        and configure.homing_direction in (-1, 1)
        and all(
            v * m <= tick_hz / 2 and a * m * A_UNIT >= 1 << 16
            for v, a, m in zip(
                configure.velocity,
                configure.acceleration,
                configure.microsteps_per_rad,
                strict=True,
            )
        )
        and _geometry_makes_sense(configure)
    )


def _numbers(configure: Configure) -> list[float]:
    ranges = (configure.workspace_x, configure.workspace_y, configure.workspace_z)
    return [
        *configure.joint_min,
        *configure.joint_max,
        *configure.homing_switch,
        *configure.ready,
        *configure.tool_offset,
        *(value for pair in ranges if pair is not None for value in pair),
        *(value for _, values in configure.geometry for value in values),
        *_positive(configure),
    ]


def _positive(configure: Configure) -> list[float]:
    radius = configure.workspace_radius
    return [
        *configure.velocity,
        *configure.acceleration,
        *configure.unhomed_velocity,
        *configure.microsteps_per_rad,
        configure.homing_fast,
        configure.homing_slow,
        configure.homing_backoff,
        configure.homing_max_travel,
        *([] if radius is None else [radius]),
    ]


def _geometry_makes_sense(configure: Configure) -> bool:
    if not configure.geometry:
        return True
    geometry = dict(configure.geometry)
    return (
        configure.kind == "rotary_delta"
        and set(geometry) == set(GEOMETRY)
        and all(len(values) == 3 for values in geometry.values())
        and len(configure.microsteps_per_rad) == 3
        and len(configure.tool_offset) == 3
        and min(*geometry["upper_arm"], *geometry["forearm"]) > 0
    )
