"""The robot file as pydantic sees it: fields, types, and rules of one field at a time.

Angles are in degrees here, as a person writes them. `build` makes the robot of it.
"""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict


class Rule(ValueError):
    """What would be legal."""


def _finite(value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise Rule("must be a number")
    if not math.isfinite(value):
        raise Rule("must be finite")
    return float(value)


def _between(low: float, high: float, rule: str) -> Any:
    """One finite number strictly between two bounds."""

    def check(value: object) -> float:
        number = _finite(value)
        if not low < number < high:
            raise Rule(rule)
        return number

    return check


def _each(check: Any, count: int = 3) -> Any:
    """One value for all arms or one for each."""

    def check_all(value: object) -> tuple[Any, ...]:
        if not isinstance(value, list):
            return (check(value),) * count
        if len(value) != count:
            raise Rule(f"must be one value, or {count} (one per arm)")
        return tuple(check(entry) for entry in value)

    return check_all


def _list_of(check: Any, count: int, rule: str) -> Any:
    def check_all(value: object) -> tuple[Any, ...]:
        if not isinstance(value, list) or len(value) != count:
            raise Rule(rule)
        return tuple(check(entry) for entry in value)

    return check_all


def _whole(value: object) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or not 1 <= value <= 1_000_000:
        raise Rule("must be a whole number from 1 to 1000000")
    return value


def _flag(value: object) -> bool:
    if not isinstance(value, bool):
        raise Rule("must be true or false")
    return value


def _text(value: object) -> str:
    if not isinstance(value, str) or not value.strip() or len(value) > 64:
        raise Rule("must be a text of 1 to 64 characters")
    return value


def _range(value: object) -> tuple[float, float]:
    low, high = _list_of(_finite, 2, "must be [low, high]")(value)
    if not low < high:
        raise Rule("must be [low, high] with low < high")
    return low, high


_above_zero = _between(0.0, math.inf, "must be greater than 0")
_angle = _between(-180.0, 180.0, "must be between -180 and 180")

Positive = Annotated[float, BeforeValidator(_above_zero)]
PerArm = Annotated[tuple[float, ...], BeforeValidator(_each(_above_zero))]
Angles = Annotated[tuple[float, ...], BeforeValidator(_each(_angle))]
Flags = Annotated[tuple[bool, ...], BeforeValidator(_each(_flag))]
Azimuths = Annotated[
    tuple[float, ...], BeforeValidator(_list_of(_finite, 3, "must be one direction per arm"))
]
Offset = Annotated[tuple[float, ...], BeforeValidator(_list_of(_finite, 3, "must be [x, y, z]"))]
Gear = Annotated[
    tuple[float, float],
    BeforeValidator(_list_of(_above_zero, 2, "must be [motor turns, arm turns]")),
]
Range = Annotated[tuple[float, float], BeforeValidator(_range)]
Whole = Annotated[int, BeforeValidator(_whole)]
Text = Annotated[str, BeforeValidator(_text)]
BallJoint = Annotated[float, BeforeValidator(_between(0.0, 90.0, "must be between 0 and 90"))]


class Section(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class Geometry(Section):
    """Radii, or the sides of the base's and the effector's triangle (Trossen's f and e)."""

    base_radius: PerArm | None = None
    effector_radius: PerArm | None = None
    base_side: Positive | None = None
    effector_side: Positive | None = None
    upper_arm: PerArm
    forearm: PerArm
    azimuths_deg: Azimuths | None = None  # 0, 120, 240; with sides -90, 30, 150
    tool_offset: Offset = (0.0, 0.0, 0.0)


class Joints(Section):
    min_deg: Angles
    max_deg: Angles
    ball_joint_max_deg: BallJoint


class Workspace(Section):
    z: Range
    radius: Positive | None = None
    x: Range | None = None
    y: Range | None = None


class JointMotion(Section):
    velocity_deg_s: PerArm
    acceleration_deg_s2: PerArm
    unhomed_velocity_deg_s: PerArm


class CartesianMotion(Section):
    velocity: Positive
    acceleration: Positive
    jerk: Positive


class Limits(Section):
    joint: JointMotion
    cartesian: CartesianMotion


class Drive(Section):
    """A stepper needs `full_steps`, `microsteps`, `driver`, `enable_active`; a servo (simulated
    only) `resolution_deg`, its smallest step."""

    kind: Literal["step_dir", "servo"]
    full_steps: Whole | None = None
    microsteps: Whole | None = None
    resolution_deg: Positive | None = None
    gear: Gear = (1.0, 1.0)
    invert: Flags = (False, False, False)
    driver: Text | None = None
    enable_active: Literal["low", "high"] | None = None


class Homing(Section):
    direction: Literal["up", "down"]
    switch_deg: Angles
    switch_active: Literal["open", "closed"]
    fast_deg_s: Positive
    slow_deg_s: Positive
    backoff_deg: Positive
    max_travel_deg: Positive
    order: Literal["together", "one_by_one"]
    ready_deg: Angles


class RobotFile(Section):
    name: Text
    kind: Literal["rotary_delta"]
    geometry: Geometry
    joints: Joints
    workspace: Workspace
    limits: Limits
    drive: Drive
    homing: Homing
