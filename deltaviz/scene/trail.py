"""Where the tool tip has been: a fixed number of segments that thin out and fade."""

from __future__ import annotations

from collections import deque

import numpy as np
import viser

from deltaviz.scene import colours, rotations, shapes
from deltaviz.scene.units import Array, metres

SEGMENTS = 72
_SPACING = 3.0  # mm between the points kept
_LIFE = 5.0  # s until a point is forgotten


class TrailPoints:
    """The points of the trail, newest first; pure."""

    def __init__(self) -> None:
        self._points: deque[tuple[float, Array]] = deque(maxlen=SEGMENTS)
        self._tip: Array | None = None

    def pass_through(self, xyz: tuple[float, ...], now: float) -> bool:
        """The tool tip is at xyz (mm) at the time `now` (s); whether the trail changed."""
        tip = np.asarray(xyz, dtype=np.float64)
        changed = self._tip is None or not np.array_equal(tip, self._tip)
        self._tip = tip
        if not self._points or np.linalg.norm(self._points[0][1] - tip) >= _SPACING:
            self._points.appendleft((now, tip))
        while len(self._points) > 1 and now - self._points[-1][0] > _LIFE:
            self._points.pop()
            changed = True
        return changed

    def clear(self) -> None:
        self._points.clear()
        self._tip = None

    def segments(self) -> Array:
        """(SEGMENTS, 2, 3) mm from newer to older; those unused have no length."""
        out = np.zeros((SEGMENTS, 2, 3))
        if self._tip is not None:
            line = np.array([self._tip, *(point for _, point in self._points)])
            out[:] = line[-1]
            count = len(line) - 1
            out[:count, 0], out[:count, 1] = line[:-1], line[1:]
        return out


class Trail:
    """The nodes of the trail, below `/trail`."""

    def __init__(self, scene: viser.SceneApi) -> None:
        self._points = TrailPoints()
        self._radius = 0.001
        shares = 1.0 - np.arange(SEGMENTS) / SEGMENTS
        self._widths = 0.35 + 0.65 * shares
        piece = shapes.lathe([(1.0, 0.0), (1.0, -1.0)], segments=10)
        self._node = scene.add_batched_meshes_simple(
            "/trail/segments",
            piece.vertices,
            piece.faces,
            batched_wxyzs=np.tile((1.0, 0.0, 0.0, 0.0), (SEGMENTS, 1)),
            batched_positions=np.zeros((SEGMENTS, 3)),
            batched_scales=np.zeros((SEGMENTS, 3)),
            batched_colors=colours.TRAIL,
            batched_opacities=(0.75 * shares**1.5).astype(np.float32),
            lod="off",
            cast_shadow=False,
            receive_shadow=False,
        )

    def start(self, radius: float) -> None:
        """Begin anew, with segments of this radius in metres."""
        self._points.clear()
        self._radius = radius
        self._draw()

    def pass_through(self, xyz: tuple[float, ...], now: float) -> None:
        if self._points.pass_through(xyz, now):
            self._draw()

    def _draw(self) -> None:
        newer, older = np.moveaxis(metres(self._points.segments()), 1, 0)
        direction = older - newer
        length = np.linalg.norm(direction, axis=-1)
        radii = np.where(length > 0.0, self._radius * self._widths, 0.0)
        self._node.batched_positions = newer.astype(np.float32)
        self._node.batched_wxyzs = rotations.from_down(direction).astype(np.float32)
        self._node.batched_scales = np.stack((radii, radii, length), -1).astype(np.float32)
