"""Goals for targets that cannot be reached: the nearest legal place, and steps along the edge.

Everything here works in either space, on margins that are >= 0 where legal. A goal keeps a small
reserve, so that motion along the edge has room to brake; where the robot already stands closer
to a limit than that, it may stay as close as it is.
"""

from __future__ import annotations

import numpy as np

from deltaviz.motion.boundary_compiled import first_illegal, legal, nearest_step
from deltaviz.motion.followed import Array
from deltaviz.motion.space import Space

RESERVE = 0.25  # units of margin, about mm
SHARES = np.linspace(0.0, 1.0, 49)[1:, None]  # samples of a line
PROBE = 1e-3  # mm; step of the margins' differences
NEAR = 60.0  # margins above this do not matter to one step
STEP = 15.0  # mm; how long a step along the boundary is at most
SHORTER = (1.0, 0.25, 0.05)  # shares of a step that are tried
RESTORATIONS = 3  # steps back onto the legal side
OVERSHOOT = 0.01  # units of margin beyond the floor, so that one step back suffices


class Boundary:
    """The edge of the legal region of one space."""

    def __init__(self, space: Space) -> None:
        self._space = space
        self._probes = np.concatenate(
            (np.zeros((1, space.axes)), np.eye(space.axes), -np.eye(space.axes))
        ) * (PROBE * space.unit)

    def floor(self, q: Array, reserve: float = RESERVE) -> Array:
        """The margins (m,) that a goal may come down to, for a robot that stands at q."""
        return np.minimum(reserve, self._space.margins(q[None, :])[0])

    def is_legal(self, q: Array) -> bool:
        """Whether every margin at q is >= 0, rounding aside."""
        return bool(self._space.margins(q[None, :]).min() >= -1e-9)

    def clear(self, start: Array, end: Array, floor: Array) -> bool:
        """Whether the line keeps above the floor, sampled; violated margins must not get worse."""
        margins = self._space.margins(_line(start, end))
        return first_illegal(margins, np.minimum(floor, 0.0)) < 0

    def last_legal(self, start: Array, end: Array, floor: Array) -> Array:
        """The furthest place on the line from `start` that is above the floor all the way."""
        near, far = start, end
        for _ in range(2):
            points = _line(near, far)
            margins = self._space.margins(points)
            bad = first_illegal(margins, floor)
            if bad < 0:
                return far
            near, far = points[bad - 1] if bad else near, points[bad]
        return near

    def step(self, at: Array, target: Array, floor: Array, longest: float = STEP) -> Array:
        """One step along the boundary from a legal place, to where the target is nearer.

        The linearised step leaves a curved boundary: it is brought back along the slopes.
        """
        unit = self._space.unit
        towards = (target - at) / unit
        before = float(np.linalg.norm(towards))
        if before > longest:
            towards *= longest / before
        margins, slopes = self._slopes(at)
        move = nearest_step(margins, slopes, towards, floor, NEAR)
        for share in SHORTER:
            place = self._restored(at + move * (share * unit), floor)
            if place is not None and float(np.linalg.norm(target - place)) < before * unit:
                return place
        return at

    def _slopes(self, at: Array) -> tuple[Array, Array]:
        """Margins (m,) and their slopes per mm (d, m)."""
        margins = self._space.margins(at + self._probes)
        half = self._space.axes
        return margins[0], (margins[1 : half + 1] - margins[half + 1 :]) / (2 * PROBE)

    def _restored(self, place: Array, floor: Array) -> Array | None:
        still = np.zeros(self._space.axes)
        for _ in range(RESTORATIONS):
            margins, slopes = self._slopes(place)
            if legal(margins[None, :], floor) == 0:
                return place
            if not np.all(np.isfinite(slopes)):
                return None
            back = nearest_step(margins, slopes, still, floor + OVERSHOOT, NEAR)
            place = place + back * self._space.unit
        return place if legal(self._space.margins(place[None, :]), floor) == 0 else None

    def nearest(self, at: Array, target: Array, floor: Array, steps: int) -> Array:
        """Steps from `at` until they stop shortening the distance, `steps` at most."""
        best = float(np.linalg.norm(target - at))
        for _ in range(steps):
            on = self.step(at, target, floor)
            distance = float(np.linalg.norm(target - on))
            if distance > best - 1e-4 * self._space.unit:
                break
            at, best = on, distance
        return at


def _line(start: Array, end: Array) -> Array:
    return start + (end - start) * SHARES
