"""What a board is told about its robot, and the number by which both sides name it."""

from __future__ import annotations

import struct
from collections.abc import Iterable
from dataclasses import fields
from math import inf, radians
from typing import TYPE_CHECKING, cast
from zlib import crc32

from deltaviz.link.messages import Configure, Options, RobotKind
from deltaviz.link.wire.codec import encode
from deltaviz.link.wire.errors import Unsendable

if TYPE_CHECKING:  # the simulated board's process needs the hash, and none of the robots' imports
    from deltaviz.mechanism import Mechanism
    from deltaviz.robots import Robot

P_UNIT = 1024  # 2^-10 microsteps in one microstep
V_UNIT = 65.536  # 2^-16 microsteps/ms in one microstep/s
A_UNIT = 2**24 / 1e6  # 2^-24 microsteps/ms² in one microstep/s²
I32_MAX = 2**31 - 1


def configure_from(robot: Robot) -> Configure:
    """What the board must know to guard `robot`. For a mechanism whose forward kinematics the
    board does not have, the geometry is all zeros: it guards the joints alone.

    Speeds are rounded down. Joint limits are rounded so that the ready pose, which is a whole
    number of microsteps, lies inside.
    """
    joint, homing, workspace = robot.limits.joint, robot.homing, robot.zone
    per_rad = robot.drive.microsteps_per_rad
    ready = _microsteps(homing.ready, per_rad)
    return Configure(
        kind=_kind(robot),
        options=_options(robot),
        homing_direction=homing.direction,
        joint_min=tuple(map(min, _microsteps(robot.joints.min, per_rad, P_UNIT), _knots(ready))),
        joint_max=tuple(map(max, _microsteps(robot.joints.max, per_rad, P_UNIT), _knots(ready))),
        velocity=_down(joint.velocity, per_rad, V_UNIT),
        acceleration=_down(joint.acceleration, per_rad, A_UNIT),
        unhomed_velocity=_down(joint.unhomed_velocity, per_rad, V_UNIT),
        microsteps_per_rad=_floats(per_rad),
        inverted=tuple(robot.drive.invert),
        homing_switch=_microsteps(homing.switch, per_rad),
        homing_fast=_down(map(min, homing.fast, joint.velocity), per_rad, V_UNIT),
        homing_slow=_down(map(min, homing.slow, joint.velocity), per_rad, V_UNIT),
        homing_backoff=_microsteps(homing.backoff, per_rad),
        homing_max_travel=_microsteps(homing.max_travel, per_rad),
        ready=ready,
        workspace_x=_range(workspace.x),
        workspace_y=_range(workspace.y),
        workspace_z=_range(workspace.z),
        workspace_radius=inf if workspace.radius is None else _floats([workspace.radius])[0],
        **_geometry(robot),
    )


def configuration_hash(configure: Configure) -> int:
    """From 1 to 2^32 - 1; the same for equal values, on every machine."""
    _, payload = encode(configure)
    return crc32(payload) or 1


def check_configurable(robot: Robot) -> None:
    """Raises RobotFileError for a robot with numbers that no message to a board can carry."""
    from deltaviz.robots import RobotFileError

    try:
        configure = configure_from(robot)
    except OverflowError as error:
        raise RobotFileError(_untellable(robot, "a limit")) from error
    try:
        encode(configure)
    except Unsendable as error:
        large = [field.name for field in fields(configure) if _is_large(configure, field.name)]
        what = ", ".join(large).replace("_", " ")
        raise RobotFileError(_untellable(robot, what)) from error


def _is_large(configure: Configure, field: str) -> bool:
    numbers: object = getattr(configure, field)
    if not isinstance(numbers, tuple):
        return False
    return any(
        isinstance(number, int) and abs(number) > I32_MAX
        for number in cast("tuple[object, ...]", numbers)
    )


def _untellable(robot: Robot, what: str) -> str:
    return (
        f"A board cannot be told about {robot.name}: {what} is too large in its microsteps. "
        "Lower it, or drive.microsteps or drive.gear, in the robot's file."
    )


def _options(robot: Robot) -> Options:
    options = Options.NONE
    if robot.homing.together:
        options |= Options.HOMING_TOGETHER
    if robot.homing.switch_active == "open":
        options |= Options.SWITCH_ACTIVE_OPEN
    if robot.drive.enable_active == "high":
        options |= Options.ENABLE_ACTIVE_HIGH
    return options


def _kind(robot: Robot) -> RobotKind:
    from deltaviz.mechanism import FiveBar, RotaryDelta

    match robot.mechanism:
        case RotaryDelta():
            return RobotKind.ROTARY_DELTA
        case FiveBar():
            return RobotKind.FIVE_BAR
        case _:
            return RobotKind.JOINTS_ONLY


def _geometry(robot: Robot) -> dict[str, tuple[float, ...]]:
    """Each field with one number per joint: 0 for one that is no arm's."""
    from deltaviz.robots.coordinates import SPACE, in_space

    per_arm = _arms(robot.mechanism)
    none = (0.0,) * robot.joint_count
    fields = {
        name: _floats((*per_arm.get(name, ()), *none)[: robot.joint_count])
        for name in ("base_radius", "effector_radius", "upper_arm", "forearm", "azimuth")
    }
    offset = in_space(robot.tool_offset) if per_arm else (0.0,) * len(SPACE)
    return fields | {"tool_offset": _floats(offset)}


def _arms(mechanism: Mechanism) -> dict[str, tuple[float, ...]]:
    """The numbers of each arm; empty for a mechanism that the board does not know."""
    from deltaviz.mechanism import FiveBar, RotaryDelta

    match mechanism:
        case RotaryDelta():
            return {
                "base_radius": mechanism.base_radius,
                "effector_radius": mechanism.effector_radius,
                "upper_arm": mechanism.upper_arm,
                "forearm": mechanism.forearm,
                "azimuth": tuple(map(radians, mechanism.azimuths_deg)),
            }
        case FiveBar():
            return {
                "base_radius": mechanism.base_half,
                "effector_radius": mechanism.platform_half,
                "upper_arm": mechanism.upper_arm,
                "forearm": mechanism.forearm,
            }
        case _:
            return {}


def _microsteps(
    angles: Iterable[float], per_rad: Iterable[float], unit: int = 1
) -> tuple[int, ...]:
    return tuple(round(angle * m * unit) for angle, m in zip(angles, per_rad, strict=True))


def _down(rates: Iterable[float], per_rad: Iterable[float], unit: float) -> tuple[int, ...]:
    """Whole units, and never none: a speed that is too slow for the board is its slowest."""
    return tuple(max(1, int(rate * m * unit)) for rate, m in zip(rates, per_rad, strict=True))


def _knots(microsteps: Iterable[int]) -> tuple[int, ...]:
    return tuple(value * P_UNIT for value in microsteps)


def _range(limits: tuple[float, float] | None) -> tuple[float, float]:
    low, high = _floats((-inf, inf) if limits is None else limits)
    return low, high


def _floats(values: Iterable[float]) -> tuple[float, ...]:
    """As the wire carries them: single precision, and one zero."""
    exact = [value + 0.0 for value in values]
    return struct.unpack(f"<{len(exact)}f", struct.pack(f"<{len(exact)}f", *exact))
