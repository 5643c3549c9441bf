"""What there is to compute of a workspace, each a value that can be sent and a pure function.

Runs in the computing processes; takes from some milliseconds (`Coarse`, `Cut`) to seconds.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from deltaviz.robots import Robot
from deltaviz.robots.workspace import Boundary, Limit, Margins, levels, quality
from deltaviz.robots.workspace.cells import Box, hull
from deltaviz.robots.workspace.empty import why_empty
from deltaviz.robots.workspace.field import Grid, sample
from deltaviz.robots.workspace.levels import rough
from deltaviz.scene.units import Array, metres, millimetres
from deltaviz.scene.workspace.measures import PLAIN, PLAIN_COLOUR, Measure, coloured, measure_named
from deltaviz.scene.workspace.pictures import Fitted, NoSection, Picture, Section, Skin

PIXELS = 200  # along a section's longest side
DRAFT = 80  # the same while it is moved
SAMPLED = 24  # nodes along the longest side that the ends of a colour scale are found from
ENDS = 2.0, 98.0  # percentiles between which colours are told apart
FINENESS = 400  # of the longest side, a fine boundary's tolerance


class Task(Protocol):
    def pictures(self) -> Iterator[Picture]:
        """Each better than the one before, and taking its place."""
        ...


@dataclass(frozen=True)
class Coarse:
    """The boundary at once."""

    robot: Robot
    measure: str = PLAIN

    def pictures(self) -> Iterator[Picture]:
        first = next(levels(self.robot))
        yield _skin(self.robot, first, self.measure, coarse=True)


@dataclass(frozen=True)
class Rough:
    """The boundary at a moving hand's pace."""

    robot: Robot

    def pictures(self) -> Iterator[Picture]:
        yield _skin(self.robot, rough(self.robot), PLAIN, coarse=True)


@dataclass(frozen=True)
class Fine:
    """The boundary within a tolerance, in two steps."""

    robot: Robot
    measure: str = PLAIN

    def pictures(self) -> Iterator[Picture]:
        box = _hull(self.robot)
        tolerance = 1.0 if box is None else max(0.5, float(box.size.max()) / FINENESS)
        for number, boundary in enumerate(levels(self.robot, tolerance=tolerance)):
            if number or box is None:
                yield _skin(self.robot, boundary, self.measure, coarse=False)


@dataclass(frozen=True)
class Coloured:
    """A boundary that is there already, coloured by another measure."""

    robot: Robot
    skin: Skin
    measure: str

    def pictures(self) -> Iterator[Picture]:
        yield in_colours(self.robot, self.skin, self.measure)


@dataclass(frozen=True)
class Cut:
    """A plane across axis 0, 1 or 2 (x, y, z) at `level` mm, coloured by a measure's name, on a
    `scale` from elsewhere or else its own; a picture for each number of `pixels` along its longest
    side."""

    robot: Robot
    axis: int
    level: float
    measure: str
    pixels: tuple[int, ...] = (PIXELS,)
    scale: tuple[float, float] | None = None

    def pictures(self) -> Iterator[Picture]:
        box = _hull(self.robot)
        if box is None:
            yield NoSection(self.axis)
        else:
            yield from (self._drawn(box, pixels) for pixels in self.pixels)

    def _drawn(self, box: Box, pixels: int) -> Section:
        low, high = _in_space(box.low), _in_space(box.high)
        across = [i for i in range(3) if i != self.axis]
        step = float((high - low)[across].max()) / pixels
        sides = [np.arange(low[i] - step, high[i] + 2 * step, step) for i in across]
        rows, columns = np.meshgrid(sides[1], sides[0], indexing="ij")
        points = np.empty((*rows.shape, 3))
        points[..., self.axis] = self.level
        points[..., across[0]], points[..., across[1]] = columns, rows
        own = points if len(box.low) == 3 else points[..., [0, 2]]
        margin = _margins(self.robot).least(own)
        image, scale = self._painted(own, margin, step)
        corners = points[0, 0].copy(), points[-1, -1].copy()
        for i in across:  # a pixel is as wide as the way between two points
            corners[0][i] -= step / 2
            corners[1][i] += step / 2
        return Section(
            axis=self.axis,
            level=self.level,
            image=image,
            low=metres(corners[0]),
            high=metres(corners[1]),
            span=(float(low[self.axis]), float(high[self.axis])),
            scale=scale,
        )

    def _painted(
        self, points: Array, margin: Array, step: float
    ) -> tuple[NDArray[np.uint8], tuple[float, float] | None]:
        """RGBA, whose edge fades over a pixel; and the ends of the scale."""
        image = np.zeros((*margin.shape, 4), np.uint8)
        image[..., 3] = np.clip(255 * (0.5 + margin / step), 0, 255)
        measure = measure_named(self.measure)
        if measure is None:
            image[..., :3] = PLAIN_COLOUR
            return image, None
        scale = self.scale or _scale(self.robot, measure.field)
        seen = image[..., 3] > 0  # elsewhere the arms may not reach
        image[seen, :3] = coloured(_shares(self.robot, points[seen], measure, scale))
        return image, scale


