"""Where a body could stand: the free space around the nodes of a grid."""

from __future__ import annotations

import math

import numpy as np

from deltaviz.mechanism.arrays import Array
from deltaviz.robots.workspace import margins_compiled as compiled
from deltaviz.robots.workspace.cells import Box
from deltaviz.robots.workspace.margins import Margins
from deltaviz.robots.workspace.stems import Stem

ACROSS = 120  # nodes along the longest side
LEVELS = 80
STARTS = 3


def places(
    margins: Margins, box: Box, stem: Stem, length: float | None, start: float | None
) -> tuple[list[Array], float]:
    """Lines about which the best body may stand, and a proved bound of what any is worth.

    At each node the distance to the nearest node outside bounds every body about it from above;
    bodies about other lines by the distance to the nearest node more.
    """
    across = list(stem.across)
    cell = float((box.size[across] / stem.sides).max()) / ACROSS
    axes = [
        _centred(box.low[i], box.high[i], cell * s) for i, s in zip(across, stem.sides, strict=True)
    ]
    levels, height = _levels(box, stem, length, start)
    free = _free(margins, stem, axes, levels, cell)
    slack = float(stem.distance(np.full(len(across), cell / 2) * stem.sides))
    most = float((box.size[across] / stem.sides).max()) / 2
    if length is not None:
        count = len(levels) if start is not None else max(1, math.floor(length / height))
        worth = _least_over(free, count) if count <= len(levels) else free[:0]
        over = worth.max(axis=0) if len(worth) else np.zeros(free.shape[1:])
        bound = float(over.max()) + slack
    else:
        over, bound = _largest_over(free, height, stem.power, slack, most, start is not None)
    found = [np.zeros(len(across))]
    flat = np.argsort(over, axis=None)[::-1]
    for place in flat[: STARTS * 200]:
        index = np.unravel_index(place, over.shape)
        centre = np.array([axis[i] for axis, i in zip(axes, index, strict=True)])
        if all(stem.distance(centre - other) > 4 * cell for other in found):
            found.append(centre)
        if len(found) > STARTS:
            break
    return found, bound


def _centred(low: float, high: float, cell: float) -> Array:
    """Nodes over low..high and one beyond at each end, 0 among them."""
    return cell * np.arange(
        math.floor(low / cell) - 1, math.ceil(high / cell) + 2, dtype=np.float64
    )


def _levels(box: Box, stem: Stem, length: float | None, start: float | None) -> tuple[Array, float]:
    low, high = float(box.low[stem.axis]), float(box.high[stem.axis])
    if start is not None:
        low, high = start, start + length if length is not None else max(high, start)
    height = (high - low) / LEVELS
    if length is not None and start is None:
        height = min(height, length / 10)
    return np.arange(low, high + height / 2, height) if height > 0 else np.array([low]), height


def _free(margins: Margins, stem: Stem, axes: list[Array], levels: Array, cell: float) -> Array:
    """(levels, ...) the thickness at which a body about each node touches a node outside."""
    from scipy.ndimage import distance_transform_cdt, distance_transform_edt

    y = axes[1] if len(axes) > 1 else np.zeros(1)
    value = np.empty((len(axes[0]), len(y), len(levels)), np.float32)
    code = np.empty(value.shape, np.uint8)
    compiled.field(axes[0], y, levels, margins.arms, margins.rest, margins.off, value, code)
    inside = np.moveaxis(value >= 0, -1, 0)
    if len(axes) == 1:
        inside = inside[..., 0]
    free = np.empty(inside.shape)
    for level, here in enumerate(inside):
        if stem.half is None:
            free[level] = distance_transform_edt(here)
        else:
            free[level] = distance_transform_cdt(here, "chessboard")
    return cell * free


def _least_over(free: Array, count: int) -> Array:
    """The least over each `count` levels that follow each other."""
    out = free[: len(free) - count + 1].copy()
    for shift in range(1, count):
        np.minimum(out, free[shift : len(free) - count + 1 + shift], out=out)
    return out


def _largest_over(
    free: Array, height: float, power: int, slack: float, most: float, first_only: bool
) -> tuple[Array, float]:
    """The largest worth at each place, from what holds `count` levels and is less than
    `count + 1` heights long."""
    bound = height * most**power
    over = np.zeros(free.shape[1:])
    least = free.copy()
    for count in range(1, len(free) + 1):
        here = least[:1] if first_only else least
        longest = (count if first_only else count + 1) * height
        bound = max(bound, longest * (float(here.max()) + slack) ** power)
        np.maximum(over, count * height * here.max(axis=0) ** power, out=over)
        if count < len(free):
            least = np.minimum(least[:-1], free[count:])
    return over, bound
