"""From a robot file that has the right fields to a robot that makes sense."""

from __future__ import annotations

import itertools
import math

import numpy as np

from deltaviz.mechanism import GeometryError, RotaryDelta
from deltaviz.robots import robot as made
from deltaviz.robots import schema

MOST_STEPS_PER_SECOND = 100_000  # the stepper's tick is 200 kHz, and a step takes two


class Inconsistent(ValueError):
    """A field that contradicts another; `rule` says what would be legal."""

    def __init__(self, field: str, value: object, rule: str) -> None:
        super().__init__(f"{field} = {value}: {rule}")
        self.field = field
        self.value = value
        self.rule = rule


def build(file: schema.RobotFile) -> made.Robot:
    """Raises Inconsistent, naming the field."""
    robot = made.Robot(
        name=file.name,
        kind=file.kind,
        mechanism=_mechanism(file.geometry),
        tool_offset=file.geometry.tool_offset,
        joints=_joints(file.joints),
        workspace=_workspace(file.workspace),
        limits=_limits(file.limits),
        drive=_drive(file.drive),
        homing=_homing(file.homing),
    )
    _check_speeds(robot, file)
    _check_homing(robot, file)
    _check_ready(robot, file)
    return robot


def _mechanism(geometry: schema.Geometry) -> RotaryDelta:
    radii = (geometry.base_radius, geometry.effector_radius)
    sides = (geometry.base_side, geometry.effector_side)
    try:
        if None not in radii and sides == (None, None):
            return RotaryDelta(
                base_radius=geometry.base_radius or (),
                effector_radius=geometry.effector_radius or (),
                upper_arm=geometry.upper_arm,
                forearm=geometry.forearm,
                azimuths_deg=geometry.azimuths_deg or (0.0, 120.0, 240.0),
            )
        if None not in sides and radii == (None, None):
            return RotaryDelta.from_sides(
                f=geometry.base_side or 0.0,
                e=geometry.effector_side or 0.0,
                upper_arm=geometry.upper_arm,
                forearm=geometry.forearm,
                azimuths_deg=geometry.azimuths_deg or (-90.0, 30.0, 150.0),
            )
    except GeometryError as error:
        raise Inconsistent(f"geometry.{error.field}", error.value, error.rule) from error
    given = [name for name in _SIZES if getattr(geometry, name) is not None]
    raise Inconsistent(
        "geometry",
        f"has {' and '.join(given) or 'none of them'}",
        "must give either base_radius and effector_radius, or base_side and effector_side",
    )


_SIZES = ("base_radius", "effector_radius", "base_side", "effector_side")


def _joints(joints: schema.Joints) -> made.Joints:
    for low, high in zip(joints.min_deg, joints.max_deg, strict=True):
        if not low < high:
            raise Inconsistent(
                "joints.min_deg", low, f"must be less than joints.max_deg ({high:g})"
            )
    return made.Joints(
        min=_radians(joints.min_deg),
        max=_radians(joints.max_deg),
        ball_joint_max=math.radians(joints.ball_joint_max_deg),
    )


def _workspace(space: schema.Workspace) -> made.Workspace:
    if space.radius is None and (space.x is None or space.y is None):
        raise Inconsistent(
            "workspace", "has neither", "must give radius (a cylinder), or x and y (a box)"
        )
    return made.Workspace(z=space.z, radius=space.radius, x=space.x, y=space.y)


def _limits(limits: schema.Limits) -> made.Limits:
    return made.Limits(
        joint=made.JointMotion(
            velocity=_radians(limits.joint.velocity_deg_s),
            acceleration=_radians(limits.joint.acceleration_deg_s2),
            unhomed_velocity=_radians(limits.joint.unhomed_velocity_deg_s),
        ),
        cartesian=made.CartesianMotion(
            velocity=limits.cartesian.velocity,
            acceleration=limits.cartesian.acceleration,
            jerk=limits.cartesian.jerk,
        ),
    )


def _drive(drive: schema.Drive) -> made.Drive:
    kind = made.DriveKind(drive.kind)
    needed = {
        made.DriveKind.STEP_DIR: ("full_steps", "microsteps", "driver", "enable_active"),
        made.DriveKind.SERVO: ("resolution_deg",),
    }
    for owner, names in needed.items():
        for name in names:
            value = getattr(drive, name)
            if owner is kind and value is None:
                raise Inconsistent(f"drive.{name}", "missing", f'needed with kind = "{drive.kind}"')
            if owner is not kind and value is not None:
                raise Inconsistent(f"drive.{name}", value, f'not used with kind = "{drive.kind}"')
    if drive.resolution_deg is not None:
        per_turn = 360.0 / drive.resolution_deg
    else:
        per_turn = float((drive.full_steps or 1) * (drive.microsteps or 1))
    per_rad = per_turn * drive.gear[0] / drive.gear[1] / (2 * math.pi)
    return made.Drive(
        kind=kind,
        microsteps_per_rad=(per_rad,) * len(drive.invert),
        invert=drive.invert,
        gear=drive.gear,
        full_steps=drive.full_steps,
        microsteps=drive.microsteps,
        driver=drive.driver,
        enable_active=drive.enable_active,
    )


