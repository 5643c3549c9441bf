"""The board's own kinematics, one pose at a time, in plain arithmetic: independent of the host's,
and in the shape that the firmware takes.

Each arm stands at its azimuth; moved inward by the effector's radius, the forearms meet in one
point P. In an arm's own plane P is p outward from the motor axis and z up, and v beside it:
K = (p² + v² + z² + L² - l²) / 2L, ρ² = p² + z², q = √(ρ² - K²), θ = atan2(-z K - p q, p K - z q),
the elbow outside. With the elbow's centre D, S = P - D and D' = ∂D/∂θ, the constraint S² = l² gives
θ̇ = S·Ṗ / S·D' and θ̈ = ((Ṗ - D' θ̇)² + S·P̈ - S·D'' θ̇²) / S·D'.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import atan2, cos, sin, sqrt
from typing import NamedTuple

Vector = tuple[float, float, float]

_EDGE_ROUNDING = 1e-15  # of ρ² - K², relative to the sum of the squares that make K


class JointMotion(NamedTuple):
    """Of one joint; `gain`: how far it turns for a mm of the tip along the forearm (rad/mm)."""

    angle: float  # rad
    rate: float  # rad/s
    acceleration: float  # rad/s²
    gain: float


@dataclass(frozen=True, slots=True)
class Arm:
    """`offset` is base radius minus effector radius; lengths in mm; of the azimuth, its cosine and
    sine.
    """

    offset: float
    upper_arm: float
    forearm: float
    cos: float
    sin: float

    def elbow(self, cosine: float, sine: float) -> Vector:
        """D at the joint angle of this cosine and sine."""
        out = self.offset + self.upper_arm * cosine
        return (out * self.cos, out * self.sin, -self.upper_arm * sine)

    def angle(self, x: float, y: float, z: float) -> float | None:
        """Where P is; None out of reach."""
        p = x * self.cos + y * self.sin - self.offset
        v = y * self.cos - x * self.sin
        upper, fore = self.upper_arm, self.forearm
        square = p * p + v * v + z * z
        k = (square + (upper - fore) * (upper + fore)) / (2 * upper)
        rest = p * p + z * z - k * k
        edge = _EDGE_ROUNDING * abs(k) * (square + upper * upper + fore * fore) / upper
        if not rest >= -edge:
            return None
        q = sqrt(max(rest, 0.0))
        return atan2(-z * k - p * q, p * k - z * q)

    def motion(
        self, theta: float, forearm: Vector, velocity: Vector, turn: Vector
    ) -> JointMotion | None:
        """`forearm` is S, `velocity` and `turn` are P's velocity and acceleration. None at the very
        edge of reach.
        """
        sx, sy, sz = forearm
        cosine, sine, upper = cos(theta), sin(theta), self.upper_arm
        outward = sx * self.cos + sy * self.sin
        lever = -upper * (outward * sine + sz * cosine)  # S·D'
        if not lever > 0.0:
            return None
        rate = (sx * velocity[0] + sy * velocity[1] + sz * velocity[2]) / lever
        # Ṗ - D' θ̇
        along = upper * sine * rate
        wx = velocity[0] + along * self.cos
        wy = velocity[1] + along * self.sin
        wz = velocity[2] + upper * cosine * rate
        pull = sx * turn[0] + sy * turn[1] + sz * turn[2]
        bend = upper * (sz * sine - outward * cosine)  # S·D''
        acceleration = (wx * wx + wy * wy + wz * wz + pull - bend * rate * rate) / lever
        return JointMotion(theta, rate, acceleration, self.forearm / lever)


class Kinematics:
    """What all kinds of arms have in common; they differ in how their forearms meet."""

    def __init__(self, arms: Sequence[Arm], *, tool_offset: Sequence[float]) -> None:
        self.arms = tuple(arms)
        x, y, z = tool_offset
        self._tool = (x, y, z)

    def tip(self, theta: Sequence[float]) -> Vector | None:
        """The tool tip (mm) at joint angles (rad) of the arms; None where the forearms cannot meet,
        or where an arm has passed the edge of its reach (elbow inside).
        """
        angles = [(cos(angle), sin(angle)) for angle in theta]
        elbows = [arm.elbow(*angle) for arm, angle in zip(self.arms, angles, strict=True)]
        centre = self._meet(elbows)
        if centre is None:
            return None
        x, y, z = centre
        for arm, (cosine, sine), elbow in zip(self.arms, angles, elbows, strict=True):
            outward = (x - elbow[0]) * arm.cos + (y - elbow[1]) * arm.sin
            if outward * sine + (z - elbow[2]) * cosine >= 0.0:
                return None
        tool = self._tool
        return (x + tool[0], y + tool[1], z + tool[2])

    def angles(self, tip: Vector) -> list[float] | None:
        """The joint angles of the arms (rad); None where an arm cannot reach."""
        centre = self._centre(tip)
        return None if centre is None else self._angles(centre)

    def motions(
        self, tip: Vector, velocity: Vector, acceleration: Vector
    ) -> list[JointMotion] | None:
        """Of the arms' joints, for a tip that moves so (mm, s); None where an arm cannot reach, or
        the forearms meet on the wrong side.
        """
        centre = self._centre(tip)
        theta = None if centre is None else self._angles(centre)
        if centre is None or theta is None:
            return None
        forearms: list[Vector] = []
        found: list[JointMotion] = []
        for arm, angle in zip(self.arms, theta, strict=True):
            x, y, z = arm.elbow(cos(angle), sin(angle))
            forearm = (centre[0] - x, centre[1] - y, centre[2] - z)
            motion = arm.motion(angle, forearm, velocity, acceleration)
            if motion is None:
                return None
            forearms.append(forearm)
            found.append(motion)
        return found if self._works(forearms) else None

    def _angles(self, centre: Vector) -> list[float] | None:
        found: list[float] = []
        for arm in self.arms:
            angle = arm.angle(*centre)
            if angle is None:
                return None
            found.append(angle)
        return found

    def _centre(self, tip: Vector) -> Vector | None:
        """The effector's centre, or None where none of this kind can be."""
        tool = self._tool
        return (tip[0] - tool[0], tip[1] - tool[1], tip[2] - tool[2])

    def _meet(self, elbows: Sequence[Vector]) -> Vector | None:
        """P of the working assembly."""
        raise NotImplementedError

    def _works(self, forearms: Sequence[Vector]) -> bool:
        """Whether these, which do meet, do so in the working assembly."""
        raise NotImplementedError
