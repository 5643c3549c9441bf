"""From a robot file that has the right fields to a robot that makes sense."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable

import numpy as np

from deltaviz.mechanism import FiveBar, GeometryError, Mechanism, RotaryDelta
from deltaviz.mechanism.masses import Masses
from deltaviz.robots import robot as made
from deltaviz.robots import schema
from deltaviz.robots.bodies import Bodies, PlanarBodies
from deltaviz.robots.closing import can_meet, shortest_forearm
from deltaviz.robots.errors import Inconsistent
from deltaviz.robots.joint_numbers import JointNumbers, check_fields, joint_numbers


def build(file: schema.RobotFile) -> made.Robot:
    """Raises Inconsistent, naming the field."""
    try:
        mechanism = _mechanism(file)
    except GeometryError as error:
        raise Inconsistent(f"geometry.{error.field}", error.value, error.rule) from error
    joints = joint_numbers(file)
    for joint in joints:
        joint.check(up=file.homing.direction == "up")
    has_tool_axis = len(joints) > mechanism.joints
    robot = made.Robot(
        name=file.name,
        kind=file.kind,
        mechanism=mechanism,
        tool_offset=file.geometry.tool_offset,
        tool_axis=has_tool_axis,
        joints=_joints(file, joints),
        zone=_zone(file.workspace),
        limits=_limits(file.limits, joints),
        drive=_drive(file.drive, joints),
        homing=_homing(file.homing, joints),
        bodies=_bodies(file.bodies),
        masses=_masses(file.masses),
    )
    if has_tool_axis:
        _check_tool(robot, joints[-1])
    _check_closing(robot, file)
    _check_ready(robot, file)
    return robot


def _mechanism(file: schema.RobotFile) -> Mechanism:
    match file:
        case schema.RotaryDeltaFile():
            return _rotary_delta(file.geometry)
        case schema.FiveBarFile():
            geometry = file.geometry
            return FiveBar(
                base_half=geometry.base_half,
                platform_half=geometry.platform_half,
                upper_arm=geometry.upper_arm,
                forearm=geometry.forearm,
            )


def _rotary_delta(geometry: schema.DeltaGeometry) -> RotaryDelta:
    radii = (geometry.base_radius, geometry.effector_radius)
    sides = (geometry.base_side, geometry.effector_side)
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
    given = [name for name in _SIZES if getattr(geometry, name) is not None]
    raise Inconsistent(
        "geometry",
        f"has {' and '.join(given) or 'none of them'}",
        "must give either base_radius and effector_radius, or base_side and effector_side",
    )


_SIZES = ("base_radius", "effector_radius", "base_side", "effector_side")


def _joints(file: schema.RobotFile, joints: tuple[JointNumbers, ...]) -> made.Joints:
    ball_joint_max = None
    if isinstance(file, schema.RotaryDeltaFile):
        ball_joint_max = math.radians(file.joints.ball_joint_max_deg)
    return made.Joints(
        min=_radians(joints, lambda j: j.low),
        max=_radians(joints, lambda j: j.high),
        ball_joint_max=ball_joint_max,
    )


def _zone(space: schema.DeltaWorkspace | schema.FiveBarWorkspace) -> made.Zone:
    if isinstance(space, schema.FiveBarWorkspace):
        return made.Zone(z=space.z, x=space.x)
    if space.radius is None and (space.x is None or space.y is None):
        raise Inconsistent(
            "workspace", "has neither", "must give radius (a cylinder), or x and y (a box)"
        )
    return made.Zone(z=space.z, radius=space.radius, x=space.x, y=space.y)


def _limits(limits: schema.Limits, joints: tuple[JointNumbers, ...]) -> made.Limits:
    return made.Limits(
        joint=made.JointMotion(
            velocity=_radians(joints, lambda j: j.velocity),
            acceleration=_radians(joints, lambda j: j.acceleration),
            unhomed_velocity=_radians(joints, lambda j: j.unhomed_velocity),
        ),
        cartesian=made.CartesianMotion(
            velocity=limits.cartesian.velocity,
            acceleration=limits.cartesian.acceleration,
            jerk=limits.cartesian.jerk,
        ),
    )


def _drive(drive: schema.Drive, joints: tuple[JointNumbers, ...]) -> made.Drive:
    board_drives = {"step_dir": ("driver", "enable_active")}
    check_fields(drive, drive.kind, board_drives, section="drive")
    return made.Drive(
        kind=made.DriveKind(drive.kind),
        microsteps_per_rad=tuple(j.microsteps_per_turn / (2 * math.pi) for j in joints),
        invert=tuple(j.invert for j in joints),
        driver=drive.driver,
        enable_active=drive.enable_active,
    )


def _homing(homing: schema.Homing, joints: tuple[JointNumbers, ...]) -> made.Homing:
    return made.Homing(
        direction=-1 if homing.direction == "up" else 1,
        switch=_radians(joints, lambda j: j.switch),
        switch_active=homing.switch_active,
        fast=_radians(joints, lambda j: j.fast),
        slow=_radians(joints, lambda j: j.slow),
        backoff=_radians(joints, lambda j: j.backoff),
        max_travel=_radians(joints, lambda j: j.max_travel),
        together=homing.order == "together",
        ready=_radians(joints, lambda j: j.ready),
    )


def _radians(
    joints: tuple[JointNumbers, ...], value: Callable[[JointNumbers], float]
) -> tuple[float, ...]:
    return tuple(math.radians(value(joint)) for joint in joints)


def _bodies(bodies: schema.Bodies | schema.PlanarBodies | None) -> Bodies | PlanarBodies | None:
    if bodies is None:
        return None
    if isinstance(bodies, schema.PlanarBodies):
        return PlanarBodies(**bodies.model_dump())
    for thickness in ("upper_arm_diameter", "effector_thickness"):
        between = getattr(bodies, thickness) + bodies.rod_diameter
        if not bodies.rod_spacing > between:
            raise Inconsistent(
                "bodies.rod_spacing",
                bodies.rod_spacing,
                f"must be greater than bodies.{thickness} + bodies.rod_diameter ({between:g}): "
                "the rods pass on both sides",
            )
    return Bodies(**bodies.model_dump())


def _masses(masses: schema.Masses | None) -> Masses | None:
    if masses is None:
        return None
    return Masses(
        effector=masses.effector_kg,
        upper_arm=masses.upper_arm_kg,
        forearm=masses.forearm_kg,
        motor_inertia=masses.motor_inertia_kg_m2,
    )


def _check_tool(robot: made.Robot, tool: JointNumbers) -> None:
    if not tool.low <= tool.ready <= tool.high:
        field = f"{tool.sections.homing}.ready_deg"
        rule = f"must lie within its limits, {tool.low:g} and {tool.high:g}"
        raise Inconsistent(field, tool.ready, rule)
    if any(robot.tool_offset[:-1]):
        raise Inconsistent(
            "geometry.tool_offset",
            list(robot.tool_offset),
            "must be [0, 0, z] with a [tool_axis]: the tool turns about its tip",
        )


_MUST_MEET = "must be a pose in which the forearms can meet"


def _check_closing(robot: made.Robot, file: schema.RobotFile) -> None:
    mechanism, bounds = robot.mechanism, robot.bounds
    if can_meet(mechanism, bounds.joint_min, bounds.joint_max):
        return
    shortest = shortest_forearm(mechanism, bounds.joint_min, bounds.joint_max)
    length = f"greater than {shortest:.6g}" if shortest else "longer"
    raise Inconsistent(
        "geometry.forearm",
        list(file.geometry.forearm),
        f"must be {length}: between joints.min_deg and joints.max_deg the forearms cannot meet",
    )


def _check_ready(robot: made.Robot, file: schema.RobotFile) -> None:
    if not np.isfinite(robot.forward(robot.homing.switch)).all():
        raise Inconsistent("homing.switch_deg", list(file.homing.switch_deg), _MUST_MEET)
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
            "workspace",
            _told(file.workspace),
            "must hold at least one point that the robot can reach",
        )
    broken = zip(robot.margin_names, margins.tolist(), strict=True)
    limits = ", ".join(str(name) for name, margin in broken if margin < 0)
    where = ", ".join(f"{value:.1f}" for value in tip)
    raise Inconsistent(
        "homing.ready_deg",
        given,
        f"must lie within all limits; there the tool tip is at ({where}) mm, beyond: {limits}",
    )


def _told(zone: schema.DeltaWorkspace | schema.FiveBarWorkspace) -> str:
    """As the file has it."""
    values = zone.model_dump(exclude_none=True).items()
    return ", ".join(
        f"{name} {list(value) if isinstance(value, tuple) else value}" for name, value in values
    )


def _workspace_reachable(robot: made.Robot) -> bool:
    space = robot.zone
    across = (-(space.radius or math.inf), space.radius or math.inf)
    ranges = {"X": space.x or across, "Y": space.y or across, "Z": space.z}
    axes = [
        np.linspace(max(low, across[0]), min(high, across[1]), 21)
        for low, high in (ranges[axis] for axis in robot.axes[:-1])
    ]
    axes.append(np.linspace(*space.z, 31))
    points = np.array(list(itertools.product(*axes)))
    margins = robot.margins(points, robot.inverse(points))
    return bool((margins >= 0).all(axis=-1).any())
