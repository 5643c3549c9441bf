"""The rotary delta as it is drawn: true lengths, plausible thicknesses."""

from __future__ import annotations

import math

import viser

from deltaviz.robots import Robot
from deltaviz.scene import colours, rotations, shapes
from deltaviz.scene.delta_rig import DeltaDimensions, DeltaRig
from deltaviz.scene.shapes import Shape

_SIDEWAYS = rotations.about(0, -math.pi / 2)  # turns +z to +y
_SAME = 0.02  # mm and, far below a mm, rad: a target this near is where the robot is
_UNKNOWN_OPACITY = 0.25
_GHOST_OPACITY = 0.28


class RotaryDeltaModel:
    """Base, motors, upper arms, forearms of two rods with ball joints, effector; a ghost."""

    def __init__(self, scene: viser.SceneApi, robot: Robot) -> None:
        self._scene = scene
        self._size = DeltaDimensions.of(robot)
        self.reach = float((self._size.base_radius + self._size.upper_arm).max())
        self.thickness = self._size.thickness
        self._pose: tuple[tuple[float, ...], tuple[float, ...]] | None = None
        self._known = True
        self._rig = DeltaRig(scene, "/robot", self._size)
        self._solid: list[viser.MeshHandle] = []
        self._joints: list[tuple[viser.MeshHandle, ...]] = []
        self._tints = [colours.STEEL] * len(self._size.azimuth)
        self._add_base()
        for i in range(len(self._size.azimuth)):
            self._add_arm(i)
            self._add_rods(i)
        self.effector = self._add_effector()
        self._ghost = DeltaRig(scene, "/ghost/robot", self._size)
        self._ghost.root.visible = False
        self._add_ghost()
        self._add_labels()

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

    def _add(self, name: str, shape: Shape, colour: colours.Colour) -> viser.MeshHandle:
        part = self._scene.add_mesh_simple(name, shape.vertices, shape.faces, color=colour)
        self._solid.append(part)
        return part

    def _add_base(self) -> None:
        d, unit = self._size, self._size.thickness
        mounts = d.outward[:, :2] * d.base_radius[:, None] * 0.86
        outline = shapes.hull_outline(mounts, 0.24 * unit)
        hole = 0.42 * float(d.base_radius.min())
        above = 0.235 * unit
        plate = shapes.plate(outline, hole, above, above + 0.085 * unit, bevel=0.012 * unit)
        self._add("/robot/base", plate, colours.BASE)
        self._add("/robot/motors", shapes.joined(*map(self._motor, range(3))), colours.MOTOR)

    def _motor(self, arm: int) -> Shape:
        """Two barrels on the axis with the arm between them, hung from the plate."""
        d, unit = self._size, self._size.thickness
        barrel = shapes.cylinder(0.165 * unit, 0.12 * unit, 0.44 * unit, bevel=0.02 * unit)
        both = barrel.turned(_SIDEWAYS) + barrel.turned(rotations.about(0, math.pi / 2))
        hanger = shapes.beam(0.16 * unit, (0.2 * unit, 0.22 * unit), (0.2 * unit, 0.3 * unit))
        upright = hanger.turned(rotations.about(1, -math.pi / 2))
        sides = (upright.moved((0.0, s * 0.28 * unit, 0.1 * unit)) for s in (-1.0, 1.0))
        turned = rotations.about(2, d.azimuth[arm])
        return shapes.joined(both, *sides).turned(turned).moved(d.outward[arm] * d.base_radius[arm])

    def _add_arm(self, arm: int) -> None:
        d, unit = self._size, self._size.thickness
        length = float(d.upper_arm[arm])
        beam = shapes.beam(length, (0.15 * unit, 0.2 * unit), (0.1 * unit, 0.1 * unit))
        root = f"/robot/arm{arm}"
        self._add(f"{root}/beam", beam, colours.UPPER_ARM)
        hub = shapes.cylinder(0.185 * unit, -0.1 * unit, 0.1 * unit, bevel=0.02 * unit)
        shaft = self._shaft()
        elbow = shaft.turned(_SIDEWAYS) + self._balls()
        self._joints.append(
            (
                self._add(f"{root}/hub", hub.turned(_SIDEWAYS), colours.STEEL),
                self._add(f"{root}/elbow", elbow.moved((length, 0.0, 0.0)), colours.STEEL),
            )
        )

    def _shaft(self) -> Shape:
        d = self._size
        return shapes.cylinder(
            0.032 * d.thickness, -d.rod_spacing, d.rod_spacing, segments=shapes.THIN_SEGMENTS
        )

    def _balls(self) -> Shape:
        """Two ball joints at the ends of a shaft along y."""
        ball, spacing = shapes.sphere(0.062 * self._size.thickness), self._size.rod_spacing
        return ball.moved((0.0, -spacing, 0.0)) + ball.moved((0.0, spacing, 0.0))

    def _add_rods(self, arm: int) -> None:
        unit, length = self._size.thickness, float(self._size.forearm[arm])
        thin, thick, socket = 0.026 * unit, 0.046 * unit, 0.13 * unit
        rod = shapes.lathe(
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
        for k in range(2):
            self._add(f"/robot/forearm{arm}/rod{k}/rod", rod, colours.ROD)

    def _add_effector(self) -> viser.MeshHandle:
        d, unit = self._size, self._size.thickness
        wrists = d.outward * d.effector_radius[:, None]
        outline = shapes.hull_outline(wrists[:, :2] * 0.72, 0.2 * float(d.effector_radius.min()))
        half, hole = 0.04 * unit, 0.3 * float(d.effector_radius.min())
        effector = self._add(
            "/robot/effector/plate",
            shapes.plate(outline, hole, -half, half, bevel=0.3 * half),
            colours.EFFECTOR,
        )
        wrist = self._shaft().turned(_SIDEWAYS) + self._balls()
        self._add(
            "/robot/effector/wrists",
            shapes.joined(
                *(
                    wrist.turned(rotations.about(2, azimuth)).moved(offset)
                    for azimuth, offset in zip(d.azimuth, wrists, strict=True)
                )
            ),
            colours.STEEL,
        )
        self._add("/robot/effector/tool", self._tool(hole, half), colours.STEEL)
        return effector

    def _tool(self, hole: float, half: float) -> Shape:
        """A collar in the plate's hole, and a cone to the tool tip if that is below it."""
        collar = shapes.lathe(
            [(hole, half), (hole, -half), (1.12 * hole, -half), (1.12 * hole, half), (hole, half)]
        )
        x, y, z = self._size.tool_offset
        if z > -2 * half:
            return collar
        cone = shapes.lathe([(0.0, z), (0.9 * hole, -half), (0.9 * hole, half), (0.0, half)])
        return collar + cone.moved((x, y, 0.0))

    def _add_ghost(self) -> None:
        d, unit = self._size, self._size.thickness
        arm_radius, rod_radius = 0.045 * unit, 0.022 * unit
        outline = shapes.hull_outline(
            (d.outward * d.effector_radius[:, None])[:, :2] * 0.72,
            0.2 * float(d.effector_radius.min()),
        )
        half, hole = 0.04 * unit, 0.3 * float(d.effector_radius.min())
        self._add_shade("effector/plate", shapes.plate(outline, hole, -half, half))
        for i, (upper_arm, forearm) in enumerate(zip(d.upper_arm, d.forearm, strict=True)):
            arm = shapes.cylinder(arm_radius, 0.0, float(upper_arm))
            turned = arm.turned(rotations.about(1, math.pi / 2))
            self._add_shade(f"arm{i}/beam", turned)
            rod = shapes.cylinder(rod_radius, -float(forearm), 0.0)
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
        d, unit = self._size, self._size.thickness
        self._scene.add_frame("/labels/robot", show_axes=False)
        for i, outward in enumerate(d.outward):
            self._scene.add_label(
                f"/labels/robot/joint{i}",
                f"θ{i + 1}",
                position=outward * (d.base_radius[i] + 0.45 * unit) + (0.0, 0.0, 0.45 * unit),
                anchor="center-center",
            )
