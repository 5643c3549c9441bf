"""Three arms about a centre.

Their forearms' spheres, of radii l_i about D_i, meet in P: a = D2 - D1, b = D3 - D1, n = a × b,
alpha = (|a|² + l1² - l2²) / 2, beta = (|b|² + l1² - l3²) / 2, w = (alpha b × n + beta n × a) / n²:
P = D1 + w - n √((l1² - |w|²) / n²), the working assembly of arms that stand counter-clockwise.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import copysign, cos, sin, sqrt

from deltaviz.link.board.kinematics import Arm, Kinematics, Vector


class RotaryDelta(Kinematics):
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
        arms = [
            Arm(base - effector, upper, fore, cos(turned), sin(turned))
            for base, effector, upper, fore, turned in zip(
                base_radius, effector_radius, upper_arm, forearm, azimuth, strict=True
            )
        ]
        super().__init__(arms, tool_offset=tool_offset)
        one, two, three = arms
        self._handedness = copysign(1.0, _turn(one, two) + _turn(two, three) + _turn(three, one))

    def _meet(self, elbows: Sequence[Vector]) -> Vector | None:
        """Written out in scalars: it runs four times for each segment."""
        first, second, third = elbows
        l1, l2, l3 = (arm.forearm for arm in self.arms)
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
        k = self._handedness * sqrt(height2 / n2)
        return (x1 + wx - nx * k, y1 + wy - ny * k, z1 + wz - nz * k)

    def _works(self, forearms: Sequence[Vector]) -> bool:
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = forearms
        nx, ny, nz = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
        return self._handedness * (nx * cx + ny * cy + nz * cz) < 0.0


def _turn(one: Arm, other: Arm) -> float:
    """The sine of the angle from one arm's azimuth to the other's."""
    return one.cos * other.sin - one.sin * other.cos
