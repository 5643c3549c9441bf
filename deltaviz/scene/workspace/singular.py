"""The surfaces on which a robot is singular, as a task of the computing processes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from deltaviz.robots import Robot
from deltaviz.robots.workspace.singular import Kind, Singular, singular
from deltaviz.scene.units import metres
from deltaviz.scene.workspace.pictures import Picture, Singularities, Surface


@dataclass(frozen=True)
class Near:
    """Both kinds, where they come near to the workspace."""

    robot: Robot

    def pictures(self) -> Iterator[Picture]:
        first, second = (singular(self.robot, kind) for kind in (Kind.TYPE_1, Kind.TYPE_2))
        yield Singularities(_surface(first), _surface(second))


def _surface(found: Singular | None) -> Surface | None:
    if found is None:
        return None
    vertices, faces, edges = found.vertices, found.faces, np.empty((0, 2, 3))
    if faces.shape[1] == 2:
        vertices = np.insert(vertices, 1, 0.0, axis=1)
        faces, edges = np.empty((0, 3), np.int64), vertices[faces]
    return Surface(
        vertices=metres(vertices).astype(np.float32),
        faces=faces.astype(np.uint32),
        edges=metres(edges).astype(np.float32),
        distance=found.distance,
        near=found.near,
    )
