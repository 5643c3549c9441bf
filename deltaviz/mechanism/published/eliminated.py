"""Forward by elimination: spheres subtracted from each other, a quadratic in z (Trossen 2009)."""

from __future__ import annotations

import numpy as np

from deltaviz.mechanism.arrays import Array
from deltaviz.mechanism.published.legs import Legs, elbow_centres, turning


@np.errstate(all="ignore")
def spheres_eliminated(legs: Legs, theta: Array) -> Array:
    """(..., 3) rad to (..., 3) mm, below the elbows; NaN where the forearms cannot meet.

    Sphere 2 minus 1 and 3 minus 1 are planes: x and y as linear functions of z, by a determinant
    that vanishes where the elbow centres lie in an upright plane. With forearms of any lengths.
    """
    one, two, three = np.moveaxis(elbow_centres(legs, theta), -2, 0)
    w1, w2, w3 = (
        (centre**2).sum(axis=-1) - leg.fore**2
        for centre, leg in zip((one, two, three), legs, strict=True)
    )
    (ax, ay, az), (bx, by, bz) = np.moveaxis(two - one, -1, 0), np.moveaxis(three - one, -1, 0)
    det = ax * by - ay * bx
    slope_x, slope_y = (ay * bz - az * by) / det, (az * bx - ax * bz) / det
    half2, half3 = (w2 - w1) / 2, (w3 - w1) / 2
    start_x, start_y = (half2 * by - half3 * ay) / det, (half3 * ax - half2 * bx) / det
    from_x, from_y = start_x - one[..., 0], start_y - one[..., 1]
    a = slope_x**2 + slope_y**2 + 1
    half_b = slope_x * from_x + slope_y * from_y - one[..., 2]
    c = from_x**2 + from_y**2 + one[..., 2] ** 2 - legs[0].fore ** 2
    root = np.sqrt(half_b**2 - a * c) * turning(legs) * np.sign(det)
    z = (-half_b - root) / a
    return np.stack((slope_x * z + start_x, slope_y * z + start_y, z), axis=-1)


@np.errstate(all="ignore")
def circles_eliminated(legs: Legs, theta: Array) -> Array:
    """The same in a plane: (..., 2) rad to (..., 2) mm (x, z), below the elbows (left, right).

    It divides by the elbows' distance in x: NaN where one stands above the other.
    """
    left, right = np.moveaxis(elbow_centres(legs, theta), -2, 0)
    wl, wr = (
        (centre**2).sum(axis=-1) - leg.fore**2
        for centre, leg in zip((left, right), legs, strict=True)
    )
    dx, dz = np.moveaxis(right - left, -1, 0)
    slope, start = -dz / dx, (wr - wl) / (2 * dx)
    from_x = start - left[..., 0]
    a = slope**2 + 1
    half_b = slope * from_x - left[..., 1]
    c = from_x**2 + left[..., 1] ** 2 - legs[0].fore ** 2
    z = (-half_b - np.sqrt(half_b**2 - a * c) * np.sign(dx)) / a
    return np.stack((slope * z + start, z), axis=-1)
