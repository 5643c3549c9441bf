"""The board's own forward kinematics, one pose at a time, in plain arithmetic: independent of the
host's, and in the shape that the firmware takes.

Elbow centres moved inward, D_i, then the general trilateration of three spheres of radii l_i:
with a = D2 - D1, b = D3 - D1, n = a × b, alpha = (|a|² + l1² - l2²) / 2,
beta = (|b|² + l1² - l3²) / 2, w = (alpha b × n + beta n × a) / n²:
P = D1 + w - n √((l1² - |w|²) / n²), the working assembly.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import cos, sin, sqrt
from typing import Protocol

Vector = tuple[float, float, float]

GEOMETRY = ("base_radius", "effector_radius", "upper_arm", "forearm", "azimuths")


class ForwardKinematics(Protocol):
    def tip(self, theta: Sequence[float]) -> Vector | None:
        """The tool tip (mm) at joint angles (rad); None where the forearms cannot meet, or where
        an arm has passed the edge of its reach (elbow inside).
        """
        ...


@dataclass(frozen=True, slots=True)
class _Arm:
    offset: float  # s = R - r
    upper: float
    forearm: float
    cos_azimuth: float
    sin_azimuth: float


class RotaryDeltaForward:
    def __init__(self, geometry: Mapping[str, Sequence[float]], tool_offset: Sequence[float]):
        """`geometry` has the names of GEOMETRY with three numbers each (mm, azimuths in rad)."""
        self._tool = tuple(tool_offset)
        self._arms = tuple(
            _Arm(base - effector, upper, forearm, cos(azimuth), sin(azimuth))
            for base, effector, upper, forearm, azimuth in zip(
                *(geometry[name] for name in GEOMETRY), strict=True
            )
        )

    def tip(self, theta: Sequence[float]) -> Vector | None:
        elbows = [
            _elbow(arm, cos(angle), sin(angle))
            for arm, angle in zip(self._arms, theta, strict=True)
        ]
        centre = _meet(elbows, [arm.forearm for arm in self._arms])
        if centre is None:
            return None
        for arm, elbow, angle in zip(self._arms, elbows, theta, strict=True):
            outward = (centre[0] - elbow[0]) * arm.cos_azimuth + (
                centre[1] - elbow[1]
            ) * arm.sin_azimuth
            if -outward * sin(angle) - (centre[2] - elbow[2]) * cos(angle) <= 0.0:
                return None
        tool = self._tool
        return (centre[0] + tool[0], centre[1] + tool[1], centre[2] + tool[2])


def _elbow(arm: _Arm, cos_angle: float, sin_angle: float) -> Vector:
    out = arm.offset + arm.upper * cos_angle
    return (out * arm.cos_azimuth, out * arm.sin_azimuth, -arm.upper * sin_angle)


def _meet(elbows: Sequence[Vector], radii: Sequence[float]) -> Vector | None:
    first, second, third = elbows
    l1, l2, l3 = radii
    a = (second[0] - first[0], second[1] - first[1], second[2] - first[2])
    b = (third[0] - first[0], third[1] - first[1], third[2] - first[2])
    n = _cross(a, b)
    n2 = _dot(n, n)
    if n2 < 1e-9:
        return None
    alpha = (_dot(a, a) + l1 * l1 - l2 * l2) / 2
    beta = (_dot(b, b) + l1 * l1 - l3 * l3) / 2
    bn = _cross(b, n)
    na = _cross(n, a)
    w = (
        (alpha * bn[0] + beta * na[0]) / n2,
        (alpha * bn[1] + beta * na[1]) / n2,
        (alpha * bn[2] + beta * na[2]) / n2,
    )
    height2 = l1 * l1 - _dot(w, w)
    if height2 < 0.0:
        return None
    k = sqrt(height2 / n2)
    return (
        first[0] + w[0] - n[0] * k,
        first[1] + w[1] - n[1] * k,
        first[2] + w[2] - n[2] * k,
    )


def _dot(a: Vector, b: Vector) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _cross(a: Vector, b: Vector) -> Vector:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
