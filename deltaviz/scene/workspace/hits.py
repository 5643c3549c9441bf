"""Which point of what is drawn a ray meets first: pure geometry, in metres."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from deltaviz.scene.units import Array
from deltaviz.scene.workspace.pictures import Section, Skin

_OPAQUE = 127  # of 255: what is more transparent than this is not drawn


@dataclass
class Surfaces:
    """What is drawn of a workspace: its boundary, and flat pictures by their names."""

    skin: Skin | None = None
    flat: dict[str, Section] = field(default_factory=dict[str, Section])

    def hit(self, origin: Array, direction: Array) -> Array | None:
        """The first point (3,) on a ray; None if it meets nothing.

        The boundary is seen through, so the flat pictures within it or behind it come first.
        """
        ways = [_to_picture(section, origin, direction) for section in self.flat.values()]
        nearest = min((way for way in ways if way is not None), default=None)
        if nearest is None and self.skin is not None:
            nearest = _to_skin(self.skin, origin, direction)
        return None if nearest is None else origin + nearest * direction


def _to_picture(section: Section, origin: Array, direction: Array) -> float | None:
    """How many times `direction` it is to a picture, where that is not cut out."""
    axis = section.axis
    if direction[axis] == 0.0:
        return None
    way = float((section.low[axis] - origin[axis]) / direction[axis])
    if way <= 0.0:
        return None
    columns, rows = (i for i in range(3) if i != axis)
    share = (origin + way * direction - section.low)[[rows, columns]]
    share /= (section.high - section.low)[[rows, columns]]
    if not ((share >= 0.0) & (share < 1.0)).all():
        return None
    row, column = (share * section.image.shape[:2]).astype(int)
    return way if section.image[row, column, 3] > _OPAQUE else None


def _to_skin(skin: Skin, origin: Array, direction: Array) -> float | None:
    """How many times `direction` it is to the nearest triangle on the ray's way."""
    aside = np.linalg.svd(direction[None])[2][1:]  # two directions across the ray
    flat = ((skin.vertices - origin) @ aside.T)[skin.faces]
    ahead = np.roll(flat, -1, axis=1)
    turns = flat[..., 0] * ahead[..., 1] - flat[..., 1] * ahead[..., 0]  # (m, 3), about the ray
    crossed = skin.faces[(turns >= 0).all(axis=1) | (turns <= 0).all(axis=1)]
    corners = skin.vertices[crossed].astype(np.float64)
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    slope = normal @ direction
    with np.errstate(divide="ignore", invalid="ignore"):
        ways = ((corners[:, 0] - origin) * normal).sum(axis=-1) / slope
    ways = ways[np.isfinite(ways) & (ways > 0.0)]
    return float(ways.min()) if len(ways) else None
