"""The moving frames of a rotary delta: arms, forearms and effector, without anything drawn.

What is drawn hangs below these frames and never moves by itself, so one pose is thirteen
messages, whatever the robot looks like.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import viser

from deltaviz.mechanism import RotaryDelta
from deltaviz.robots import Robot
from deltaviz.scene import rotations
from deltaviz.scene.units import Array, metres


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


@dataclass(frozen=True)
class DeltaPose:
    """Where the frames are: metres and unit quaternions."""

    arm_wxyz: Array  # (n, 4)
    elbow: Array  # (n, 3)
    rod_wxyz: Array  # (n, 4)
    centre: Array  # (3,), of the effector


def pose_of(dimensions: DeltaDimensions, theta: Array, tip: Array) -> DeltaPose:
    """The frames at joint angles (n,) rad and a tool tip (3,) in metres."""
    d = dimensions
    centre = tip - d.tool_offset
    down = np.stack((np.zeros_like(theta), np.zeros_like(theta), -np.sin(theta)), axis=-1)
    along = np.cos(theta)[:, None] * d.outward + down
    elbow = d.base_radius[:, None] * d.outward + d.upper_arm[:, None] * along
    wrist = centre + d.effector_radius[:, None] * d.outward
    return DeltaPose(
        arm_wxyz=rotations.product(rotations.about(2, d.azimuth), rotations.about(1, theta)),
        elbow=elbow,
        rod_wxyz=rotations.from_down(wrist - elbow),
        centre=centre,
    )


class DeltaRig:
    """Frames below `root`: `arm0`.. at the motors (x along the arm, y along the axis),
    `forearm0/rod0`.. at the elbow's two joints (the rod along -z), `effector`."""

    def __init__(self, scene: viser.SceneApi, root: str, dimensions: DeltaDimensions) -> None:
        d = dimensions
        self._dimensions = d
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
        pose = pose_of(self._dimensions, np.asarray(theta), metres(xyz))
        for i, arm in enumerate(self.arms):
            arm.wxyz = pose.arm_wxyz[i]
            self.forearms[i].position = pose.elbow[i]
            for rod in self.rods[i]:
                rod.wxyz = pose.rod_wxyz[i]
        self.effector.position = pose.centre
