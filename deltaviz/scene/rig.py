"""The moving frames of a robot: arms, forearms, effector and tool, without anything drawn.

What is drawn hangs below these frames and never moves by itself, so one pose is a dozen
messages, whatever the robot looks like. A five-bar is a delta of two arms that stand opposite.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import viser

from deltaviz.mechanism import FiveBar, RotaryDelta
from deltaviz.robots import Robot
from deltaviz.robots.coordinates import in_space
from deltaviz.scene.inner import place, turn
from deltaviz.scene.units import Array, metres

Point = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]
Joints = tuple[float, ...]


# Up and inward: never in one line with the arm, nor with its forearm.
_LINKS = (0.1, 0.11, 0.28)


@dataclass(frozen=True)
class Dimensions:
    """A robot in metres, per-arm arrays of shape (n,)."""

    base_radius: Array
    effector_radius: Array
    upper_arm: Array
    forearm: Array
    azimuth: Array
    tool_offset: Array  # (3,)
    tool_turns: bool
    thickness: float  # what the sizes of motors, arms and plates are made from
    rod_spacing: Array  # half the distance between the two rods of a forearm
    depth: tuple[float, float]  # of the tool tip's heights, low and high
    level_by: Array | None = None  # (3,): where the links stand beside arm 0 that keep it level

    @classmethod
    def of(cls, robot: Robot) -> Dimensions:
        mechanism = robot.mechanism
        assert isinstance(mechanism, RotaryDelta | FiveBar)
        lengths: dict[str, Any] = {
            "upper_arm": metres(mechanism.upper_arm),
            "forearm": metres(mechanism.forearm),
            "tool_offset": metres(in_space(robot.tool_offset)),
            "tool_turns": robot.tool_axis,
            "depth": tuple(metres(robot.zone.z).tolist()),
        }
        if isinstance(mechanism, FiveBar):
            return cls._of_five_bar(mechanism, lengths)
        base = metres(mechanism.base_radius)
        effector = metres(mechanism.effector_radius)
        thickness = float(min(base.mean(), lengths["upper_arm"].mean() * 1.1))
        spacing = min(0.3 * float(effector.min()), 0.24 * thickness)
        return cls(
            **lengths,
            base_radius=base,
            effector_radius=effector,
            azimuth=np.radians(mechanism.azimuths_deg),
            thickness=thickness,
            rod_spacing=np.full(len(base), spacing),
        )

    @classmethod
    def _of_five_bar(cls, mechanism: FiveBar, lengths: dict[str, Any]) -> Dimensions:
        thickness = float(min(0.9 * lengths["upper_arm"].mean(), 0.45 * lengths["forearm"].mean()))
        wide = sum(mechanism.platform_half) > 0
        return cls(
            **lengths,
            base_radius=metres(mechanism.base_half),
            effector_radius=metres(mechanism.platform_half),
            azimuth=np.array([math.pi, 0.0]),
            thickness=thickness,
            rod_spacing=thickness * np.array([0.24, 0.19]),  # the right arm's between the left's
            level_by=thickness * np.array(_LINKS) if wide else None,
        )

    @property
    def outward(self) -> Array:
        """Unit vectors from the centre to each motor, (n, 3)."""
        zero = np.zeros_like(self.azimuth)
        return np.stack((np.cos(self.azimuth), np.sin(self.azimuth), zero), axis=-1)

    @property
    def sideways(self) -> Array:
        """Unit vectors along each motor's axis, (n, 3)."""
        zero = np.zeros_like(self.azimuth)
        return np.stack((-np.sin(self.azimuth), np.cos(self.azimuth), zero), axis=-1)


class ArmPose(NamedTuple):
    """Where one arm's frames are: unit quaternions, and the elbow's centre in metres."""

    arm_wxyz: Quaternion
    elbow: Point
    rod_wxyz: Quaternion


def arm_poses(dimensions: Dimensions, theta: Joints, centre: Point) -> list[ArmPose]:
    """The arms at joint angles (rad) with the effector's centre at a place in metres.

    In plain numbers: for three arms that takes a tenth of what numpy's calls take.
    """
    d = dimensions
    out: list[ArmPose] = []
    lengths = zip(d.base_radius, d.effector_radius, d.upper_arm, d.azimuth, theta, strict=False)
    for base, effector, upper_arm, azimuth, angle in lengths:
        c, s = math.cos(azimuth), math.sin(azimuth)
        out_at = base + upper_arm * math.cos(angle)
        elbow = (out_at * c, out_at * s, -upper_arm * math.sin(angle))
        wrist = (centre[0] + effector * c, centre[1] + effector * s, centre[2])
        out.append(ArmPose(_outward_and_down(azimuth, angle), elbow, _hanging(elbow, wrist)))
    return out