@dataclass(frozen=True)
class Fit:
    """The largest cylinder, or in a plane the largest rectangle."""

    robot: Robot

    def pictures(self) -> Iterator[Picture]:
        workspace = self.robot.workspace()
        planar = len(self.robot.axes) == 2
        found = workspace.largest_box() if planar else workspace.largest_cylinder()
        yield Fitted(None if found is None else found.shape)


@lru_cache(maxsize=4)
def _margins(robot: Robot) -> Margins:
    return Margins.of(robot, Limit.MACHINE)


@lru_cache(maxsize=4)
def _hull(robot: Robot) -> Box | None:
    return hull(_margins(robot))


@lru_cache(maxsize=64)
def _scale(robot: Robot, field: str) -> tuple[float, float]:
    """The ends of a measure's colours: the same for every section of a robot."""
    box = _hull(robot)
    assert box is not None
    nodes = sample(_margins(robot), Grid.around(box, float(box.size.max()) / SAMPLED))
    inside = nodes.grid.low + nodes.grid.cell * np.argwhere(nodes.value >= 0)
    values = getattr(quality(robot, inside), field)
    values = values[np.isfinite(values)]
    if not len(values):
        return 0.0, 1.0
    low, high = np.percentile(values, ENDS).tolist()
    return low, max(high, low + 1e-9)


def _shares(robot: Robot, points: Array, measure: Measure, scale: tuple[float, float]) -> Array:
    """The places of points (n, d) on a measure's scale, (n,) from 0 to 1."""
    low, high = scale
    values = np.nan_to_num(getattr(quality(robot, points), measure.field), nan=low)
    return np.clip((values - low) / (high - low), 0.0, 1.0)


def _skin(robot: Robot, boundary: Boundary, name: str, *, coarse: bool) -> Skin:
    vertices = _in_space(boundary.vertices)
    faces, edges = boundary.faces, np.empty((0, 2, 3))
    if boundary.dimensions == 2:
        edges = vertices[faces]
        faces = _filled(robot, boundary.vertices) if len(faces) else np.empty((0, 3), int)
    reason = None
    if not len(faces):
        reason = why_empty(robot, Limit.MACHINE) or "Nothing within reach was found."
    skin = Skin(
        vertices=metres(vertices).astype(np.float32),
        faces=faces.astype(np.uint32),
        edges=metres(edges).astype(np.float32),
        size=abs(boundary.volume),
        deviation=None if coarse else boundary.deviation,
        reason=reason,
    )
    return in_colours(robot, skin, name)


def in_colours(robot: Robot, skin: Skin, name: str) -> Skin:
    """The boundary as a measure colours it; in a plane sections show measures, no boundary."""
    measure = measure_named(name)
    if measure is None or not len(skin.faces) or len(skin.edges):
        return replace(skin, measure=name, share=None, scale=None)
    scale = _scale(robot, measure.field)
    share = _shares(robot, millimetres(skin.vertices), measure, scale)
    return replace(skin, measure=name, share=share.astype(np.float32), scale=scale)


def _filled(robot: Robot, outline: Array) -> NDArray[np.int32]:
    """Triangles between an outline's points (n, 2), those whose middles lie within."""
    from scipy.spatial import Delaunay

    triangles = Delaunay(outline).simplices
    middles = outline[triangles].mean(axis=1)
    return triangles[_margins(robot).least(middles) >= 0]


def _in_space(points: Array) -> Array:
    """(..., 2) or (..., 3) to (..., 3)."""
    if points.shape[-1] == 3:
        return points
    return np.stack((points[..., 0], 0.0 * points[..., 0], points[..., 1]), axis=-1)
