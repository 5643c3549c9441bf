"""A configuration as the board works with it: checked once, with what follows from it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from math import isfinite

from deltaviz.link.board.kinematics import ForwardKinematics, RotaryDeltaForward
from deltaviz.link.messages import Configure, Options, RobotKind

_TO_Q32 = 8  # from 2^-24
_LEAST_ACCELERATION = 1 << 8  # 2^-24 microsteps per ms²: 2^16 in those of the brake
_TWO_TICKS_A_STEP = 2004  # in 1/1000 ticks, with room for the slack of speeds
_BRAKE_MS_MAX = 1000  # so that the brake's arithmetic fits 64 bits
_HOMING_MICROSTEPS_MAX = 1 << 20
_HOMING_MS_MAX = 600_000


@dataclass(frozen=True, slots=True)
class Parameters:
    """`accelerations` are in 2^-32 microsteps per ms²."""

    configure: Configure
    joints: int
    accelerations: tuple[int, ...]
    homing_together: bool
    forward: ForwardKinematics | None


def parameters_from(configure: Configure, *, tick_hz: int) -> Parameters | None:
    """None for a configuration that makes no sense: `Configure` says which do not."""
    if not _makes_sense(configure, tick_hz):
        return None
    forward = None
    if configure.kind is RobotKind.ROTARY_DELTA:
        forward = RotaryDeltaForward(
            base_radius=configure.base_radius,
            effector_radius=configure.effector_radius,
            upper_arm=configure.upper_arm,
            forearm=configure.forearm,
            azimuth=configure.azimuth,
            tool_offset=configure.tool_offset,
        )
        per_rad = configure.microsteps_per_rad
        if forward.tip([r / m for r, m in zip(configure.ready, per_rad, strict=True)]) is None:
            return None
    return Parameters(
        configure=configure,
        joints=len(configure.ready),
        accelerations=tuple(a << _TO_Q32 for a in configure.acceleration),
        homing_together=Options.HOMING_TOGETHER in configure.options,
        forward=forward,
    )


def _makes_sense(configure: Configure, tick_hz: int) -> bool:
    c = configure
    joints = len(c.microsteps_per_rad)
    per_joint = (c.joint_min, c.joint_max, c.velocity, c.acceleration, c.unhomed_velocity)
    per_joint += (c.inverted, c.homing_switch, c.homing_fast, c.homing_slow, c.homing_backoff)
    per_joint += (c.homing_max_travel, c.ready)
    return (
        1 <= joints <= 4
        and all(len(values) == joints for values in per_joint)
        and c.homing_direction in (-1, 1)
        and all(
            _joint_makes_sense(c, joint)
            and _speeds_make_sense(c, joint, tick_hz)
            and _homing_makes_sense(c, joint)
            for joint in range(joints)
        )
        and _finite(c.tool_offset)
        and all(low < high for low, high in (c.workspace_x, c.workspace_y, c.workspace_z))
        and c.workspace_radius > 0
        and (c.kind is RobotKind.JOINTS_ONLY or _geometry_makes_sense(c))
    )


def _joint_makes_sense(c: Configure, joint: int) -> bool:
    low, high, ready = c.joint_min[joint], c.joint_max[joint], c.ready[joint] << 10
    per_rad = c.microsteps_per_rad[joint]
    return low < high and low <= ready <= high and per_rad > 0 and isfinite(per_rad)


def _speeds_make_sense(c: Configure, joint: int, tick_hz: int) -> bool:
    velocity, acceleration = c.velocity[joint], c.acceleration[joint]
    return (
        velocity > 0
        and c.unhomed_velocity[joint] > 0
        and velocity * _TWO_TICKS_A_STEP <= tick_hz << 16
        and acceleration >= _LEAST_ACCELERATION
        and velocity << 8 <= acceleration * _BRAKE_MS_MAX
    )


def _homing_makes_sense(c: Configure, joint: int) -> bool:
    """What is bounded here keeps positions and times of homing inside their integers."""
    fast, slow, switch = c.homing_fast[joint], c.homing_slow[joint], c.homing_switch[joint]
    furthest = max(c.homing_backoff[joint], c.homing_max_travel[joint], abs(switch))
    way = max(furthest, abs(c.ready[joint] - switch))
    return (
        0 < fast <= c.velocity[joint]
        and 0 < slow <= c.velocity[joint]
        and min(c.homing_backoff[joint], c.homing_max_travel[joint]) > 0
        and furthest <= _HOMING_MICROSTEPS_MAX
        and way << 16 <= min(fast, slow) * _HOMING_MS_MAX
    )


def _geometry_makes_sense(c: Configure) -> bool:
    arms = (c.base_radius, c.effector_radius, c.upper_arm, c.forearm, c.azimuth)
    return (
        len(c.ready) == len(c.tool_offset) == 3
        and all(len(values) == 3 and _finite(values) for values in arms)
        and min(*c.upper_arm, *c.forearm) > 0
    )


def _finite(values: Iterable[float]) -> bool:
    return all(map(isfinite, values))
