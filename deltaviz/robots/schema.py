"""The robot file as pydantic sees it: fields, types, and rules of one field at a time.

There is one form for each kind of robot. Angles are in degrees here, as a person writes them;
how many values "per arm" means comes as the context of the validation, {"arms": n}. `build` makes
the robot of it.
"""

from __future__ import annotations

import math
from typing import Annotated, Any, Literal, TypeAlias

from pydantic import BaseModel, BeforeValidator, ConfigDict, ValidationInfo

LONGEST = 100_000.0  # mm


class Rule(ValueError):
    """What would be legal."""


def _finite(value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise Rule("must be a number")
    if not math.isfinite(value):
        raise Rule("must be finite")
    return float(value)


def _between(low: float, high: float, rule: str = "") -> Any:
    """One finite number strictly between two bounds."""
    rule = rule or f"must be between {low:g} and {high:g}, and neither of them"

    def check(value: object) -> float:
        number = _finite(value)
        if not low < number < high:
            raise Rule(rule)
        return number

    return check


def _half(value: object) -> float:
    number = _finite(value)
    if not 0 <= number <= LONGEST:
        raise Rule("must be at least 0" if number < 0 else f"must be at most {LONGEST:g} mm")
    return number


def _each(check: Any) -> Any:
    """One value for all arms or one for each."""

    def check_all(value: object, info: ValidationInfo) -> tuple[Any, ...]:
        arms = _arms(info)
        if not isinstance(value, list):
            return (check(value),) * arms
        if len(value) != arms:
            raise Rule(f"must be one value, or {arms} (one per arm)")
        return tuple(check(entry) for entry in value)

    return check_all


def _arms(info: ValidationInfo) -> int:
    return (info.context or {})["arms"]


def _list_of(check: Any, count: int, rule: str) -> Any:
    def check_all(value: object) -> tuple[Any, ...]:
        if not isinstance(value, list) or len(value) != count:
            raise Rule(rule)
        return tuple(check(entry) for entry in value)

    return check_all


def _directions(value: object, info: ValidationInfo) -> tuple[float, ...]:
    arms = _arms(info)
    return _list_of(_finite, arms, f"must be {arms} directions (one per arm)")(value)


def _planar_offset(value: object) -> tuple[float, ...]:
    x, y, z = _list_of(_finite, 3, "must be [x, 0, z]")(value)
    if y != 0:
        raise Rule("must be [x, 0, z]: a planar robot has no y")
    return x, z


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
    """Of coordinates, mm."""
    low, high = _list_of(_finite, 2, "must be [low, high]")(value)
    if not low < high:
        raise Rule("must be [low, high] with low < high")
    if max(-low, high) > LONGEST:
        raise Rule(f"must lie between -{LONGEST:g} and {LONGEST:g} mm")
    return low, high


def _length(value: object) -> float:
    """mm; far beyond it, differences of squares are lost to rounding."""
    number = _above_zero(value)
    if number > LONGEST:
        raise Rule(f"must be at most {LONGEST:g} mm")
    return number


_above_zero = _between(0.0, math.inf, "must be greater than 0")
_angle = _between(-180.0, 180.0)

Positive = Annotated[float, BeforeValidator(_above_zero)]
PerArm = Annotated[tuple[float, ...], BeforeValidator(_each(_above_zero))]
Length = Annotated[float, BeforeValidator(_length)]
Lengths = Annotated[tuple[float, ...], BeforeValidator(_each(_length))]
Halves = Annotated[tuple[float, ...], BeforeValidator(_each(_half))]
Angles = Annotated[tuple[float, ...], BeforeValidator(_each(_angle))]
Flag = Annotated[bool, BeforeValidator(_flag)]
Flags = Annotated[tuple[bool, ...], BeforeValidator(_each(_flag))]
Azimuths = Annotated[tuple[float, ...], BeforeValidator(_directions)]
Offset = Annotated[tuple[float, ...], BeforeValidator(_list_of(_finite, 3, "must be [x, y, z]"))]
PlanarOffset = Annotated[tuple[float, ...], BeforeValidator(_planar_offset)]
Gear = Annotated[
    tuple[float, float],
    BeforeValidator(_list_of(_above_zero, 2, "must be [motor turns, arm turns]")),
]
Range = Annotated[tuple[float, float], BeforeValidator(_range)]
Whole = Annotated[int, BeforeValidator(_whole)]
Text = Annotated[str, BeforeValidator(_text)]
BallJoint = Annotated[float, BeforeValidator(_between(0.0, 90.0))]
Turn = Annotated[float, BeforeValidator(_between(-1080.0, 1080.0))]


class Section(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class DeltaGeometry(Section):
    """Radii, or the sides of the base's and the effector's triangle (Trossen's f and e)."""

    base_radius: Lengths | None = None
    effector_radius: Lengths | None = None
    base_side: Length | None = None
    effector_side: Length | None = None
    upper_arm: Lengths
    forearm: Lengths
    azimuths_deg: Azimuths | None = None  # 0, 120, 240; with sides -90, 30, 150
    tool_offset: Offset = (0.0, 0.0, 0.0)


class FiveBarGeometry(Section):
    base_half: Halves
    platform_half: Halves
    upper_arm: Lengths
    forearm: Lengths
    tool_offset: PlanarOffset = (0.0, 0.0)


class Joints(Section):
    min_deg: Angles
    max_deg: Angles


class DeltaJoints(Joints):
    ball_joint_max_deg: BallJoint


class DeltaWorkspace(Section):
    z: Range
    radius: Length | None = None
    x: Range | None = None
    y: Range | None = None


class FiveBarWorkspace(Section):
    x: Range
    z: Range


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


class Motor(Section):
    """A stepper needs `full_steps` and `microsteps`; a servo `resolution_deg`, its smallest
    step."""

    full_steps: Whole | None = None
    microsteps: Whole | None = None
    resolution_deg: Positive | None = None
    gear: Gear = (1.0, 1.0)


class Drive(Motor):
    """Of all motors; servos are simulated only, and have no driver and no enable line."""

    kind: Literal["step_dir", "servo"]
    invert: Flags = ()  # none
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


class ToolMotion(Section):
    velocity_deg_s: Positive
    acceleration_deg_s2: Positive
    unhomed_velocity_deg_s: Positive


class ToolMotor(Motor):
    invert: Flag = False


class ToolHoming(Section):
    switch_deg: Turn
    fast_deg_s: Positive
    slow_deg_s: Positive
    backoff_deg: Positive
    max_travel_deg: Positive
    ready_deg: Turn


class ToolAxis(Section):
    """A joint that turns the tool about z, behind the arms' joints."""

    min_deg: Turn
    max_deg: Turn
    limits: ToolMotion
    drive: ToolMotor
    homing: ToolHoming


class Bodies(Section):
    """How thick the parts are, for the collisions of the workspace's analysis."""

    base_thickness: Length
    upper_arm_diameter: Length
    rod_diameter: Length
    rod_spacing: Length
    effector_thickness: Length


class PlanarBodies(Section):
    """As `Bodies`, of parts that all lie in one plane."""

    base_thickness: Length
    upper_arm_width: Length
    forearm_width: Length
    platform_thickness: Length


class Masses(Section):
    """What the parts weigh, for torques."""

    effector_kg: Positive
    upper_arm_kg: Positive
    forearm_kg: Positive
    motor_inertia_kg_m2: Positive


class RotaryDeltaFile(Section):
    name: Text
    kind: Literal["rotary_delta"]
    geometry: DeltaGeometry
    joints: DeltaJoints
    workspace: DeltaWorkspace
    limits: Limits
    drive: Drive
    homing: Homing
    tool_axis: ToolAxis | None = None
    bodies: Bodies | None = None
    masses: Masses | None = None


class FiveBarFile(Section):
    name: Text
    kind: Literal["five_bar"]
    geometry: FiveBarGeometry
    joints: Joints
    workspace: FiveBarWorkspace
    limits: Limits
    drive: Drive
    homing: Homing
    bodies: PlanarBodies | None = None
    masses: Masses | None = None


RobotFile: TypeAlias = RotaryDeltaFile | FiveBarFile

# Each kind's form, and how many arms it has.
FORMS: dict[str, tuple[type[RotaryDeltaFile] | type[FiveBarFile], int]] = {
    "rotary_delta": (RotaryDeltaFile, 3),
    "five_bar": (FiveBarFile, 2),
}
