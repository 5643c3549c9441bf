"""A boundary's mesh made finer where it strays from the boundary: at edges and sharp bends."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from deltaviz.mechanism.arrays import Array
from deltaviz.robots.workspace.boundary import Boundary, Faces
from deltaviz.robots.workspace.margins import Margins
from deltaviz.robots.workspace.project import Names, Walls, onto_boundary, onto_walls

MOST_ROUNDS = 12
MOST_GROWTH = 4  # times as many faces as at first: fins thinner than a cell would need without end
SHORTEST = 1 / 16  # of a cell, of an edge that may be cut
FARTHEST = 1.0  # that a middle may be moved, in its edge's length


@dataclass
class _Mesh:
    """`names` tells which margin's wall each bit of `walls` means, -1 for none yet."""

    vertices: Array
    walls: Walls
    faces: Faces
    names: Names

    def bits(self, codes: NDArray[np.uint8]) -> Walls:
        """The walls of single margins. With more than 64 in one mesh some share a bit, whose
        edges are then smoothed over."""
        for code in np.unique(codes):
            if code not in self.names:
                free = np.flatnonzero(self.names < 0)
                self.names[free[0] if len(free) else int(code) % 64] = code
        order = np.argsort(self.names)
        place = order[np.minimum(np.searchsorted(self.names[order], codes), 63)]
        return np.uint64(1) << place.astype(np.uint64)


def refine(margins: Margins, boundary: Boundary, tolerance: float) -> Boundary:
    """Edges are cut in two until their middles lie within `tolerance` mm of the boundary.

    The middle of an edge whose ends lie on different walls is moved to where those walls meet,
    so edges and corners of the workspace become edges and corners of the mesh. A closed mesh
    stays closed. The result's `deviation` is what was measured at the end, at the middles of
    edges and of faces.
    """
    mesh = _Mesh(boundary.vertices, np.empty(0, np.uint64), boundary.faces, np.full(64, -1))
    mesh.walls = mesh.bits(boundary.limits)
    shortest = max(tolerance, SHORTEST * boundary.cell)
    fresh = np.ones(len(mesh.faces), dtype=bool)
    most = MOST_GROWTH * len(boundary.faces)
    for _ in range(MOST_ROUNDS):
        cut = _edges_to_cut(margins, mesh, mesh.faces[fresh], tolerance, shortest)
        if not len(cut.edges) or len(mesh.faces) + 2 * len(cut.edges) > most:
            break
        fresh = _cut(mesh, cut)
    _, limits = margins.nearest(mesh.vertices)
    found = replace(boundary, vertices=mesh.vertices, faces=mesh.faces, limits=limits)
    return replace(found, deviation=deviation(margins, found))


def deviation(margins: Margins, boundary: Boundary) -> float:
    """The farthest that a middle of an edge or a face lies from the boundary, mm.

    Outside, by the least margin, a distance; inside likewise.
    """
    if not len(boundary.faces):
        return 0.0
    corners = boundary.vertices[boundary.faces]
    middles = [corners.mean(axis=1)]
    if boundary.dimensions == 3:
        middles += [(corners[:, i] + corners[:, (i + 1) % 3]) / 2 for i in range(3)]
    return float(np.abs(margins.least(np.concatenate(middles))).max())


@dataclass(frozen=True)
class _Cut:
    """Edges (k, 2), lower vertex first, and the points that take the place of their middles."""

    edges: Faces
    points: Array
    walls: Walls


def _edges_to_cut(
    margins: Margins, mesh: _Mesh, faces: Faces, tolerance: float, shortest: float
) -> _Cut:
    edges, of_faces = _edges(faces)
    ends = mesh.vertices[edges]
    length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=-1)
    middle = ends.mean(axis=1)
    point, walls, good = _placed(margins, mesh, middle, mesh.walls[edges], length)
    off = np.maximum(np.linalg.norm(point - middle, axis=-1), np.abs(margins.least(middle)))
    far = good & (off > tolerance)
    # A face whose own middle alone is far: by its longest edge.
    lone = np.flatnonzero(~far[of_faces].any(axis=1))
    centre = mesh.vertices[faces[lone]].mean(axis=1)
    lone = lone[np.abs(margins.least(centre)) > tolerance]
    longest = length[of_faces[lone]].argmax(axis=1)
    far[of_faces[lone, longest]] = True
    far &= good & (length > shortest)
    return _Cut(edges[far], point[far], walls[far])


def _placed(
    margins: Margins, mesh: _Mesh, middle: Array, walls: Walls, length: Array
) -> tuple[Array, Walls, NDArray[np.bool_]]:
    """Where the middles of edges belong on the boundary, on which walls that is, and whether
    such a place was found."""
    shared = walls[:, 0] & walls[:, 1]
    target = np.where(shared != 0, shared, walls[:, 0] | walls[:, 1])
    point, good = onto_walls(margins, middle, target, mesh.names, FARTHEST * length)
    good &= margins.least(point) > -1e-4
    rest = np.flatnonzero(~good)
    if len(rest):
        point[rest], good[rest] = onto_boundary(margins, middle[rest], FARTHEST * length[rest])
        _, code = margins.nearest(point[rest])
        target[rest] = mesh.bits(code)
    return point, target, good


