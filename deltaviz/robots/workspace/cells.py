"""Boxes of space that are halved until each is proved to lie within a workspace or outside."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deltaviz.mechanism.arrays import Array
from deltaviz.robots.workspace.margins import Margins

Flags = NDArray[np.bool_]


@dataclass(frozen=True)
class Box:
    """An axis-parallel box: `low` and `high` (d,) mm."""

    low: Array
    high: Array

    @property
    def size(self) -> Array:
        return self.high - self.low

    @property
    def empty(self) -> bool:
        return bool((self.high < self.low).any())

    def grown(self, share: float) -> Box:
        """By a share of its longest side, on all sides."""
        by = share * self.size.max()
        return Box(self.low - by, self.high + by)

    def with_(self, other: Box) -> Box:
        """The smallest box that holds both."""
        return Box(np.minimum(self.low, other.low), np.maximum(self.high, other.high))


@dataclass(frozen=True)
class Cells:
    """Boxes of one size: `centres` (n, d), half their size `half` (d,)."""

    centres: Array
    half: Array

    @classmethod
    def of(cls, box: Box, size: float) -> Cells:
        """Cells of about `size` that together are the box; not divided where it has no extent."""
        counts = np.maximum(np.ceil(box.size / size), 1).astype(int)
        half = box.size / counts / 2
        axes = [
            low + step * (2 * np.arange(n) + 1)
            for low, step, n in zip(box.low, half, counts, strict=True)
        ]
        return cls(
            np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, len(half)), half
        )

    @property
    def radius(self) -> float:
        """Of the ball around each centre that holds the cell."""
        return float(np.linalg.norm(self.half))

    def __len__(self) -> int:
        return len(self.centres)

    def __getitem__(self, which: Flags) -> Cells:
        return Cells(self.centres[which], self.half)

    def halved(self) -> Cells:
        """Each cut in two along every axis in which it is not far the shortest, or of no extent."""
        cut = self.half > 0.3 * self.half.max()
        half = np.where(cut, self.half / 2, self.half)
        steps = [(-1.0, 1.0) if c else (0.0,) for c in cut]
        shifts = np.array(list(itertools.product(*steps))) * half
        centres = self.centres[:, None, :] + shifts
        return Cells(centres.reshape(-1, centres.shape[-1]), half)

    def judge(self, margins: Margins) -> tuple[Flags, Flags]:
        """(wholly inside, wholly outside) the workspace, each proved."""
        lower, upper = margins.bounds(self.centres, self.radius)
        return lower >= 0.0, upper < 0.0

    def beyond(self, box: Box) -> Flags:
        """Which are not wholly within it."""
        low, high = self.centres - self.half, self.centres + self.half
        return np.asarray(((low < box.low) | (high > box.high)).any(axis=1))

    @property
    def hull(self) -> Box:
        return Box(self.centres.min(axis=0) - self.half, self.centres.max(axis=0) + self.half)


def reach_box(margins: Margins) -> Box:
    """A box that no arm's tip can leave: each arm ends within L + l of its motor."""
    low, high = [], []
    for offset, upper, fore, cos, sin in margins.arms[:, :5]:
        motor = np.array((offset * cos, offset * sin, 0.0)) + margins.rest[:3]
        low.append(motor - (upper + fore))
        high.append(motor + (upper + fore))
    box = Box(np.max(low, axis=0), np.min(high, axis=0))
    return box if margins.dimensions == 3 else Box(box.low[[0, 2]], box.high[[0, 2]])


HULL_CELLS = 50_000  # judged at once before a hull is left as wide as it is
HULL_SLACK = 0.01


def hull(margins: Margins, *, slack: float = HULL_SLACK) -> Box | None:
    """A box around all of the workspace, proved, within some hundredths of its size; None if the
    workspace is proved empty. `slack` is how much it may be too wide on each side, of its longest:
    less takes longer."""
    box = reach_box(margins)
    if box.empty:
        return None
    cells = Cells.of(box, float(box.size.max()) / 6)
    known: Box | None = None  # around points of the workspace, and a little more
    while True:
        _, outside = cells.judge(margins)
        cells = cells[~outside]
        legal = cells.centres[margins.least(cells.centres) >= 0]
        if len(legal):
            found = Box(legal.min(axis=0), legal.max(axis=0)).grown(slack)
            known = found if known is None else known.with_(found)
        if known is not None:
            cells = cells[cells.beyond(known)]
        if not len(cells):
            return known
        if len(cells) * 2 ** cells.centres.shape[1] > HULL_CELLS:
            return cells.hull if known is None else known.with_(cells.hull)
        cells = cells.halved()
