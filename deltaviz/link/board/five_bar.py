"""Two arms in the plane of x and z: joint 0 the left one, towards -x, joint 1 the right one.

Their forearms' circles, of radii l_i about D_i, meet below the line from the left elbow to the
right: with d = D2 - D1, n = (-d_z, d_x), w = (d² + l1² - l2²) / 2 d²:
P = D1 + w d - n √(l1² / d² - w²).
"""

from __future__ import annotations

from collections.abc import Sequence
from math import sqrt

from deltaviz.link.board.kinematics import Arm, Kinematics, Vector

_BESIDE_MOST = 0.01  # mm, of a tip beside the plane: what rounding may add


class FiveBar(Kinematics):
    """Two numbers each, mm."""

    def __init__(
        self,
        *,
        base_half: Sequence[float],
        platform_half: Sequence[float],
        upper_arm: Sequence[float],
        forearm: Sequence[float],
        tool_offset: Sequence[float],
    ) -> None:
        arms = [
            Arm(base - platform, upper, fore, side, 0.0)
            for base, platform, upper, fore, side in zip(
                base_half, platform_half, upper_arm, forearm, (-1.0, 1.0), strict=True
            )
        ]
        super().__init__(arms, tool_offset=tool_offset)

    def _centre(self, tip: Vector) -> Vector | None:
        x, y, z = tip
        tool = self._tool
        return (x - tool[0], 0.0, z - tool[2]) if abs(y - tool[1]) <= _BESIDE_MOST else None

    def _meet(self, elbows: Sequence[Vector]) -> Vector | None:
        (x1, _, z1), (x2, _, z2) = elbows
        l1, l2 = (arm.forearm for arm in self.arms)
        dx, dz = x2 - x1, z2 - z1
        d2 = dx * dx + dz * dz
        if d2 < 1e-9:
            return None
        w = (d2 + (l1 - l2) * (l1 + l2)) / (2 * d2)
        height2 = l1 * l1 / d2 - w * w
        if height2 < 0.0:
            return None
        k = sqrt(height2)
        return (x1 + w * dx + dz * k, 0.0, z1 + w * dz - dx * k)

    def _works(self, forearms: Sequence[Vector]) -> bool:
        (ax, _, az), (bx, _, bz) = forearms
        return ax * bz - az * bx < 0.0
