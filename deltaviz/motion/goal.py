"""What a robot may be asked to follow. A goal says where to, never how."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Rest:
    """Come to rest along the present path, by the quickest brake."""


@dataclass(frozen=True, slots=True)
class ToPoint:
    """Follow a tool tip position (mm). Out of reach: slide along the boundary towards it.

    From rest and with `slide` off the way is straight. `speed` is a share (0-1] of the
    Cartesian velocity limit, before the feed override. `tool` is the angle (rad) to which a
    turning tool turns on the way; None: it comes to rest.
    """

    xyz: tuple[float, ...]
    speed: float = 1.0
    slide: bool = True
    tool: float | None = None


@dataclass(frozen=True, slots=True)
class ToAngles:
    """Follow joint angles (rad), all joints arriving together."""

    theta: tuple[float, ...]
    speed: float = 1.0


@dataclass(frozen=True, slots=True)
class AtVelocity:
    """Move the tool tip at a velocity (mm/s), until told otherwise or stopped by a limit."""

    xyz: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class AtJointVelocity:
    """Turn the joints at a velocity (rad/s), until told otherwise or stopped by a limit."""

    theta: tuple[float, ...]


Goal = Rest | ToPoint | ToAngles | AtVelocity | AtJointVelocity
