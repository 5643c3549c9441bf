"""The numbers of each joint, wherever in the file they stand, and what they must obey."""

from __future__ import annotations

from dataclasses import dataclass

from deltaviz.robots import schema
from deltaviz.robots.errors import Inconsistent

# The stepper's tick is 200 kHz and a step takes two; the board keeps 0.2 % for rounding.
MOST_STEPS_PER_SECOND = 99_800


@dataclass(frozen=True)
class Sections:
    """Where in the file a joint's numbers stand."""

    range: str
    limits: str
    drive: str
    homing: str


ARMS = Sections("joints", "limits.joint", "drive", "homing")
TOOL = Sections("tool_axis", "tool_axis.limits", "tool_axis.drive", "tool_axis.homing")


@dataclass(frozen=True)
class JointNumbers:
    """One joint, in degrees as in the file."""

    sections: Sections
    low: float
    high: float
    velocity: float
    acceleration: float
    unhomed_velocity: float
    microsteps_per_turn: float
    invert: bool
    switch: float
    fast: float
    slow: float
    backoff: float
    max_travel: float
    ready: float

    def check(self, *, up: bool) -> None:
        """Raises Inconsistent. `up`: homing goes towards smaller angles."""
        if not self.low < self.high:
            where = f"{self.sections.range}.max_deg"
            raise self._wrong("range", "min_deg", self.low, f"less than {where} ({self.high:g})")
        self._check_speeds()
        self._check_switch(up=up)

    def _check_speeds(self) -> None:
        limit = f"{self.sections.limits}.velocity_deg_s"
        if self.unhomed_velocity > self.velocity:
            raise self._wrong(
                "limits",
                "unhomed_velocity_deg_s",
                self.unhomed_velocity,
                f"at most {self.velocity:g}",
            )
        if self.fast > self.velocity:
            rule = f"at most {limit} ({self.velocity:g})"
            raise self._wrong("homing", "fast_deg_s", self.fast, rule)
        if self.slow > self.fast:
            rule = f"at most {self.sections.homing}.fast_deg_s ({self.fast:g})"
            raise self._wrong("homing", "slow_deg_s", self.slow, rule)
        rate = MOST_STEPS_PER_SECOND
        most = 360 * rate / self.microsteps_per_turn
        if self.velocity > most:
            rule = f"at most {most:.4g}: the board makes at most {rate} steps a second"
            raise self._wrong("limits", "velocity_deg_s", self.velocity, rule)

    def _check_switch(self, *, up: bool) -> None:
        bounds = self.sections.range
        if up and self.switch > self.low:
            rule = f"at or beyond {bounds}.min_deg ({self.low:g}), as homing goes up"
            raise self._wrong("homing", "switch_deg", self.switch, rule)
        if not up and self.switch < self.high:
            rule = f"at or beyond {bounds}.max_deg ({self.high:g}), as homing goes down"
            raise self._wrong("homing", "switch_deg", self.switch, rule)
        travel = (self.high - self.switch) if up else (self.switch - self.low)
        if self.max_travel < travel:
            rule = f"at least {travel:g}, the way from the other joint limit to the switch"
            raise self._wrong("homing", "max_travel_deg", self.max_travel, rule)
        if self.backoff > travel:
            rule = f"at most {travel:g}, the way from the switch to the other joint limit"
            raise self._wrong("homing", "backoff_deg", self.backoff, rule)

    def _wrong(self, section: str, name: str, value: float, rule: str) -> Inconsistent:
        field = f"{getattr(self.sections, section)}.{name}"
        return Inconsistent(field, value, f"must be {rule}")


def joint_numbers(file: schema.RobotFile) -> tuple[JointNumbers, ...]:
    """Raises Inconsistent for a motor whose numbers are missing or do not fit its kind."""
    arms = [_arm(file, index) for index in range(len(file.joints.min_deg))]
    tool = file.tool_axis if isinstance(file, schema.RotaryDeltaFile) else None
    return (*arms, _tool(tool, file.drive.kind)) if tool is not None else tuple(arms)


def _arm(file: schema.RobotFile, index: int) -> JointNumbers:
    motion, homing, drive = file.limits.joint, file.homing, file.drive
    return JointNumbers(
        sections=ARMS,
        low=file.joints.min_deg[index],
        high=file.joints.max_deg[index],
        velocity=motion.velocity_deg_s[index],
        acceleration=motion.acceleration_deg_s2[index],
        unhomed_velocity=motion.unhomed_velocity_deg_s[index],
        microsteps_per_turn=_microsteps_per_turn(drive, drive.kind, ARMS),
        invert=drive.invert[index] if drive.invert else False,
        switch=homing.switch_deg[index],
        fast=homing.fast_deg_s,
        slow=homing.slow_deg_s,
        backoff=homing.backoff_deg,
        max_travel=homing.max_travel_deg,
        ready=homing.ready_deg[index],
    )


def _tool(tool: schema.ToolAxis, drive_kind: str) -> JointNumbers:
    return JointNumbers(
        sections=TOOL,
        low=tool.min_deg,
        high=tool.max_deg,
        velocity=tool.limits.velocity_deg_s,
        acceleration=tool.limits.acceleration_deg_s2,
        unhomed_velocity=tool.limits.unhomed_velocity_deg_s,
        microsteps_per_turn=_microsteps_per_turn(tool.drive, drive_kind, TOOL),
        invert=tool.drive.invert,
        switch=tool.homing.switch_deg,
        fast=tool.homing.fast_deg_s,
        slow=tool.homing.slow_deg_s,
        backoff=tool.homing.backoff_deg,
        max_travel=tool.homing.max_travel_deg,
        ready=tool.homing.ready_deg,
    )


_NEEDED = {"step_dir": ("full_steps", "microsteps"), "servo": ("resolution_deg",)}


def _microsteps_per_turn(motor: schema.Motor, kind: str, sections: Sections) -> float:
    """Of the joint; for a servo, its smallest steps."""
    check_fields(motor, kind, _NEEDED, section=sections.drive)
    if motor.resolution_deg is not None:
        per_turn = 360.0 / motor.resolution_deg
    else:
        per_turn = float((motor.full_steps or 1) * (motor.microsteps or 1))
    return per_turn * motor.gear[0] / motor.gear[1]


def check_fields(
    motor: schema.Motor, kind: str, needed: dict[str, tuple[str, ...]], *, section: str
) -> None:
    """Raises Inconsistent unless the fields that each kind of drive needs are there, and those
    that only another needs are not."""
    for owner, names in needed.items():
        for name in names:
            value = getattr(motor, name)
            if owner == kind and value is None:
                raise Inconsistent(f"{section}.{name}", "missing", f'needed with kind = "{kind}"')
            if owner != kind and value is not None:
                raise Inconsistent(f"{section}.{name}", value, f'not used with kind = "{kind}"')