def _edges(faces: Faces) -> tuple[Faces, NDArray[np.intp]]:
    """The edges of faces, each once, lower vertex first; and (m, e) which are each face's."""
    size = faces.shape[1]
    pairs = [(i, (i + 1) % size) for i in range(size if size > 2 else 1)]
    ends = np.sort(np.concatenate([faces[:, pair] for pair in pairs]), axis=1)
    base = int(ends.max(initial=0)) + 1
    keys, inverse = np.unique(ends[:, 0] * base + ends[:, 1], return_inverse=True)
    return np.stack((keys // base, keys % base), axis=-1), inverse.reshape(len(pairs), -1).T


def _cut(mesh: _Mesh, cut: _Cut) -> NDArray[np.bool_]:
    """Puts in the new vertices, and the faces around them anew; which faces are new."""
    start, size = len(mesh.vertices), mesh.faces.shape[1]
    base = start + len(cut.edges)
    keys = (cut.edges[:, 0] * base + cut.edges[:, 1]).astype(np.int64)
    mesh.vertices = np.concatenate((mesh.vertices, cut.points))
    mesh.walls = np.concatenate((mesh.walls, cut.walls))
    middles = [
        _new_vertex(mesh.faces[:, (i, (i + 1) % size)], keys, base, start)
        for i in range(size if size > 2 else 1)
    ]
    touched = np.any([m >= 0 for m in middles], axis=0)
    made = _halves(mesh.faces, middles[0]) if size == 2 else _parts(mesh, middles)
    mesh.faces = np.concatenate((mesh.faces[~touched], *made))
    fresh = np.ones(len(mesh.faces), dtype=bool)
    fresh[: (~touched).sum()] = False
    return fresh


def _new_vertex(edges: Faces, keys: NDArray[np.int64], base: int, start: int) -> NDArray[np.int64]:
    """The vertex put into each edge, -1 where none was. `keys` are sorted."""
    wanted = edges.min(axis=1) * base + edges.max(axis=1)
    place = np.minimum(np.searchsorted(keys, wanted), len(keys) - 1)
    return np.where(keys[place] == wanted, start + place, -1)


def _halves(faces: Faces, middle: NDArray[np.int64]) -> list[Faces]:
    both, new = faces[middle >= 0], middle[middle >= 0]
    return [np.stack((both[:, 0], new), axis=-1), np.stack((new, both[:, 1]), axis=-1)]


def _parts(mesh: _Mesh, middles: list[NDArray[np.int64]]) -> list[Faces]:
    """Triangles with one, two or three edges cut, as two, three or four triangles."""
    out: list[Faces] = []
    has = np.stack([m >= 0 for m in middles], axis=-1)
    corner, middle = mesh.faces, np.stack(middles, axis=-1)
    for i in range(3):  # turned so that corner `a` opens the first edge of interest
        a, b, c = i, (i + 1) % 3, (i + 2) % 3
        one = has[:, a] & ~has[:, b] & ~has[:, c]
        f, m = corner[one], middle[one]
        out += [_triangles(f[:, a], m[:, a], f[:, c]), _triangles(m[:, a], f[:, b], f[:, c])]
        two = has[:, a] & has[:, b] & ~has[:, c]
        f, m = corner[two], middle[two]
        out.append(_triangles(m[:, a], f[:, b], m[:, b]))
        out += _quadrilateral(mesh, f[:, a], m[:, a], m[:, b], f[:, c])
    all_three = has.all(axis=1)
    f, m = corner[all_three], middle[all_three]
    out += [_triangles(f[:, i], m[:, i], m[:, (i + 2) % 3]) for i in range(3)]
    out.append(m)
    return out


def _quadrilateral(
    mesh: _Mesh,
    a: NDArray[np.int64],
    b: NDArray[np.int64],
    c: NDArray[np.int64],
    d: NDArray[np.int64],
) -> list[Faces]:
    """Two triangles, along the shorter diagonal."""
    v = mesh.vertices
    short = np.linalg.norm(v[a] - v[c], axis=-1) <= np.linalg.norm(v[b] - v[d], axis=-1)
    long = ~short
    return [
        _triangles(a[short], b[short], c[short]),
        _triangles(a[short], c[short], d[short]),
        _triangles(a[long], b[long], d[long]),
        _triangles(b[long], c[long], d[long]),
    ]


def _triangles(a: NDArray[np.int64], b: NDArray[np.int64], c: NDArray[np.int64]) -> Faces:
    return np.stack((a, b, c), axis=-1)
