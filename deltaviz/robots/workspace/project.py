"""Points moved onto the boundary of a workspace: onto its walls, edges and corners."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from deltaviz.mechanism.arrays import Array
from deltaviz.robots.workspace.crossing import crossing
from deltaviz.robots.workspace.margins import Margins

STEP = 1e-4  # mm, of the differences that give slopes
CLOSE = 1e-6  # mm, of margin
MOST_STEPS = 8
MOST_WALLS = 3
WALK = 16  # steps along a slope

Walls = NDArray[np.uint64]  # a bit for each wall that a point lies on
Names = NDArray[np.intp]  # which margin's wall each bit means, (64,)


def onto_walls(
    margins: Margins, points: Array, walls: Walls, names: Names, most: Array
) -> tuple[Array, NDArray[np.bool_]]:
    """Points (n, d) moved onto all of their walls at once by the shortest way, at most `most` mm.

    Newton's method with the least step that solves all of a point's margins. Returns the points,
    and whether each came within a hundred nanometres of all its walls; with more than three, or
    walls that do not meet nearby, it does not.
    """
    moved, done = points.copy(), np.zeros(len(points), dtype=bool)
    counts = np.bitwise_count(walls)
    for count in range(1, min(MOST_WALLS, margins.dimensions) + 1):
        group = np.flatnonzero(counts == count)
        if len(group):
            columns = names[_bits(walls[group], count)]
            moved[group], done[group] = _solve(margins, points[group], columns, most[group])
    return moved, done


def onto_boundary(margins: Margins, points: Array, most: Array) -> tuple[Array, NDArray[np.bool_]]:
    """Points (n, d) moved along the slope of their least margin to where they first meet the
    boundary, at most `most` mm; and whether they do."""
    _, code = margins.nearest(points)
    _, slope = _values_and_slopes(margins, points, code.astype(np.intp)[:, None])
    length = np.linalg.norm(slope[:, 0], axis=-1, keepdims=True)
    outward = -slope[:, 0] / np.maximum(length, 1e-30)
    inside = margins.least(points) >= 0
    way = np.where(inside[:, None], outward, -outward) * most[:, None]
    steps = points[:, None] + way[:, None] * np.linspace(0.0, 1.0, WALK + 1)[:, None]
    changed = (margins.least(steps) >= 0) != inside[:, None]
    done, first = changed.any(axis=1), changed.argmax(axis=1)
    rows = np.arange(len(points))
    before, after = steps[rows, np.maximum(first - 1, 0)], steps[rows, first]
    swap = ~inside[:, None]
    moved = crossing(margins, np.where(swap, after, before), np.where(swap, before, after))
    return np.where(done[:, None], moved, points), done


def _bits(walls: Walls, count: int) -> NDArray[np.intp]:
    """The positions of the `count` bits that are set in each."""
    bits = (walls[:, None] >> np.arange(64, dtype=np.uint64)) & np.uint64(1)
    return np.nonzero(bits)[1].reshape(-1, count)


def _solve(
    margins: Margins, points: Array, columns: NDArray[np.intp], most: Array
) -> tuple[Array, NDArray[np.bool_]]:
    moved = points.copy()
    for _ in range(MOST_STEPS):
        value, slope = _values_and_slopes(margins, moved, columns)
        moved = moved + _least_step(value, slope)
    value = margins.some(moved, columns)
    near = np.linalg.norm(moved - points, axis=-1) <= most
    return moved, near & (np.abs(value) < 100 * CLOSE).all(axis=-1)


def _values_and_slopes(
    margins: Margins, points: Array, columns: NDArray[np.intp]
) -> tuple[Array, Array]:
    """(n, k) of the named margins, and (n, k, d) of their gradients."""
    value = margins.some(points, columns)
    slopes = []
    for axis in range(margins.dimensions):
        shift = np.zeros(margins.dimensions)
        shift[axis] = STEP
        ahead = margins.some(points + shift, columns)
        behind = margins.some(points - shift, columns)
        slopes.append((ahead - behind) / (2 * STEP))
    return value, np.stack(slopes, axis=-1)


def _least_step(value: Array, slope: Array) -> Array:
    """(n, d): the shortest step that makes all values 0, were they linear."""
    gram = slope @ np.swapaxes(slope, -1, -2)
    gram += 1e-9 * np.eye(gram.shape[-1])  # walls that touch have no shortest way to their edge
    return -(np.swapaxes(slope, -1, -2) @ np.linalg.solve(gram, value[..., None]))[..., 0]
