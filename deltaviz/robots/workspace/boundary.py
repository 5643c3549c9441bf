"""The boundary of a workspace as a closed mesh: triangles, or line segments in a plane."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deltaviz.mechanism.arrays import Array
from deltaviz.mechanism.margin import Margin
from deltaviz.robots.workspace.crossing import crossing
from deltaviz.robots.workspace.field import Field
from deltaviz.robots.workspace.margins import Margins
from deltaviz.robots.workspace.project import onto_boundary

Faces = NDArray[np.int64]


@dataclass(frozen=True)
class Boundary:
    """`vertices` (n, d) mm lie on the boundary; `faces` (m, d) index them, turned outward.

    `limits` tells for each vertex what ends the workspace there, as an index into `names`.
    `deviation` is the farthest that the middles of edges and faces were found from the boundary,
    mm. Parts of the workspace that are thinner than `cell` may be missing.
    """

    vertices: Array
    faces: Faces
    limits: NDArray[np.uint8]
    names: tuple[Margin, ...]
    cell: float
    deviation: float

    @property
    def dimensions(self) -> int:
        return self.vertices.shape[-1]

    @property
    def volume(self) -> float:
        """mm³; mm² in a plane. By the divergence theorem, about a vertex."""
        if not len(self.faces):
            return 0.0
        corners = self.vertices[self.faces] - self.vertices[self.faces[0, 0]]
        return float(np.linalg.det(corners).sum()) / (6.0 if self.dimensions == 3 else 2.0)

    @property
    def closed(self) -> bool:
        """Whether every edge has a face on either side (every vertex a segment, in a plane)."""
        d = self.dimensions
        ahead = np.concatenate([np.delete(self.faces, i, axis=1) for i in range(d)])
        _, counts = np.unique(np.sort(ahead, axis=1), axis=0, return_counts=True)
        return bool((counts % 2 == 0).all())


def march(margins: Margins, field: Field) -> Boundary:
    """Marching cubes (squares in a plane), with every vertex then moved along its grid line to
    where the margin is 0. Some 100 ns a node; `deviation` is not measured (NaN)."""
    index, faces = level_set(field.value)
    vertices = _exact(margins, field, index) if len(index) else np.empty((0, len(field.grid.shape)))
    _, code = margins.nearest(vertices)
    return Boundary(vertices, faces, code, margins.names, field.grid.cell, float("nan"))


def level_set(value: Array | NDArray[np.float32]) -> tuple[Array, Faces]:
    """Where a value on the nodes of a grid goes through 0: vertices in grid steps, and faces."""
    dimensions = value.ndim
    if value.min() >= 0 or value.max() < 0:
        return np.empty((0, dimensions)), np.empty((0, dimensions), np.int64)
    if dimensions == 3:
        from skimage.measure import marching_cubes

        index, faces, _, _ = marching_cubes(value, 0.0, gradient_direction="ascent")
        return index.astype(np.float64), faces.astype(np.int64)
    from skimage.measure import find_contours

    loops = find_contours(value, 0.0, fully_connected="high")
    start, index, faces = 0, [], []
    for loop in loops:
        closed = bool((loop[0] == loop[-1]).all())  # else it ends at the grid's edge
        ring = start + np.arange(len(loop) - closed)
        segments = np.stack((np.roll(ring, -1), ring), axis=-1)
        index.append(loop[: len(ring)])
        faces.append(segments if closed else segments[:-1])
        start += len(ring)
    return np.concatenate(index), np.concatenate(faces)


def _exact(margins: Margins, field: Field, index: Array) -> Array:
    """The vertices in mm, each between the two nodes that it was found between."""
    grid = field.grid
    whole = np.rint(index)
    along = np.abs(index - whole).argmax(axis=1)
    rows = np.arange(len(index))
    first, second = whole.astype(np.intp), whole.astype(np.intp)
    first[rows, along] = np.floor(index[rows, along]).astype(np.intp)
    second[rows, along] = first[rows, along] + 1
    np.minimum(second, np.array(grid.shape) - 1, out=second)
    inner = field.value[tuple(first.T)] >= 0
    outer = field.value[tuple(second.T)] < 0
    swap = (~inner & ~outer)[:, None]
    inside, outside = np.where(swap, second, first), np.where(swap, first, second)
    found = crossing(margins, grid.low + grid.cell * inside, grid.low + grid.cell * outside)
    lone = np.flatnonzero(inner != outer)  # a vertex inside a cell, which few have
    if len(lone):
        start = grid.low + grid.cell * index[lone]
        found[lone], _ = onto_boundary(margins, start, np.full(len(lone), grid.cell))
    return found
