"""The board's own forward kinematics, one pose at a time, in plain arithmetic: independent of the
host's, and in the shape that the firmware takes.

Elbow centres moved inward, D_i, then the general trilateration of three spheres of radii l_i:
with a = D2 - D1, b = D3 - D1, n = a × b, alpha = (|a|² + l1² - l2²) / 2,
beta = (|b|² + l1² - l3²) / 2, w = (alpha b × n + beta n × a) / n²:
P = D1 + w - n √((l1² - |w|²) / n²), the working assembly.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, sin, sqrt
from typing import Protocol

Vector = tuple[float, float, float]


class ForwardKinematics(Protocol):
    def tip(self, theta: Sequence[float]) -> Vector | None:
        """The tool tip (mm) at joint angles (rad); None where the forearms cannot meet, or where
        an arm has passed the edge of its reach (elbow inside).
        """
        ...


class RotaryDeltaForward:
    """Three numbers each: mm, and the azimuths in rad."""

    def __init__(
        self,
        *,
        base_radius: Sequence[float],
        effector_radius: Sequence[float],
        upper_arm: Sequence[float],
        forearm: Sequence[float],
        azimuth: Sequence[float],
        tool_offset: Sequence[float],
    ) -> None:
        self._tool = tuple(tool_offset)
        self._arms = tuple(
            (base_radius[i] - effector_radius[i], upper_arm[i], cos(azimuth[i]), sin(azimuth[i]))
            for i in range(3)
        )
        self._forearms = tuple(forearm)

    def tip(self, theta: Sequence[float]) -> Vector | None:
        angles = [(cos(angle), sin(angle)) for angle in theta]
        elbows: list[Vector] = []
        for (offset, upper, cos_azimuth, sin_azimuth), (cos_angle, sin_angle) in zip(
            self._arms, angles, strict=True
        ):
            out = offset + upper * cos_angle
            elbows.append((out * cos_azimuth, out * sin_azimuth, -upper * sin_angle))
        centre = _meet(elbows[0], elbows[1], elbows[2], *self._forearms)
        if centre is None:
            return None
        x, y, z = centre
        for (_, _, cos_azimuth, sin_azimuth), (cos_angle, sin_angle), elbow in zip(
            self._arms, angles, elbows, strict=True
        ):
            outward = (x - elbow[0]) * cos_azimuth + (y - elbow[1]) * sin_azimuth
            if outward * sin_angle + (z - elbow[2]) * cos_angle >= 0.0:
                return None
        tool = self._tool
        return (x + tool[0], y + tool[1], z + tool[2])


def _meet(
    first: Vector, second: Vector, third: Vector, l1: float, l2: float, l3: float
) -> Vector | None:
    """Where three spheres meet, on the side of the working assembly.

    Written out in scalars: it runs four times for each segment.
    """
    x1, y1, z1 = first
    ax, ay, az = second[0] - x1, second[1] - y1, second[2] - z1
    bx, by, bz = third[0] - x1, third[1] - y1, third[2] - z1
    nx, ny, nz = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
    n2 = nx * nx + ny * ny + nz * nz
    if n2 < 1e-9:
        return None
    alpha = (ax * ax + ay * ay + az * az + l1 * l1 - l2 * l2) / (2 * n2)
    beta = (bx * bx + by * by + bz * bz + l1 * l1 - l3 * l3) / (2 * n2)
    wx = alpha * (by * nz - bz * ny) + beta * (ny * az - nz * ay)
    wy = alpha * (bz * nx - bx * nz) + beta * (nz * ax - nx * az)
    wz = alpha * (bx * ny - by * nx) + beta * (nx * ay - ny * ax)
    height2 = l1 * l1 - (wx * wx + wy * wy + wz * wz)
    if height2 < 0.0:
        return None
    k = sqrt(height2 / n2)
    return (x1 + wx - nx * k, y1 + wy - ny * k, z1 + wz - nz * k)
