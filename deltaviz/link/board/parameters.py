"""A configuration as the board works with it: checked once, with what follows from it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from math import isfinite

from deltaviz.link.board.five_bar import FiveBar
from deltaviz.link.board.kinematics import Kinematics
from deltaviz.link.board.rotary_delta import RotaryDelta
from deltaviz.link.messages import Configure, Options, RobotKind
from deltaviz.link.rules import TICK_HZ_MIN

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
    kinematics: Kinematics | None  # of the first joints


def parameters_from(configure: Configure, *, tick_hz: int) -> Parameters | None:
    """None for a configuration that makes no sense: `Configure` says which do not."""
    if not _makes_sense(configure, tick_hz):
        return None
    kinematics = _kinematics(configure)
    if kinematics is not None and not _ready_has_a_tip(configure, kinematics):
        return None
    return Parameters(
        configure=configure,
        joints=len(configure.ready),
        accelerations=tuple(a << _TO_Q32 for a in configure.acceleration),
        homing_together=Options.HOMING_TOGETHER in configure.options,
        kinematics=kinematics,
    )


def _kinematics(c: Configure) -> Kinematics | None:
    if c.kind is RobotKind.ROTARY_DELTA:
        return RotaryDelta(
            base_radius=c.base_radius[:3],
            effector_radius=c.effector_radius[:3],
            upper_arm=c.upper_arm[:3],
            forearm=c.forearm[:3],
            azimuth=c.azimuth[:3],
            tool_offset=c.tool_offset,
        )
    if c.kind is RobotKind.FIVE_BAR:
        return FiveBar(
            base_half=c.base_radius,
            platform_half=c.effector_radius,
            upper_arm=c.upper_arm,
            forearm=c.forearm,
            tool_offset=c.tool_offset,
        )
    return None


def _ready_has_a_tip(c: Configure, kinematics: Kinematics) -> bool:
    arms = len(kinematics.arms)
    pose = zip(c.ready[:arms], c.microsteps_per_rad[:arms], strict=True)
    return kinematics.tip([ready / m for ready, m in pose]) is not None


def _makes_sense(configure: Configure, tick_hz: int) -> bool:
    c = configure
    joints = len(c.microsteps_per_rad)
    per_joint = (c.joint_min, c.joint_max, c.velocity, c.acceleration, c.unhomed_velocity)
    per_joint += (c.inverted, c.homing_switch, c.homing_fast, c.homing_slow, c.homing_backoff)
    per_joint += (c.homing_max_travel, c.ready, c.base_radius, c.effector_radius, c.upper_arm)
    per_joint += (c.forearm, c.azimuth)
    return (
        tick_hz >= TICK_HZ_MIN
        and 1 <= joints <= 4
        and all(len(values) == joints for values in per_joint)
        and c.homing_direction in (-1, 1)
        and all(
            _joint_makes_sense(c, joint)
            and _speeds_make_sense(c, joint, tick_hz)
            and _homing_makes_sense(c, joint)
            for joint in range(joints)
        )
        and len(c.tool_offset) == 3
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
    arms, joints = (2, (2,)) if c.kind is RobotKind.FIVE_BAR else (3, (3, 4))
    numbers = (c.base_radius, c.effector_radius, c.upper_arm, c.forearm, c.azimuth)
    return (
        len(c.ready) in joints
        and all(_finite(values[:arms]) for values in numbers)
        and min(*c.upper_arm[:arms], *c.forearm[:arms]) > 0
    )


def _finite(values: Iterable[float]) -> bool:
    return all(map(isfinite, values))
