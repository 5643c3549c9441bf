"""The five-bar as it is drawn: a beam with two motors, and a platform that links keep level."""

from __future__ import annotations

import math

import viser

from deltaviz.scene import colours, rotations, shapes
from deltaviz.scene.arms_model import SIDEWAYS, ArmsModel
from deltaviz.scene.shapes import Shape
from deltaviz.scene.units import Array


class FiveBarModel(ArmsModel):
    """Its plane is that of x and z; what is thick, is thick in y."""

    def _add_base(self) -> None:
        d, unit = self.size, self.thickness
        above, across = 0.235 * unit, 0.3 * unit
        half = float(d.base_radius.max()) + 0.4 * unit
        beam = shapes.block((-half, half), (-across, across), (above, above + 0.11 * unit))
        self.add("/robot/base", beam, colours.BASE)
        motors = map(self.motor, range(len(d.azimuth)))
        self.add("/robot/motors", shapes.joined(*motors), colours.MOTOR)

    def _add_effector(self) -> viser.MeshHandle:
        d = self.size
        effector = self.add("/robot/effector/plate", self._plate(), colours.EFFECTOR)
        wrists = [
            self.shaft(i).moved(radius * outward)
            for i, (radius, outward) in enumerate(zip(d.effector_radius, d.outward, strict=True))
        ]
        self.add("/robot/effector/wrists", shapes.joined(*wrists), colours.STEEL)
        if d.level_by is not None:
            self._add_links(d.level_by)
        return effector

    def _plate(self) -> Shape:
        unit = self.thickness
        beyond, across, half = 0.12 * unit, 0.14 * unit, 0.05 * unit
        left, right = self.size.effector_radius.tolist()
        return shapes.block((-left - beyond, right + beyond), (-across, across), (-half, half))

    def _add_tool(self) -> list[tuple[viser.MeshHandle, ...]]:
        """A stub below the plate, or a cone to the tool tip if that is further down."""
        x, _, z = self.size.tool_offset.tolist()
        unit = self.thickness
        low, top = min(-0.16 * unit, z), -0.05 * unit
        cone = shapes.lathe([(0.0, low), (0.03 * unit, low), (0.1 * unit, top), (0.0, top)])
        self.add("/robot/effector/tip", cone.moved((x, 0.0, 0.0)), colours.STEEL)
        return []

    def _add_links(self, side: Array) -> None:
        """Beside arm 0 and its forearm a rod each of the same length: two parallelograms, which
        share the side at the elbow."""
        unit, d = self.thickness, self.size
        along = rotations.about(1, -math.pi / 2)  # turns -z to +x
        arm = self.rod(float(d.upper_arm[0])).turned(along)
        self.add("/robot/link/rod", arm, colours.ROD)
        self.add("/robot/forearm0/link/rod", self.rod(float(d.forearm[0])), colours.ROD)
        bracket = _bracket(side, 0.11 * unit)
        self.add("/robot/forearm0/side", bracket, colours.STEEL)
        motor = d.base_radius[0] * d.outward[0]
        wrist = d.effector_radius[0] * d.outward[0]
        self.add("/robot/bracket", bracket.moved(motor), colours.MOTOR)
        self.add("/robot/effector/bracket", bracket.moved(wrist), colours.EFFECTOR)

    def _ghost_parts(self) -> dict[str, Shape]:
        return {"effector/plate": self._plate()}


def _bracket(side: Array, width: float) -> Shape:
    """A flat bar in the plane of x and z, from the origin to `side`, at its y."""
    x, y, z = side.tolist()
    length = math.hypot(x, z)
    bar = shapes.beam(length, (0.5 * width, width), (0.5 * width, width))
    pin = shapes.cylinder(0.6 * width, -0.35 * width, 0.35 * width).turned(SIDEWAYS)
    both = pin + pin.moved((length, 0.0, 0.0))
    return (bar + both).turned(rotations.about(1, math.atan2(-z, x))).moved((0.0, y, 0.0))
