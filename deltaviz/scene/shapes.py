"""Meshes of the robot's parts, built from rings of points. Lengths in metres.

Bands between rings have vertices of their own, so that edges stay crisp while round faces
shade smoothly.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import reduce
from itertools import pairwise
from typing import Self

import numpy as np
from numpy.typing import NDArray

from deltaviz.scene.rotations import matrix
from deltaviz.scene.units import Array

# Few enough that a computer without a graphics card keeps up; shading rounds the rest.
SEGMENTS = 24
THIN_SEGMENTS = 12


@dataclass(frozen=True)
class Shape:
    """`vertices` (n, 3) float32, `faces` (m, 3) indices into them."""

    vertices: NDArray[np.float32]
    faces: NDArray[np.uint32]

    def __add__(self, other: Self) -> Shape:
        return Shape(
            np.concatenate((self.vertices, other.vertices)),
            np.concatenate((self.faces, other.faces + np.uint32(len(self.vertices)))),
        )

    def turned(self, wxyz: Array) -> Shape:
        return Shape((self.vertices @ matrix(wxyz).T).astype(np.float32), self.faces)

    def moved(self, offset: tuple[float, float, float] | Array) -> Shape:
        return Shape(self.vertices + np.asarray(offset, dtype=np.float32), self.faces)


def joined(*shapes: Shape) -> Shape:
    return reduce(Shape.__add__, shapes)


def loft(rings: list[Array], *, smooth: bool = False) -> Shape:
    """The skin over successive closed rings, each (k, 3), with the same k."""
    if smooth:
        return _skin(np.stack(rings))
    return joined(*(_skin(np.stack(pair)) for pair in pairwise(rings)))


def lathe(
    profile: list[tuple[float, float]], *, smooth: bool = False, segments: int = SEGMENTS
) -> Shape:
    """A (radius, z) profile turned about the z axis. A radius of 0 closes it."""
    angles = np.linspace(0.0, 2 * math.pi, segments, endpoint=False)
    circle = np.stack((np.cos(angles), np.sin(angles), np.zeros(segments)), axis=-1)
    rings = [circle * (radius, radius, 0.0) + (0.0, 0.0, z) for radius, z in profile]
    return loft(rings, smooth=smooth)


def cylinder(
    radius: float, z_from: float, z_to: float, *, bevel: float = 0.0, segments: int = SEGMENTS
) -> Shape:
    """A closed cylinder about the z axis, z_from below z_to."""
    side = [(radius, z_from + bevel), (radius, z_to - bevel)]
    if bevel:
        side = [(radius - bevel, z_from), *side, (radius - bevel, z_to)]
    return lathe([(0.0, z_from), *side, (0.0, z_to)], segments=segments)


def sphere(radius: float) -> Shape:
    angles = np.linspace(-math.pi / 2, math.pi / 2, 8)
    profile = [(radius * math.cos(a), radius * math.sin(a)) for a in angles]
    return lathe(profile, smooth=True, segments=THIN_SEGMENTS)


def beam(length: float, root: tuple[float, float], tip: tuple[float, float]) -> Shape:
    """A tapered arm along +x with rounded sections of (width in y, height in z)."""
    angles = np.linspace(0.0, 2 * math.pi, SEGMENTS, endpoint=False)
    c, s = np.cos(angles), np.sin(angles)
    y, z = np.sign(c) * np.abs(c) ** 0.6 / 2, np.sign(s) * np.abs(s) ** 0.6 / 2

    def section(share: float, scale: float = 1.0) -> Array:
        width, height = (a + (b - a) * share for a, b in zip(root, tip, strict=True))
        x = np.full(SEGMENTS, share * length)
        return np.stack((x, y * width * scale, z * height * scale), axis=-1)

    body = loft([section(share) for share in np.linspace(0.0, 1.0, 3)], smooth=True)
    root_end = loft([section(0.0, 0.0), section(0.0)])
    tip_end = loft([section(1.0), section(1.0, 0.0)])
    return joined(body, root_end, tip_end)


def block(x: tuple[float, float], y: tuple[float, float], z: tuple[float, float]) -> Shape:
    """A box between two coordinates on each axis."""
    corners = np.array([(x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1])])
    around = np.repeat(corners, 2, axis=0)  # twice, so that the edges stay crisp
    bottom, top = (np.column_stack((around, np.full(8, height))) for height in z)
    ends = [np.tile((sum(x) / 2, sum(y) / 2, height), (8, 1)) for height in z]
    return loft([ends[0], bottom, top, ends[1]])


def plate(outline: Array, hole: float, z_from: float, z_to: float, *, bevel: float = 0.0) -> Shape:
    """A plate with a round hole. `outline` holds radii over equal angles from +x, (k,)."""
    angles = np.linspace(0.0, 2 * math.pi, len(outline), endpoint=False)
    directions = np.stack((np.cos(angles), np.sin(angles), np.zeros_like(angles)), axis=-1)

    def ring(radii: Array, z: float) -> Array:
        return directions * radii[:, None] + (0.0, 0.0, z)

    inner = np.full_like(outline, hole)
    rings = [
        ring(inner + bevel, z_from),
        ring(outline - bevel, z_from),
        ring(outline, z_from + bevel),
        ring(outline, z_to - bevel),
        ring(outline - bevel, z_to),
        ring(inner + bevel, z_to),
        ring(inner, z_to - bevel),
        ring(inner, z_from + bevel),
        ring(inner + bevel, z_from),
    ]
    return loft(rings)


def hull_outline(centres: Array, radius: float, *, points: int = 72) -> Array:
    """Radii, over equal angles from +x, of the convex hull of discs around the origin.

    `centres` (n, 2). The hull's support in direction u is h(u) = max c·u + radius, and its
    edge in direction φ lies at the least h(u) / (u·φ).
    """
    u = np.linspace(0.0, 2 * math.pi, 720, endpoint=False)
    normals = np.stack((np.cos(u), np.sin(u)), axis=-1)
    support = (normals @ centres.T).max(axis=-1) + radius
    phi = np.linspace(0.0, 2 * math.pi, points, endpoint=False)
    facing = np.cos(phi[:, None] - u)
    return np.where(facing > 0.05, support / np.maximum(facing, 0.05), np.inf).min(axis=-1)


def _skin(rings: Array) -> Shape:
    """Triangles between rings (r, k, 3) that share their vertices."""
    count, size = rings.shape[:2]
    index = np.arange(count * size, dtype=np.uint32).reshape(count, size)
    a, b = index[:-1], index[1:]
    a1, b1 = np.roll(a, -1, axis=1), np.roll(b, -1, axis=1)
    faces = np.stack((a, a1, b1, a, b1, b), axis=-1).reshape(-1, 3)
    return Shape(rings.reshape(-1, 3).astype(np.float32), faces)
