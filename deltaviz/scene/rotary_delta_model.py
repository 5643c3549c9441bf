"""The rotary delta as it is drawn: base, effector, and a tool that may turn."""

from __future__ import annotations

import viser

from deltaviz.scene import colours, rotations, shapes
from deltaviz.scene.arms_model import ArmsModel
from deltaviz.scene.rig import shaft_top
from deltaviz.scene.shapes import Shape
from deltaviz.scene.units import Array


class RotaryDeltaModel(ArmsModel):
    """A plate with motors, an effector plate; the tool's motor and telescopic shaft."""

    def _add_base(self) -> None:
        d, unit = self.size, self.thickness
        mounts = d.outward[:, :2] * d.base_radius[:, None] * 0.86
        outline = shapes.hull_outline(mounts, 0.24 * unit)
        hole = 0.42 * float(d.base_radius.min())
        above = 0.235 * unit
        plate = shapes.plate(outline, hole, above, above + 0.085 * unit, bevel=0.012 * unit)
        self.add("/robot/base", plate, colours.BASE)
        motors = shapes.joined(*map(self.motor, range(len(d.azimuth))))
        self.add("/robot/motors", motors, colours.MOTOR)

    def _add_effector(self) -> viser.MeshHandle:
        d, half = self.size, self._plate_half
        effector = self.add(
            "/robot/effector/plate",
            shapes.plate(self._outline, self._hole, -half, half, bevel=0.3 * half),
            colours.EFFECTOR,
        )
        wrists = [
            self.shaft(i).turned(rotations.about(2, azimuth)).moved(radius * outward)
            for i, (azimuth, radius, outward) in enumerate(
                zip(d.azimuth, d.effector_radius, d.outward, strict=True)
            )
        ]
        self.add("/robot/effector/wrists", shapes.joined(*wrists), colours.STEEL)
        return effector

    def _add_tool(self) -> list[tuple[viser.MeshHandle, ...]]:
        if self.size.tool_turns:
            self._add_shaft()
            self.add("/robot/effector/tool/pointer", self._pointer(), colours.UPPER_ARM)
            return [(self.add("/robot/effector/tool/hub", self._hub(), colours.STEEL),)]
        self.add("/robot/effector/tip", self._tip(), colours.STEEL)
        return []

    @property
    def _plate_half(self) -> float:
        return 0.04 * self.thickness

    @property
    def _hole(self) -> float:
        return 0.3 * float(self.size.effector_radius.min())

    @property
    def _outline(self) -> Array:
        d = self.size
        wrists = d.outward * d.effector_radius[:, None]
        return shapes.hull_outline(wrists[:, :2] * 0.72, 0.2 * float(d.effector_radius.min()))

    def _tip(self) -> Shape:
        """A collar in the plate's hole, and a cone to the tool tip if that is below it."""
        half, hole = self._plate_half, self._hole
        collar = shapes.lathe(
            [(hole, half), (hole, -half), (1.12 * hole, -half), (1.12 * hole, half), (hole, half)]
        )
        x, y, z = self.size.tool_offset
        if z > -2 * half:
            return collar
        cone = shapes.lathe([(0.0, z), (0.9 * hole, -half), (0.9 * hole, half), (0.0, half)])
        return collar + cone.moved((x, y, 0.0))

    def _add_shaft(self) -> None:
        """A motor on a bridge over the base's hole, and its telescopic shaft."""
        unit, hole = self.thickness, 0.42 * float(self.size.base_radius.min())
        plate = 0.32 * unit
        top = plate + 0.045 * unit
        bridge = shapes.cylinder(1.12 * hole, plate, top)
        motor = shapes.cylinder(0.17 * unit, top, 0.75 * unit, segments=shapes.THIN_SEGMENTS)
        self.add("/robot/tool_motor", bridge + motor, colours.MOTOR)
        longest = shaft_top(self.size)[2] - self.size.depth[0]
        tube = shapes.cylinder(0.07 * unit, -0.5 * longest, 0.0, segments=shapes.THIN_SEGMENTS)
        rod = shapes.cylinder(0.045 * unit, 0.0, 0.55 * longest, segments=shapes.THIN_SEGMENTS)
        self.add("/robot/shaft/tube", tube, colours.ROD)
        self.add("/robot/effector/shaft/rod", rod, colours.STEEL)

    def _hub(self) -> Shape:
        """From the plate's hole to the tool tip, or to a little below the plate."""
        half, wide = self._plate_half, 0.95 * self._hole
        low = min(-3.0 * half, float(self.size.tool_offset[2]))
        return shapes.lathe(
            [(0.0, low), (0.42 * wide, low), (wide, -2.2 * half), (wide, half), (0.0, half)],
            segments=shapes.THIN_SEGMENTS,
        )

    def _pointer(self) -> Shape:
        """Along the tool's own x and beyond the plate: its angle is to be seen."""
        unit, length = self.thickness, 1.3 * float(self.size.effector_radius.max())
        beam = shapes.beam(length, (0.09 * unit, 0.06 * unit), (0.05 * unit, 0.04 * unit))
        return beam.moved((0.0, 0.0, -2.0 * self._plate_half))

    def _ghost_parts(self) -> dict[str, Shape]:
        half = self._plate_half
        parts = {"effector/plate": shapes.plate(self._outline, self._hole, -half, half)}
        if self.size.tool_turns:
            parts["effector/tool/pointer"] = self._pointer()
        return parts