def _outward_and_down(azimuth: float, angle: float) -> Quaternion:
    """+x turned down by `angle` about +y, then about +z to `azimuth`."""
    cz, sz = math.cos(azimuth / 2), math.sin(azimuth / 2)
    cy, sy = math.cos(angle / 2), math.sin(angle / 2)
    return (cz * cy, -sz * sy, cz * sy, sz * cy)


def _hanging(top: Point, bottom: Point) -> Quaternion:
    """The shortest turn of -z to the direction from one place to another, below it."""
    x, y, z = (b - a for a, b in zip(top, bottom, strict=True))
    length = math.hypot(x, y, z) or 1.0
    w, i, j = 1.0 - z / length, y / length, -x / length
    norm = math.hypot(w, i, j) or 1.0
    return (w / norm, i / norm, j / norm, 0.0)


class Rig:
    """Frames below `root`: `arm0`.. at the motors (x along the arm, y along the axis),
    `forearm0/rod0`.. at the elbow's two joints (the rod along -z), `effector`.

    Where links beside arm 0 keep the effector level, `link` is parallel to it and `forearm0/link`
    to its forearm. With a tool that turns also `shaft` at `shaft_top` (its far end along -z),
    `effector/shaft` (turned alike) and `effector/tool`, which turns.
    """

    def __init__(self, scene: viser.SceneApi, root: str, dimensions: Dimensions) -> None:
        d = dimensions
        self._dimensions = d
        self._offset: list[float] = d.tool_offset.tolist()
        self._scene = scene
        self.root = self._frame(root)
        self.arms = [
            self._frame(f"{root}/arm{i}", radius * outward)
            for i, (radius, outward) in enumerate(zip(d.base_radius, d.outward, strict=True))
        ]
        self.forearms = [self._frame(f"{root}/forearm{i}") for i in range(len(self.arms))]
        self.rods = [
            tuple(
                self._frame(f"{root}/forearm{i}/rod{k}", side * spacing * sideways)
                for k, side in enumerate((-1.0, 1.0))
            )
            for i, (spacing, sideways) in enumerate(zip(d.rod_spacing, d.sideways, strict=True))
        ]
        self.links: tuple[viser.FrameHandle, ...] = ()
        if d.level_by is not None:
            motor = d.base_radius[0] * d.outward[0]
            self.links = (
                self._frame(f"{root}/link", motor + d.level_by),
                self._frame(f"{root}/forearm0/link", d.level_by),
            )
        self.effector = self._frame(f"{root}/effector")
        self.shafts: tuple[viser.FrameHandle, ...] = ()
        if d.tool_turns:
            self.shafts = (
                self._frame(f"{root}/shaft", np.array(shaft_top(d))),
                self._frame(f"{root}/effector/shaft"),
            )
            self.tool = self._frame(f"{root}/effector/tool")

    def move(self, theta: tuple[float, ...], xyz: tuple[float, ...]) -> None:
        """Joint angles in rad, the tool tip in mm."""
        if not all(map(math.isfinite, (*theta, *xyz))):
            return
        tip = metres(in_space(xyz)).tolist()
        x, y, z = (a - b for a, b in zip(tip, self._offset, strict=True))
        poses = arm_poses(self._dimensions, theta, (x, y, z))
        for i, pose in enumerate(poses):
            turn(self.arms[i], pose.arm_wxyz)
            place(self.forearms[i], pose.elbow)
            for rod in self.rods[i]:
                turn(rod, pose.rod_wxyz)
        place(self.effector, (x, y, z))
        if self.links:
            turn(self.links[0], poses[0].arm_wxyz)
            turn(self.links[1], poses[0].rod_wxyz)
        if self.shafts:
            along = _hanging(shaft_top(self._dimensions), (x, y, z))
            for shaft in self.shafts:
                turn(shaft, along)
            turn(self.tool, (math.cos(theta[-1] / 2), 0.0, 0.0, math.sin(theta[-1] / 2)))

    def _frame(self, name: str, position: Array | None = None) -> viser.FrameHandle:
        where = np.zeros(3) if position is None else position
        return self._scene.add_frame(name, show_axes=False, position=where)


def shaft_top(dimensions: Dimensions) -> Point:
    """The upper joint of the tool's shaft, below the motor that turns it."""
    return (0.0, 0.0, 0.2 * dimensions.thickness)
