"""A mechanism as the sources draw it: legs with their lengths, seen each in its own plane."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from deltaviz.mechanism.arrays import Array
from deltaviz.mechanism.five_bar import FiveBar
from deltaviz.mechanism.rotary_delta import RotaryDelta


@dataclass(frozen=True, slots=True)
class Leg:
    """Lengths in mm, `azimuth` in rad: centre to motor, effector's centre to joint, two links."""

    base: float
    effector: float
    upper: float
    fore: float
    azimuth: float

    def seen(self, xyz: Array) -> tuple[Array, Array, Array]:
        """(outward, sideways, up) of points (..., 3), or (x, z) (..., 2), turned to this leg."""
        x, z = xyz[..., 0], xyz[..., -1]
        y = xyz[..., 1] if xyz.shape[-1] == 3 else np.zeros_like(x)
        cos, sin = math.cos(self.azimuth), math.sin(self.azimuth)
        return cos * x + sin * y, cos * y - sin * x, z


Legs = tuple[Leg, ...]


def legs_of(mechanism: RotaryDelta | FiveBar) -> Legs:
    if isinstance(mechanism, FiveBar):
        radii = zip(mechanism.base_half, mechanism.platform_half, strict=True)
        azimuths: tuple[float, ...] = (math.pi, 0.0)
    else:
        radii = zip(mechanism.base_radius, mechanism.effector_radius, strict=True)
        azimuths = tuple(math.radians(azimuth) for azimuth in mechanism.azimuths_deg)
    links = zip(mechanism.upper_arm, mechanism.forearm, strict=True)
    return tuple(
        Leg(base, effector, upper, fore, azimuth)
        for (base, effector), (upper, fore), azimuth in zip(radii, links, azimuths, strict=True)
    )


def elbow_centres(legs: Legs, theta: Array) -> Array:
    """Centres of the spheres (circles in a plane) on which the effector's centre lies.

    (..., n) rad to (..., n, d) mm, d = n: the elbows moved inward by the effector's radius.
    """
    centres: list[Array] = []
    for i, leg in enumerate(legs):
        out = leg.base + leg.upper * np.cos(theta[..., i]) - leg.effector
        up = -leg.upper * np.sin(theta[..., i])
        across = (out * math.cos(leg.azimuth), out * math.sin(leg.azimuth))[: len(legs) - 1]
        centres.append(np.stack((*across, up), axis=-1))
    return np.stack(centres, axis=-2)


def turning(legs: Legs) -> float:
    """+1 where the legs stand counter-clockwise in their order, else -1."""
    ends = [(math.cos(leg.azimuth), math.sin(leg.azimuth)) for leg in legs]
    (ax, ay), (bx, by), (cx, cy) = ends
    return math.copysign(1.0, (bx - ax) * (cy - ay) - (by - ay) * (cx - ax))
