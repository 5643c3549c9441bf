"""A robot file with some of its numbers changed: another robot, to be looked at and written.

Of what follows from the changed numbers only the inevitable is changed with them: the switches stay
as far beyond the joint limits as they were, and the zone moves along z with the pose where homing
ends, if that would lie outside it.
"""

from __future__ import annotations

import copy
import math
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from deltaviz.robots.file_text import file_text
from deltaviz.robots.load import robot_of
from deltaviz.robots.robot import Robot

_NAMES = {
    "geometry.base_radius": "Base R",
    "geometry.effector_radius": "Effector r",
    "geometry.base_side": "Base f",
    "geometry.effector_side": "Effector e",
    "geometry.base_half": "Base half",
    "geometry.platform_half": "Platform half",
    "geometry.upper_arm": "Upper arm",
    "geometry.forearm": "Forearm",
    "joints.min_deg": "Joints min °",
    "joints.max_deg": "Joints max °",
}
_LENGTHS = 0.4, 2.0  # of what a length is: the range that is offered
_ANGLES = 45.0  # degrees to either side
_MOST_ANGLE = 179.0
_STEPS = 100  # at least, in a range; and no step is longer than 1
_DIGITS = 6


@dataclass(frozen=True)
class Parameter:
    """A number of the file that may be changed: of several arms it is the mean, and changing it
    changes all by as much. mm, or degrees where the `name` says so."""

    field: str
    name: str
    value: float
    low: float
    high: float
    step: float

    @property
    def shown(self) -> float:
        """`value` to a whole number of steps."""
        return round(round(self.value / self.step) * self.step, _DIGITS)


@dataclass(frozen=True)
class Made:
    """A changed robot; `zone_moved` (mm) is how far along z its zone had to move."""

    robot: Robot
    data: dict[str, Any]
    zone_moved: float

    def text(self, *, name: str, notes: Sequence[str]) -> str:
        """Its file; `notes` are lines of comment at its head."""
        return file_text({**self.data, "name": name}, notes)


class Draft:
    """`text` is the file of a robot that can be loaded."""

    def __init__(self, text: str) -> None:
        self._data = tomllib.loads(text)
        self._ready_z = _ready_z(robot_of(self._data))
        self.parameters = tuple(
            _parameter(field, name, _mean(_at(self._data, field)))
            for field, name in _NAMES.items()
            if _at(self._data, field) is not None
        )

    def made(self, values: Mapping[str, float]) -> Made:
        """The robot with other values of parameters, by their fields. Raises Faulty, which names
        the field and the rule."""
        data = copy.deepcopy(self._data)
        for field, value in values.items():
            _change(data, field, value)
        _carry_switches(data, self._data)
        return self._with_zone(data)

    def _with_zone(self, data: dict[str, Any]) -> Made:
        """What else is wrong is told by a robot that may go to any height."""
        low, high = data["workspace"]["z"]
        free = {**data, "workspace": {**data["workspace"], "z": _any_height(data)}}
        robot = robot_of(free)
        ready = _ready_z(robot)
        by = 0.0 if low <= ready <= high else ready - self._ready_z
        z = _moved([low, high], by)
        zone = replace(robot.zone, z=(z[0], z[1]))
        moved = {**data, "workspace": {**data["workspace"], "z": z}}
        return Made(replace(robot, zone=zone), moved, by)


def _parameter(field: str, name: str, value: float) -> Parameter:
    if field.endswith("_deg"):
        low, high = max(value - _ANGLES, -_MOST_ANGLE), min(value + _ANGLES, _MOST_ANGLE)
        return Parameter(field, name, value, float(round(low)), float(round(high)), 1.0)
    low, high = (share * value for share in _LENGTHS) if value > 0 else (0.0, 100.0)
    step = min(1.0, 10.0 ** math.floor(math.log10((high - low) / _STEPS)))
    low, high = math.floor(low / step) * step, math.ceil(high / step) * step
    return Parameter(field, name, value, round(low, _DIGITS), round(high, _DIGITS), step)


def _at(data: dict[str, Any], field: str) -> Any:
    section, key = field.split(".")
    return data[section].get(key)


def _mean(value: Any) -> float:
    return float(sum(value) / len(value)) if isinstance(value, list) else float(value)


def _moved(value: Any, by: float) -> Any:
    """A number, or each of a list: several arms keep their differences."""
    if by == 0.0:
        return value
    if isinstance(value, list):
        return [_moved(each, by) for each in value]
    return round(float(value) + by, _DIGITS)


def _change(data: dict[str, Any], field: str, value: float) -> None:
    section, key = field.split(".")
    old = data[section][key]
    data[section][key] = _moved(old, value - _mean(old))


def _carry_switches(data: dict[str, Any], old: dict[str, Any]) -> None:
    low, high = (
        _mean(data["joints"][end]) - _mean(old["joints"][end]) for end in ("min_deg", "max_deg")
    )
    homing = data["homing"]
    by = low if homing["direction"] == "up" else high
    if by:
        homing["switch_deg"] = _moved(homing["switch_deg"], by)
    if high > low:
        homing["max_travel_deg"] = _moved(homing["max_travel_deg"], high - low)


def _any_height(data: dict[str, Any]) -> list[float]:
    """Which the arms cannot leave."""
    lengths, tool = data["geometry"], data["geometry"].get("tool_offset", [0.0])
    reach = _most(lengths["upper_arm"]) + _most(lengths["forearm"])
    return [tool[-1] - reach, tool[-1] + reach]


def _most(value: Any) -> float:
    return float(max(value)) if isinstance(value, list) else float(value)


def _ready_z(robot: Robot) -> float:
    return float(robot.forward(robot.homing.ready)[-1])
