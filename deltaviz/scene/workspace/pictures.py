"""What is to be drawn, as numbers in metres: what the computing processes hand back."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deltaviz.robots.workspace.shapes import Cuboid, Cylinder
from deltaviz.scene.workspace.measures import PLAIN


@dataclass(frozen=True)
class Skin:
    """The boundary: `vertices` (n, 3) float32, `faces` (m, 3); in a plane the filled outline.

    `edges` (k, 2, 3) is a plane's outline. `size` is mm³, or mm² in a plane; `deviation` (mm) is
    None while it is coarse. An empty one has a `reason`. `share` (n,) is each vertex's place on the
    scale of a `measure`, from 0 to 1, and `scale` the ends of that; None in one colour.
    """

    vertices: NDArray[np.float32]
    faces: NDArray[np.uint32]
    edges: NDArray[np.float32]
    size: float
    deviation: float | None
    reason: str | None
    measure: str = PLAIN
    share: NDArray[np.float32] | None = None
    scale: tuple[float, float] | None = None


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
class Surface:
    """Where the robot is singular in one way: `vertices` (n, 3), `faces` (m, 3), or in a plane
    `edges` (k, 2, 3). `distance` (mm) is how near it comes to the workspace; None if not `near`."""

    vertices: NDArray[np.float32]
    faces: NDArray[np.uint32]
    edges: NDArray[np.float32]
    distance: float | None
    near: float


@dataclass(frozen=True)
class Singularities:
    """None if the workspace is empty."""

    type_1: Surface | None
    type_2: Surface | None


@dataclass(frozen=True)
class Failed:
    """It could not be computed."""

    text: str


@dataclass(frozen=True)
class Laid:
    """A thing that lies in the scene, as a cut across z whose colours tell what is within reach;
    `text` tells it in words."""

    section: Section
    text: str


@dataclass(frozen=True)
class Served:
    """How a belt that lies in the scene is served, as is proved."""

    text: str


@dataclass(frozen=True)
class Skill:
    """How well the tool moves at one place; see `Quality`."""

    condition: float
    resolution: float
    slowest: float
    fastest: float


@dataclass(frozen=True)
class Probed:
    """One place of the tool tip `xyz` (mm, in space). `theta_deg` are the arms' angles, None where
    they do not reach; `why_not` says why the tip may not be there. `nearest`: limits, and how many
    mm away they are, the nearest first; none for a place where it may not be."""

    xyz: tuple[float, float, float]
    theta_deg: tuple[float, ...] | None
    why_not: tuple[str, ...]
    nearest: tuple[tuple[str, float], ...]
    skill: Skill | None


Picture = Skin | Section | NoSection | Fitted | Singularities | Laid | Served | Probed | Failed
