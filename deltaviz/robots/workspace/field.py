"""A workspace sampled on a grid."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deltaviz.mechanism.arrays import Array
from deltaviz.mechanism.threads import in_threads
from deltaviz.robots.workspace import margins_compiled as compiled
from deltaviz.robots.workspace.cells import Box
from deltaviz.robots.workspace.margins import Margins

MOST_NODES = 100_000_000  # some gigabytes, with what is computed of each


class TooFine(ValueError):
    """A grid of more nodes than memory holds; says which spacing is possible."""


@dataclass(frozen=True)
class Grid:
    """Nodes `low + cell * index`, `shape` of them; mm."""

    low: Array
    cell: float
    shape: tuple[int, ...]

    @classmethod
    def around(cls, box: Box, cell: float) -> Grid:
        """Over the box and at least a cell beyond it on every side, nodes at whole cells from 0.
        Raises TooFine."""
        low = np.floor(box.low / cell) - 1
        high = np.ceil(box.high / cell) + 1
        nodes = float(np.prod(high - low + 1))
        if nodes > MOST_NODES:
            least = cell * (nodes / MOST_NODES) ** (1 / len(low))
            raise TooFine(
                f"a spacing of {cell:g} mm makes {nodes:.2g} points, and at most {MOST_NODES:.0e} "
                f"are possible: use {_up(least)} mm or more"
            )
        return cls(low * cell, cell, tuple(int(n) for n in high - low + 1))

    @property
    def axes(self) -> tuple[Array, ...]:
        return tuple(
            low + self.cell * np.arange(n) for low, n in zip(self.low, self.shape, strict=True)
        )


def _up(length: float) -> str:
    """To two digits, a little more."""
    digit = 10.0 ** (math.floor(math.log10(length)) - 1)
    return f"{math.ceil(1.02 * length / digit) * digit:g}"


@dataclass(frozen=True)
class Field:
    """Least margin at each node (mm, at least 0 within the workspace) and the index of its name
    in `Margins.names`; both of the grid's shape."""

    grid: Grid
    value: NDArray[np.float32]
    code: NDArray[np.uint8]


def sample(margins: Margins, grid: Grid, *, threads: int = 1) -> Field:
    """Some 40 ns a node on each thread, 5 bytes a node."""
    x, *between, z = grid.axes
    y = between[0] if between else np.zeros(1)
    value = np.empty((len(x), len(y), len(z)), np.float32)
    code = np.empty(value.shape, np.uint8)

    def run(part: slice) -> None:
        compiled.field(
            x[part], y, z, margins.arms, margins.rest, margins.off, value[part], code[part]
        )
        _collide(margins, (x[part], y, z), value[part], code[part])

    in_threads(run, len(x), threads, least=max(1, 10_000 // (len(y) * len(z))))
    return Field(grid, value.reshape(grid.shape), code.reshape(grid.shape))


def _collide(
    margins: Margins,
    axes: tuple[Array, Array, Array],
    value: NDArray[np.float32],
    code: NDArray[np.uint8],
) -> None:
    """Collisions are looked for where nothing else ends the workspace: they take longest."""
    if margins.collisions is None:
        return
    inside = np.argwhere(value >= 0)
    points = np.stack([axis[i] for axis, i in zip(axes, inside.T, strict=True)], axis=-1)
    gap, pair = margins.gaps(points)
    place = tuple(inside.T)
    closer = gap < value[place]
    code[place] = np.where(closer, pair, code[place])
    value[place] = np.where(closer, gap, value[place])
