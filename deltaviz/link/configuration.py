"""What a board is told about its robot, and the number by which both sides name it."""

from __future__ import annotations

import hashlib
import struct
from collections.abc import Iterable, Iterator
from dataclasses import fields
from math import radians
from typing import TYPE_CHECKING

from deltaviz.link.messages import Configure

if TYPE_CHECKING:  # the simulated board's process needs the hash, and none of the robots' imports
    from deltaviz.robots import Robot


def configure_from(robot: Robot) -> Configure:
    """What the board must know to guard `robot`. For a mechanism whose forward kinematics the
    board does not have, the geometry is empty: it guards the joints alone.
    """
    joint, homing = robot.limits.joint, robot.homing
    return Configure(
        kind=robot.kind,
        geometry=_geometry(robot),
        tool_offset=_floats(robot.tool_offset),
        joint_min=_floats(robot.joints.min),
        joint_max=_floats(robot.joints.max),
        workspace_z=robot.workspace.z,
        workspace_radius=robot.workspace.radius,
        velocity=_floats(joint.velocity),
        acceleration=_floats(joint.acceleration),
        unhomed_velocity=_floats(joint.unhomed_velocity),
        microsteps_per_rad=_floats(robot.drive.microsteps_per_rad),
        inverted=tuple(robot.drive.invert),
        homing_direction=homing.direction,
        homing_switch=_floats(homing.switch),
        homing_fast=homing.fast,
        homing_slow=homing.slow,
        homing_backoff=homing.backoff,
        homing_max_travel=homing.max_travel,
        homing_together=homing.together,
        ready=_floats(homing.ready),
        workspace_x=robot.workspace.x,
        workspace_y=robot.workspace.y,
    )


def _geometry(robot: Robot) -> tuple[tuple[str, tuple[float, ...]], ...]:
    from deltaviz.mechanism import RotaryDelta

    arms = robot.mechanism
    if not isinstance(arms, RotaryDelta):
        return ()
    return (
        ("base_radius", _floats(arms.base_radius)),
        ("effector_radius", _floats(arms.effector_radius)),
        ("upper_arm", _floats(arms.upper_arm)),
        ("forearm", _floats(arms.forearm)),
        ("azimuths", tuple(radians(azimuth) for azimuth in arms.azimuths_deg)),
    )


def _floats(values: Iterable[float]) -> tuple[float, ...]:
    return tuple(float(value) for value in values)


def configuration_hash(configure: Configure) -> int:
    """A number from 1 to 2^32 - 1 that is the same for equal values, on every machine."""
    digest = hashlib.sha256()
    for field in fields(configure):
        digest.update(field.name.encode())
        for part in _parts(getattr(configure, field.name)):
            digest.update(part)
    return int.from_bytes(digest.digest()[:4], "little") or 1


def _parts(value: object) -> Iterator[bytes]:
    if value is None:
        yield b"-"
    elif isinstance(value, str):
        yield b"s%d:" % len(value) + value.encode()
    elif isinstance(value, bool | int | float):
        yield b"f" + struct.pack("<d", value + 0.0)  # + 0.0: the two zeros are equal
    elif isinstance(value, tuple):
        yield b"("
        for item in value:  # pyright: ignore[reportUnknownVariableType]
            yield from _parts(item)  # pyright: ignore[reportUnknownArgumentType]
        yield b")"
    else:
        raise TypeError(f"a configuration has no {type(value).__name__}")
