"""What is to be drawn, as numbers in metres: what the computing processes hand back."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deltaviz.robots.workspace.shapes import Cuboid, Cylinder


@dataclass(frozen=True)
class Skin:
    """The boundary: `vertices` (n, 3) float32, `faces` (m, 3); in a plane the filled outline.

    `edges` (k, 2, 3) is a plane's outline. `size` is mm³, or mm² in a plane; `deviation` (mm) is
    None while it is coarse. An empty one has a `reason`.
    """

    vertices: NDArray[np.float32]
    faces: NDArray[np.uint32]
    edges: NDArray[np.float32]
    size: float
    deviation: float | None
    reason: str | None


@dataclass(frozen=True)
class Section:
    """A cut at `level` (mm) across `axis` as an `image` (rows, columns, RGBA): columns along the
    first of the other axes, rows along the second, both rising. `low` and `high` (3,) are its
    corners in metres, `span` the workspace's along the axis in mm. `scale` are the ends of the
    colours."""

    axis: int
    level: float
    image: NDArray[np.uint8]
    low: NDArray[np.float64]
    high: NDArray[np.float64]
    span: tuple[float, float]
    scale: tuple[float, float] | None


@dataclass(frozen=True)
class NoSection:
    """Nothing across `axis`: the workspace is empty."""

    axis: int


@dataclass(frozen=True)
class Fitted:
    """The largest upright cylinder about the vertical line through the origin (in a plane, the
    largest rectangle); None if nothing fits."""

    shape: Cylinder | Cuboid | None


@dataclass(frozen=True)
class Failed:
    """It could not be computed."""

    text: str


Picture = Skin | Section | NoSection | Fitted | Failed
