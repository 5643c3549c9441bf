"""The moving frames of a rotary delta: arms, forearms and effector, without anything drawn.

What is drawn hangs below these frames and never moves by itself, so one pose is thirteen
messages, whatever the robot looks like.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import viser

from deltaviz.mechanism import RotaryDelta
from deltaviz.robots import Robot
from deltaviz.scene.inner import place, turn
from deltaviz.scene.units import Array, metres

Point = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]
Joints = tuple[float, ...]


@dataclass(frozen=True)
class DeltaDimensions:
    """A rotary delta in metres, per-arm arrays of shape (n,)."""

    base_radius: Array
    effector_radius: Array
    upper_arm: Array
    forearm: Array
    azimuth: Array
    tool_offset: Array  # (3,)

    @classmethod
    def of(cls, robot: Robot) -> DeltaDimensions:
        mechanism = robot.mechanism
        assert isinstance(mechanism, RotaryDelta)
        return cls(
            base_radius=metres(mechanism.base_radius),
            effector_radius=metres(mechanism.effector_radius),
            upper_arm=metres(mechanism.upper_arm),
            forearm=metres(mechanism.forearm),
            azimuth=np.radians(mechanism.azimuths_deg),
            tool_offset=metres(robot.tool_offset),
        )

    @property
    def thickness(self) -> float:
        """What the sizes of motors, arms and plates are made from."""
        return float(min(self.base_radius.mean(), self.upper_arm.mean() * 1.1))

    @property
    def rod_spacing(self) -> float:
        """Half the distance between the two rods of a forearm."""
        return min(0.3 * float(self.effector_radius.min()), 0.24 * self.thickness)

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


def arm_poses(dimensions: DeltaDimensions, theta: Joints, centre: Point) -> list[ArmPose]:
    """The arms at joint angles (rad) with the effector's centre at a place in metres.

    In plain numbers: for three arms that takes a tenth of what numpy's calls take.
    """
    d = dimensions
    out: list[ArmPose] = []
    lengths = zip(d.base_radius, d.effector_radius, d.upper_arm, d.azimuth, theta, strict=True)
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


class DeltaRig:
    """Frames below `root`: `arm0`.. at the motors (x along the arm, y along the axis),
    `forearm0/rod0`.. at the elbow's two joints (the rod along -z), `effector`."""

    def __init__(self, scene: viser.SceneApi, root: str, dimensions: DeltaDimensions) -> None:
        d = dimensions
        self._dimensions = d
        self._offset: list[float] = d.tool_offset.tolist()
        self.root = scene.add_frame(root, show_axes=False)
        self.arms = [
            scene.add_frame(f"{root}/arm{i}", show_axes=False, position=radius * outward)
            for i, (radius, outward) in enumerate(zip(d.base_radius, d.outward, strict=True))
        ]
        self.forearms = [
            scene.add_frame(f"{root}/forearm{i}", show_axes=False) for i in range(len(self.arms))
        ]
        self.rods = [
            tuple(
                scene.add_frame(
                    f"{root}/forearm{i}/rod{k}",
                    show_axes=False,
                    position=side * d.rod_spacing * sideways,
                )
                for k, side in enumerate((-1.0, 1.0))
            )
            for i, sideways in enumerate(d.sideways)
        ]
        self.effector = scene.add_frame(f"{root}/effector", show_axes=False)

    def move(self, theta: tuple[float, ...], xyz: tuple[float, ...]) -> None:
        """Joint angles in rad, the tool tip in mm."""
        if not all(map(math.isfinite, (*theta, *xyz))):
            return
        x, y, z = (a - b for a, b in zip(metres(xyz).tolist(), self._offset, strict=True))
        for i, pose in enumerate(arm_poses(self._dimensions, theta, (x, y, z))):
            turn(self.arms[i], pose.arm_wxyz)
            place(self.forearms[i], pose.elbow)
            for rod in self.rods[i]:
                turn(rod, pose.rod_wxyz)
        place(self.effector, (x, y, z))
