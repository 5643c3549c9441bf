"""A designed robot as a robot file: the template's, with other lengths and another workspace."""

from __future__ import annotations

import math
import tomllib
from collections.abc import Sequence
from typing import Any

import numpy as np

from deltaviz.robots.design.candidate import Lengths, made
from deltaviz.robots.design.wish import Wish
from deltaviz.robots.file_text import file_text
from deltaviz.robots.robot import Robot

READY_DIGITS = 1  # of the degrees


def designed_file(
    text: str, template: Robot, *, name: str, lengths: Lengths, wish: Wish, notes: Sequence[str]
) -> str:
    """TOML; `text` is the template's own file. `notes` are lines of comment at its head.

    Homing ends at the middle of what is to be reached.
    """
    data = tomllib.loads(text)
    data["name"] = name
    data["geometry"] = _geometry(data["geometry"], template, lengths)
    data["workspace"] = _workspace(wish, lengths.floor)
    data["homing"]["ready_deg"] = _ready(template, lengths, wish)
    return file_text(data, notes)


def _geometry(old: dict[str, Any], template: Robot, lengths: Lengths) -> dict[str, Any]:
    kept = {key: old[key] for key in ("azimuths_deg", "tool_offset", "platform_half") if key in old}
    links = {"upper_arm": lengths.upper_arm, "forearm": lengths.forearm}
    if template.mechanism.joints == 2:
        return {"base_half": lengths.base, **links, **kept}
    radius, azimuths = template.mechanism.effector_radius, template.mechanism.azimuths_deg  # type: ignore[attr-defined]
    effector: Any = radius[0] if len(set(radius)) == 1 else list(radius)
    return {
        "base_radius": lengths.base,
        "effector_radius": effector,
        **links,
        **kept,
        "azimuths_deg": list(azimuths),
    }


def _workspace(wish: Wish, floor: float) -> dict[str, Any]:
    zone = wish.zone(floor)
    sides = {"z": zone.z, "x": zone.x, "y": zone.y}
    out: dict[str, Any] = {key: list(side) for key, side in sides.items() if side is not None}
    return out if zone.radius is None else {**out, "radius": zone.radius}


def _ready(template: Robot, lengths: Lengths, wish: Wish) -> list[float]:
    """Degrees, of the arms: the tool's own ready angle stands in its section."""
    middle = np.zeros(wish.dimensions)
    middle[-1] = lengths.floor + wish.body.height / 2
    robot = made(template, lengths)
    theta = robot.inverse(middle)[: robot.mechanism.joints]
    return [round(math.degrees(t), READY_DIGITS) for t in theta.tolist()]
