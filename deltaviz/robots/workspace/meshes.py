"""Meshes of triangles (m, 3) in space or line segments (m, 2) in a plane: cut, finer, measured."""

from __future__ import annotations

from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from deltaviz.mechanism.arrays import Array
from deltaviz.robots.workspace.boundary import Faces

_NEIGHBOURS = 24  # faces whose middles are nearest to a point: the nearest is one of them
_FLAT = 1e-12  # squared share of width to length below which a triangle is but its sides


def clipped(vertices: Array, faces: Faces, value: Array) -> tuple[Array, Faces]:
    """The part where `value` (n,), linear over each face, is at least 0."""
    inside = value[faces] >= 0
    d = faces.shape[1]
    points, kept = [vertices], [faces[inside.all(axis=1)]]
    count = len(vertices)
    for number in range(1, d):
        some = inside.sum(axis=1) == number
        odd, *others = _odd_first(faces[some], inside[some] == (number == 1)).T
        cuts = [_between(vertices, value, odd, other) for other in others]
        ring = [count + k * len(odd) + np.arange(len(odd)) for k in range(len(cuts))]
        points, count = points + cuts, count + len(cuts) * len(odd)
        if number == 1:
            kept.append(np.stack((odd, *ring), axis=-1))
        else:
            (b, c), (ab, ac) = others, ring
            kept += [np.stack((ab, b, c), axis=-1), np.stack((ab, c, ac), axis=-1)]
    return _used(np.concatenate(points), np.concatenate(kept))


def halved(vertices: Array, faces: Faces) -> tuple[Array, Faces]:
    """Each triangle cut into four, or segment into two, at the middles of its edges."""
    pairs = list(combinations(range(faces.shape[1]), 2))
    sides = np.sort(faces[:, pairs], axis=-1).reshape(-1, 2)
    edges, index = np.unique(sides, axis=0, return_inverse=True)
    middles = (len(vertices) + index.reshape(-1, len(pairs))).T
    if len(pairs) == 1:
        (a, b), (ab,) = faces.T, middles
        cut = ((a, ab), (ab, b))
    else:
        (a, b, c), (ab, ac, bc) = faces.T, middles
        cut = ((a, ab, ac), (ab, b, bc), (ac, bc, c), (ab, bc, ac))
    points = np.concatenate((vertices, vertices[edges].mean(axis=1)))
    return _used(points, np.concatenate([np.stack(face, axis=-1) for face in cut]))


def _used(vertices: Array, faces: Faces) -> tuple[Array, Faces]:
    """Without the vertices that no face is of."""
    used, index = np.unique(faces, return_inverse=True)
    return vertices[used], index.reshape(faces.shape)


def _odd_first(faces: Faces, odd: NDArray[np.bool_]) -> Faces:
    """Each face turned so that its one odd corner stands first."""
    d = faces.shape[1]
    order = (odd.argmax(axis=1)[:, None] + np.arange(d)) % d
    return np.take_along_axis(faces, order, axis=1)


def _between(vertices: Array, value: Array, one: Faces, other: Faces) -> Array:
    share = value[one] / (value[one] - value[other])
    return vertices[one] + share[:, None] * (vertices[other] - vertices[one])


def distance(points: Array, vertices: Array, faces: Faces) -> Array:
    """(n, d) to (n,), of triangles in space or line segments in a plane, which are about equally
    large."""
    from scipy.spatial import KDTree

    corners = vertices[faces]
    nearby = min(_NEIGHBOURS, len(faces))
    _, which = KDTree(corners.mean(axis=1)).query(points, k=nearby)
    around = corners[which.reshape(len(points), nearby)]
    sides = [
        _to_segment(points[:, None], around[..., i, :], around[..., j, :])
        for i, j in combinations(range(faces.shape[1]), 2)
    ]
    least = np.min(sides, axis=0)
    if faces.shape[1] == 3:
        least = np.minimum(least, _to_inside(points[:, None], around))
    return least.min(axis=1)


def _to_segment(points: Array, start: Array, end: Array) -> Array:
    way = end - start
    square = np.maximum((way * way).sum(axis=-1), 1e-30)
    share = np.clip(((points - start) * way).sum(axis=-1) / square, 0.0, 1.0)
    return np.linalg.norm(points - start - share[..., None] * way, axis=-1)


def _to_inside(points: Array, corners: Array) -> Array:
    """From the plane of each triangle; infinite where the foot lies outside of it."""
    a, b, c = np.moveaxis(corners, -2, 0)
    normal = np.cross(b - a, c - a)
    square = (normal * normal).sum(axis=-1)
    longest = np.maximum(((b - a) ** 2).sum(axis=-1), ((c - a) ** 2).sum(axis=-1))
    within = square > _FLAT * longest**2
    for start, end in ((a, b), (b, c), (c, a)):
        within &= (np.cross(end - start, points - start) * normal).sum(axis=-1) >= 0
    height = np.abs(((points - a) * normal).sum(axis=-1)) / np.sqrt(np.maximum(square, 1e-30))
    return np.where(within, height, np.inf)
