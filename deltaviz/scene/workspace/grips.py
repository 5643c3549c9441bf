"""The grips of the sections: a frame around each with an arrow at its corners, by which it is
dragged along its axis in one browser.

The plane within the frame lets the pointer through, to the effector and to the camera.
"""

from __future__ import annotations

from collections.abc import Callable, Coroutine
from dataclasses import dataclass

import numpy as np
import viser
from viser import SceneNodeDragEvent

from deltaviz.scene import colours, inner, shapes
from deltaviz.scene.drag import eye_of
from deltaviz.scene.pointer import along
from deltaviz.scene.shapes import Shape
from deltaviz.scene.units import Array, metres, millimetres
from deltaviz.scene.workspace.pictures import Section

GRIPS = tuple(f"/reach/grip_{axis}" for axis in "xyz")

_BAR = 0.003  # of the frame's longer side, half a bar's thickness
_ARROW = 0.055  # half an arrow's length
_STEM, _HEAD = 0.009, 0.022  # radii


@dataclass(frozen=True)
class _Slide:
    """What a drag keeps: the place that was grabbed (m), and the section's level then (mm)."""

    grabbed: Array
    level: float


class Grips:
    """Runs in viser's event loop only. `moved(axis, level)` is told where a section was dragged
    to, in mm; it answers with `place`."""

    def __init__(self, scene: viser.SceneApi, moved: Callable[[int, float], None]) -> None:
        self._scene = scene
        self._moved = moved
        self._nodes: dict[int, viser.MeshHandle] = {}
        self._levels: dict[int, float] = {}
        self._slides: dict[int, _Slide] = {}

    def show(self, section: Section, level: float) -> None:
        """Around a section that is at `level` by now, unless its grip is there already."""
        axis = section.axis
        if axis not in self._nodes:
            shape = grip(section)
            node = self._scene.add_mesh_simple(
                GRIPS[axis],
                shape.vertices,
                shape.faces,
                color=colours.EFFECTOR,  # as all that can be dragged,
                cast_shadow=False,
                receive_shadow=False,
            )
            node.on_drag("left")(self._dragging(axis))
            self._nodes[axis] = node
        self.place(axis, level)

    def place(self, axis: int, level: float) -> None:
        self._levels[axis] = level
        if axis in self._nodes:
            x, y, z = metres(level * np.eye(3)[axis]).tolist()
            inner.place(self._nodes[axis], (x, y, z))

    def drop(self, *axes: int) -> None:
        for axis in axes:
            self._slides.pop(axis, None)
            node = self._nodes.pop(axis, None)
            if node is not None:
                node.remove()

    def _dragging(
        self, axis: int
    ) -> Callable[[SceneNodeDragEvent[viser.MeshHandle]], Coroutine[None, None, None]]:
        direction = np.eye(3)[axis]

        async def drag(event: SceneNodeDragEvent[viser.MeshHandle]) -> None:
            if event.phase == "start" and axis in self._nodes:
                grabbed = np.asarray(event.start_position, dtype=np.float64)
                self._slides[axis] = _Slide(grabbed, self._levels[axis])
            slide = self._slides.get(axis)
            if slide is None:
                return
            way = along(eye_of(event.client.camera), event.end_screen_pos, slide.grabbed, direction)
            if way is not None and event.phase != "start":
                self._moved(axis, slide.level + float(millimetres(way)))
            if event.phase == "end":
                self._slides.pop(axis, None)

        return drag


def grip(section: Section) -> Shape:
    """The frame around a section and its arrows, at level 0."""
    axis = section.axis
    first, second = (i for i in range(3) if i != axis)
    low, high = section.low.copy(), section.high.copy()
    low[axis] = high[axis] = 0.0
    size = float((high - low).max())
    parts: list[Shape] = []
    for along_it, across in ((first, second), (second, first)):
        for end in (low, high):
            start, stop = low.copy(), high.copy()
            start[across] = stop[across] = end[across]
            start[along_it] -= _BAR * size
            stop[along_it] += _BAR * size
            parts.append(_bar(start, stop, along_it, _BAR * size))
    arrow = _arrow(axis, size)
    for x in (low[first], high[first]):
        for y in (low[second], high[second]):
            corner = np.zeros(3)
            corner[first], corner[second] = x, y
            parts.append(arrow.moved(corner))
    return shapes.joined(*parts)


def _bar(start: Array, stop: Array, along_it: int, half: float) -> Shape:
    thick = np.where(np.arange(3) == along_it, 0.0, half)
    (x0, y0, z0), (x1, y1, z1) = (start - thick).tolist(), (stop + thick).tolist()
    return shapes.block((x0, x1), (y0, y1), (z0, z1))


def _arrow(axis: int, size: float) -> Shape:
    """Both ways along an axis."""
    tip, neck = _ARROW * size, 0.45 * _ARROW * size
    stem, head = _STEM * size, _HEAD * size
    profile = [(0.0, -tip), (head, -neck), (stem, -neck), (stem, neck), (head, neck), (0.0, tip)]
    upright = shapes.lathe(profile, segments=shapes.THIN_SEGMENTS)
    order = [(axis + 1) % 3, (axis + 2) % 3, axis]  # cyclic, so that faces stay turned outward
    turned = np.empty_like(upright.vertices)
    turned[:, order] = upright.vertices
    return Shape(turned, upright.faces)
