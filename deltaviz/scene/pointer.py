"""From a pointer on the screen to a place in the scene: pure ray maths, in metres.

A drag follows the pointer over the horizontal plane at the height where the robot was
grabbed, or with Shift along the vertical line through that place. A planar robot is dragged in
its own plane.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from deltaviz.scene import rotations
from deltaviz.scene.units import Array

Screen = tuple[float, float]
_GRAZING = math.sin(math.radians(2.0))  # below this angle a pixel is metres


@dataclass(frozen=True)
class Eye:
    """A camera as viser reports it: OpenCV axes (x right, y down, z forward), `fov` vertical
    in rad, `aspect` width over height."""

    position: Array
    wxyz: Array
    fov: float
    aspect: float

    def ray(self, screen: Screen) -> Array:
        """Unit direction through a place on the screen, (0, 0) top left to (1, 1)."""
        height = 2.0 * math.tan(self.fov / 2.0)
        x = (screen[0] - 0.5) * height * self.aspect
        y = (screen[1] - 0.5) * height
        direction = rotations.matrix(self.wxyz) @ np.array((x, y, 1.0))
        return direction / np.linalg.norm(direction)

    def project(self, point: Array) -> Screen:
        """Where a point of the scene appears on the screen."""
        x, y, z = rotations.matrix(self.wxyz).T @ (point - self.position)
        height = 2.0 * math.tan(self.fov / 2.0)
        return 0.5 + x / z / (height * self.aspect), 0.5 + y / z / height

    @property
    def yaw(self) -> float:
        """The turn (rad, counter-clockwise) from base +x to what is right on the screen."""
        right = rotations.matrix(self.wxyz)[:, 0]
        return math.atan2(right[1], right[0])


@dataclass(frozen=True)
class Grip:
    """What a drag keeps: the place that was grabbed and where the tool tip was then."""

    grabbed: Array
    tip: Array

    def over_plane(self, eye: Eye, screen: Screen) -> Array | None:
        """The tip when the grabbed place lies under the pointer at its own height; None when
        the pointer is above the horizon or so near to it that a pixel means too much."""
        hit = _hit(eye, screen, self.grabbed, np.array((0.0, 0.0, 1.0)))
        if hit is None:
            return None
        x, y, _ = hit - self.grabbed
        return self.tip + np.array((x, y, 0.0))

    def in_plane(self, eye: Eye, screen: Screen) -> Array | None:
        """The tip when the grabbed place lies under the pointer in the plane of x and z; None
        when the camera looks along that plane."""
        hit = _hit(eye, screen, self.grabbed, np.array((0.0, 1.0, 0.0)))
        if hit is None:
            return None
        x, _, z = hit - self.grabbed
        return self.tip + np.array((x, 0.0, z))

    def along_vertical(self, eye: Eye, screen: Screen) -> Array | None:
        """The tip when the grabbed place is as high as the pointer, on its own vertical line;
        None when the camera looks down along it."""
        way = along(eye, screen, self.grabbed, np.array((0.0, 0.0, 1.0)))
        return None if way is None else self.tip + np.array((0.0, 0.0, way))


def along(eye: Eye, screen: Screen, through: Array, direction: Array) -> float | None:
    """How far along a line through a place its point under the pointer lies from there;
    `direction` is a unit vector. None when the camera looks along the line."""
    towards = through - eye.position
    normal = towards - (towards @ direction) * direction
    if np.linalg.norm(normal) < _GRAZING * np.linalg.norm(towards):
        return None
    hit = _hit(eye, screen, through, normal / np.linalg.norm(normal))
    return None if hit is None else float((hit - through) @ direction)


def _hit(eye: Eye, screen: Screen, through: Array, normal: Array) -> Array | None:
    """Where the pointer's ray meets a plane; None behind the camera or at a grazing angle."""
    ray = eye.ray(screen)
    slope = float(ray @ normal)
    if abs(slope) < _GRAZING:
        return None
    distance = float((through - eye.position) @ normal) / slope
    return eye.position + distance * ray if distance > 0.0 else None
