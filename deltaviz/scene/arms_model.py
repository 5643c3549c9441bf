"""What every drawn robot of arms has: arms, forearms of two rods, a ghost, labels.

True lengths, plausible thicknesses. Base, effector and what else makes a kind of robot are drawn
by the classes below it.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod

import viser

from deltaviz.robots import Robot
from deltaviz.scene import colours, rotations, shapes
from deltaviz.scene.rig import Dimensions, Rig
from deltaviz.scene.shapes import Shape

SIDEWAYS = rotations.about(0, -math.pi / 2)  # turns +z to +y
_SAME = 0.02  # mm and, far below a mm, rad: a target this near is where the robot is
_UNKNOWN_OPACITY = 0.25
_GHOST_OPACITY = 0.28


class ArmsModel(ABC):
    """Implements RobotModel."""

    effector: viser.MeshHandle

    def __init__(self, scene: viser.SceneApi, robot: Robot) -> None:
        self._scene = scene
        self.size = Dimensions.of(robot)
        self._names = robot.joint_names
        self.reach = float((self.size.base_radius + self.size.upper_arm).max())
        self.thickness = self.size.thickness
        self._pose: tuple[tuple[float, ...], tuple[float, ...]] | None = None
        self._known = True
        self._rig = Rig(scene, "/robot", self.size)
        self._solid: list[viser.MeshHandle] = []
        self._joints: list[tuple[viser.MeshHandle, ...]] = []
        self._add_base()
        for i in range(len(self.size.azimuth)):
            self._joints.append(self._add_arm(i))
            self._add_rods(i)
        self.effector = self._add_effector()
        self._joints += self._add_tool()
        self._tints = [colours.STEEL] * len(self._joints)
        self._ghost = Rig(scene, "/ghost/robot", self.size)
        self._ghost.root.visible = False
        self._add_ghost()
        self._add_labels()
        ready = robot.homing.ready  # whole, until a pose is reported
        self.show(ready, tuple(robot.forward(ready).tolist()))

    @abstractmethod
    def _add_base(self) -> None:
        """What stands still, below `/robot`."""

    @abstractmethod
    def _add_effector(self) -> viser.MeshHandle:
        """What moves with the effector; the part to be grabbed."""

    @abstractmethod
    def _add_tool(self) -> list[tuple[viser.MeshHandle, ...]]:
        """The tool; for each joint of its own, the parts that are tinted near its limits."""

    @abstractmethod
    def _ghost_parts(self) -> dict[str, Shape]:
        """What the ghost has besides arms and forearms, by the frames that carry it."""

    def show(self, theta: tuple[float, ...], xyz: tuple[float, ...]) -> None:
        self._pose = (theta, xyz)
        self._rig.move(theta, xyz)

    def show_target(self, theta: tuple[float, ...] | None, xyz: tuple[float, ...] | None) -> None:
        if theta is None or xyz is None or self._is_here(theta, xyz):
            self._ghost.root.visible = False
            return
        self._ghost.move(theta, xyz)
        self._ghost.root.visible = True

    def show_margins(self, margins: tuple[float, ...]) -> None:
        tints = [colours.tint(colours.STEEL, margin) for margin in margins]
        for i, (parts, colour) in enumerate(zip(self._joints, tints, strict=False)):
            if colour != self._tints[i]:
                self._tints[i] = colour
                for part in parts:
                    part.color = colour

    def show_known(self, known: bool) -> None:
        if known != self._known:
            self._known = known
            for part in self._solid:
                part.opacity = None if known else _UNKNOWN_OPACITY

    def remove(self) -> None:
        for name in ("/robot", "/ghost/robot", "/labels/robot"):
            self._scene.remove_by_name(name)

    def _is_here(self, theta: tuple[float, ...], xyz: tuple[float, ...]) -> bool:
        if self._pose is None:
            return False
        shown, wanted = (*self._pose[0], *self._pose[1]), (*theta, *xyz)
        return all(abs(a - b) < _SAME for a, b in zip(shown, wanted, strict=True))

    def add(self, name: str, shape: Shape, colour: colours.Colour) -> viser.MeshHandle:
        """A part of the solid robot."""
        part = self._scene.add_mesh_simple(name, shape.vertices, shape.faces, color=colour)
        self._solid.append(part)
        return part

    def motor(self, arm: int) -> Shape:
        """Two barrels on the axis with the arm between them, hung from the plate."""
        d, unit = self.size, self.thickness
        barrel = shapes.cylinder(0.165 * unit, 0.12 * unit, 0.44 * unit, bevel=0.02 * unit)
        both = barrel.turned(SIDEWAYS) + barrel.turned(rotations.about(0, math.pi / 2))
        hanger = shapes.beam(0.16 * unit, (0.2 * unit, 0.22 * unit), (0.2 * unit, 0.3 * unit))
        upright = hanger.turned(rotations.about(1, -math.pi / 2))
        sides = (upright.moved((0.0, s * 0.28 * unit, 0.1 * unit)) for s in (-1.0, 1.0))
        turned = rotations.about(2, d.azimuth[arm])
        return shapes.joined(both, *sides).turned(turned).moved(d.outward[arm] * d.base_radius[arm])

    def _add_arm(self, arm: int) -> tuple[viser.MeshHandle, ...]:
        unit, length = self.thickness, float(self.size.upper_arm[arm])
        beam = shapes.beam(length, (0.15 * unit, 0.2 * unit), (0.1 * unit, 0.1 * unit))
        root = f"/robot/arm{arm}"
        self.add(f"{root}/beam", beam, colours.UPPER_ARM)
        hub = shapes.cylinder(0.185 * unit, -0.1 * unit, 0.1 * unit, bevel=0.02 * unit)
        elbow = self.shaft(arm)
        return (
            self.add(f"{root}/hub", hub.turned(SIDEWAYS), colours.STEEL),
            self.add(f"{root}/elbow", elbow.moved((length, 0.0, 0.0)), colours.STEEL),
        )

    def shaft(self, arm: int) -> Shape:
        """A shaft along y with two ball joints, for the ends of a forearm."""
        unit, spacing = self.thickness, float(self.size.rod_spacing[arm])
        shaft = shapes.cylinder(0.032 * unit, -spacing, spacing, segments=shapes.THIN_SEGMENTS)
        ball = shapes.sphere(0.062 * unit)
        balls = ball.moved((0.0, -spacing, 0.0)) + ball.moved((0.0, spacing, 0.0))
        return shaft.turned(SIDEWAYS) + balls

    def _add_rods(self, arm: int) -> None:
        rod = self.rod(float(self.size.forearm[arm]))
        for k in range(2):
            self.add(f"/robot/forearm{arm}/rod{k}/rod", rod, colours.ROD)

    def rod(self, length: float) -> Shape:
        """A rod along -z with sockets at both ends."""
        unit = self.thickness
        thin, thick, socket = 0.026 * unit, 0.046 * unit, 0.13 * unit
        return shapes.lathe(
            [
                (0.0, -length),
                (thick, 0.03 * unit - length),
                (thick, socket - length),
                (thin, 1.35 * socket - length),
                (thin, -1.35 * socket),
                (thick, -socket),
                (thick, -0.03 * unit),
                (0.0, 0.0),
            ],
            segments=shapes.THIN_SEGMENTS,
        )

    def _add_ghost(self) -> None:
        d, unit = self.size, self.thickness
        for name, part in self._ghost_parts().items():
            self._add_shade(name, part)
        for i, (upper_arm, forearm) in enumerate(zip(d.upper_arm, d.forearm, strict=True)):
            arm = shapes.cylinder(0.045 * unit, 0.0, float(upper_arm))
            self._add_shade(f"arm{i}/beam", arm.turned(rotations.about(1, math.pi / 2)))
            rod = shapes.cylinder(0.022 * unit, -float(forearm), 0.0)
            for k in range(2):
                self._add_shade(f"forearm{i}/rod{k}/rod", rod)

    def _add_shade(self, name: str, shape: Shape) -> None:
        self._scene.add_mesh_simple(
            f"/ghost/robot/{name}",
            shape.vertices,
            shape.faces,
            color=colours.GHOST,
            opacity=_GHOST_OPACITY,
            cast_shadow=False,
            receive_shadow=False,
        )

    def _add_labels(self) -> None:
        d, unit = self.size, self.thickness
        self._scene.add_frame("/labels/robot", show_axes=False)
        for i, outward in enumerate(d.outward):
            x, y, _ = outward * (d.base_radius[i] + 0.45 * unit)
            self._add_label(i, (x, y, 0.45 * unit))
        if d.tool_turns:
            self._add_label(len(d.outward), (0.0, 0.0, 0.9 * unit))

    def _add_label(self, joint: int, position: tuple[float, float, float]) -> None:
        self._scene.add_label(
            f"/labels/robot/joint{joint}",
            self._names[joint],
            position=position,
            anchor="center-center",
        )
