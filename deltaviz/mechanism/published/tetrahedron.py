"""Forward by the tetrahedron's circumcentre (Zheng and Chen 2023, their equations 9 to 15)."""

from __future__ import annotations

import numpy as np

from deltaviz.mechanism.arrays import Array
from deltaviz.mechanism.published.legs import Legs, elbow_centres, turning


@np.errstate(all="ignore")
def tetrahedron(legs: Legs, theta: Array) -> Array:
    """(..., 3) rad to (..., 3) mm, below the elbows; NaN where the forearms cannot meet.

    P is as far from D1 as from D2 and D3, so it stands above or below their circumcentre E. From
    F, the middle of D1 D2, E lies in the direction D1D2 × (D2D3 × D1D3), beyond F as seen from
    D3 where the triangle is obtuse there. Raises ValueError unless all forearms are equal.
    """
    lengths = {leg.fore for leg in legs}
    if len(lengths) > 1:
        raise ValueError("the tetrahedron's method needs forearms of one length")
    fore = lengths.pop()
    d1, d2, d3 = np.moveaxis(elbow_centres(legs, theta), -2, 0)
    d12, d23, d13 = d2 - d1, d3 - d2, d3 - d1
    side12, side23, side13 = (_length(side) for side in (d12, d23, d13))
    normal = np.cross(d23, d13)
    circumradius = side12 * side23 * side13 / (2 * _length(normal))
    cosine_at_3 = (d13 * d23).sum(axis=-1, keepdims=True) / (side13 * side23)
    from_middle = circumradius * cosine_at_3  # |FE|, with the sign that tells the side
    across = np.cross(d12, normal)
    centre = (d1 + d2) / 2 + from_middle * across / _length(across)
    height = np.sqrt(fore**2 - circumradius**2)
    return centre + turning(legs) * height * normal / _length(normal)


def _length(vectors: Array) -> Array:
    return np.sqrt((vectors**2).sum(axis=-1, keepdims=True))