def _homing(homing: schema.Homing) -> made.Homing:
    return made.Homing(
        direction=-1 if homing.direction == "up" else 1,
        switch=_radians(homing.switch_deg),
        switch_active=homing.switch_active,
        fast=math.radians(homing.fast_deg_s),
        slow=math.radians(homing.slow_deg_s),
        backoff=math.radians(homing.backoff_deg),
        max_travel=math.radians(homing.max_travel_deg),
        together=homing.order == "together",
        ready=_radians(homing.ready_deg),
    )


def _check_speeds(robot: made.Robot, file: schema.RobotFile) -> None:
    joint = file.limits.joint
    for fast, slow in zip(joint.velocity_deg_s, joint.unhomed_velocity_deg_s, strict=True):
        if slow > fast:
            raise Inconsistent(
                "limits.joint.unhomed_velocity_deg_s", slow, f"must be at most {fast:g}"
            )
        if file.homing.fast_deg_s > fast:
            raise Inconsistent(
                "homing.fast_deg_s",
                file.homing.fast_deg_s,
                f"must be at most limits.joint.velocity_deg_s ({fast:g})",
            )
    if file.homing.slow_deg_s > file.homing.fast_deg_s:
        raise Inconsistent(
            "homing.slow_deg_s",
            file.homing.slow_deg_s,
            f"must be at most homing.fast_deg_s ({file.homing.fast_deg_s:g})",
        )
    for fast, steps in zip(joint.velocity_deg_s, robot.drive.microsteps_per_rad, strict=True):
        most = MOST_STEPS_PER_SECOND / steps
        if math.radians(fast) > most:
            raise Inconsistent(
                "limits.joint.velocity_deg_s",
                fast,
                f"must be at most {math.degrees(most):.4g}: the board makes at most "
                f"{MOST_STEPS_PER_SECOND} steps a second",
            )


def _check_homing(robot: made.Robot, file: schema.RobotFile) -> None:
    joints, homing = file.joints, file.homing
    up = homing.direction == "up"
    for switch, low, high in zip(homing.switch_deg, joints.min_deg, joints.max_deg, strict=True):
        if up and switch > low:
            rule = f'with direction = "up" must be at or beyond joints.min_deg ({low:g})'
            raise Inconsistent("homing.switch_deg", switch, rule)
        if not up and switch < high:
            rule = f'with direction = "down" must be at or beyond joints.max_deg ({high:g})'
            raise Inconsistent("homing.switch_deg", switch, rule)
        travel = (high - switch) if up else (switch - low)
        if homing.max_travel_deg < travel:
            raise Inconsistent(
                "homing.max_travel_deg",
                homing.max_travel_deg,
                f"must be at least {travel:g}, the way from the other joint limit to the switch",
            )
    if not np.isfinite(robot.forward(robot.homing.switch)).all():
        raise Inconsistent(
            "homing.switch_deg",
            list(homing.switch_deg),
            _MUST_MEET,
        )


_MUST_MEET = "must be a pose in which the forearms can meet"


def _check_ready(robot: made.Robot, file: schema.RobotFile) -> None:
    ready = robot.homing.ready
    tip = robot.forward(ready)
    given = list(file.homing.ready_deg)
    if not np.isfinite(tip).all():
        raise Inconsistent("homing.ready_deg", given, _MUST_MEET)
    margins = robot.margins(tip, ready)
    if (margins >= 0).all():
        return
    if not _workspace_reachable(robot):
        raise Inconsistent(
            "workspace", "as given", "must hold at least one point that the robot can reach"
        )
    broken = zip(robot.margin_names, margins.tolist(), strict=True)
    limits = ", ".join(str(name) for name, margin in broken if margin < 0)
    where = ", ".join(f"{value:.1f}" for value in tip)
    raise Inconsistent(
        "homing.ready_deg",
        given,
        f"must lie within all limits; there the tool tip is at ({where}) mm, beyond: {limits}",
    )


def _workspace_reachable(robot: made.Robot) -> bool:
    space = robot.workspace
    across = (-(space.radius or math.inf), space.radius or math.inf)
    axes = [
        np.linspace(max(low, across[0]), min(high, across[1]), 21)
        for low, high in (space.x or across, space.y or across)
    ]
    axes.append(np.linspace(*space.z, 31))
    points = np.array(list(itertools.product(*axes)))
    margins = robot.margins(points, robot.inverse(points))
    return bool((margins >= 0).all(axis=-1).any())


def _radians(degrees: tuple[float, ...]) -> tuple[float, ...]:
    return tuple(math.radians(value) for value in degrees)
