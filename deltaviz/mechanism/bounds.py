"""A robot's limits as plain numbers: what a compiled kernel must know of them."""

from __future__ import annotations

from dataclasses import dataclass

ROUNDING = 1e-6  # added to every margin, so that a pose exactly at a limit is legal


@dataclass(frozen=True, slots=True)
class Bounds:
    """Angles in rad, lengths in mm; box and radius bind the tool tip. None: no such limit."""

    tool_offset: tuple[float, ...]
    joint_min: tuple[float, ...]
    joint_max: tuple[float, ...]
    ball_joint_max: float | None
    z: tuple[float, float] | None = None
    x: tuple[float, float] | None = None
    y: tuple[float, float] | None = None
    radius: float | None = None
