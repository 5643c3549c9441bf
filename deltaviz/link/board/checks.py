"""The board guards itself: what it thinks of a segment, whatever the host thought.

Judged are exactly the motions that would run: the cubic (its end accelerations, its velocity and
position extrema), the brake from its end, and the tool tip at the middle and the end of both.
Slack: what rounding to the units of the messages can add, a thousandth of each limit, one
microstep, and a tenth of a millimetre. Where the motion starts outside a limit, it may not lead
further out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import hypot, sqrt

from deltaviz.link.board.parameters import Parameters
from deltaviz.link.messages import Refusal

RELATIVE_SLACK = 1e-3
P_STEP = 2.0**-10  # microsteps: the unit of a knot's position
V_STEP = 1000 / 65536  # microsteps per second: the unit of a knot's velocity
A_STEP = 1e6 / 2**24  # microsteps per second²: the unit of a configured acceleration
TIP_SLACK = 0.1  # mm


@dataclass(frozen=True, slots=True)
class Objection:
    reason: Refusal
    joint: int | None = None


class JointCubic:
    """One joint's cubic in microsteps and seconds; the acceleration is linear in time."""

    __slots__ = ("a0", "a1", "p0", "p1", "seconds", "v0", "v1")

    def __init__(self, p0: float, p1: float, v0: float, v1: float, seconds: float) -> None:
        mean = 6 * (p1 - p0) / (seconds * seconds)
        self.p0, self.p1, self.v0, self.v1, self.seconds = p0, p1, v0, v1, seconds
        self.a0 = mean - (4 * v0 + 2 * v1) / seconds
        self.a1 = (2 * v0 + 4 * v1) / seconds - mean

    @property
    def top_acceleration(self) -> float:
        return max(abs(self.a0), abs(self.a1))

    @property
    def top_speed(self) -> float:
        top = max(abs(self.v0), abs(self.v1))
        if self.a0 * self.a1 < 0:
            top = max(
                top, abs(self.v0 + self.a0 * self.seconds * self.a0 / (self.a0 - self.a1) / 2)
            )
        return top

    def position(self, t: float) -> float:
        a0 = self.a0
        return self.p0 + t * (self.v0 + t * (a0 / 2 + t * (self.a1 - a0) / (6 * self.seconds)))

    def stays_within(self, low: float, high: float) -> bool:
        third = self.seconds / 3
        hull = (self.p0, self.p0 + self.v0 * third, self.p1 - self.v1 * third, self.p1)
        if low <= min(hull) and max(hull) <= high:
            return True
        points = [self.p0, self.p1, *map(self.position, self._turning_points())]
        return low <= min(points) and max(points) <= high

    def _turning_points(self) -> list[float]:
        a0, v0 = self.a0, self.v0
        curve = (self.a1 - a0) / (2 * self.seconds)
        inside = a0 * a0 - 4 * curve * v0
        if inside < 0:
            return []
        # The two roots without cancellation; either divisor may vanish.
        q = -(a0 + (sqrt(inside) if a0 >= 0 else -sqrt(inside))) / 2
        roots = ([q / curve] if curve else []) + ([v0 / q] if q else [])
        return [root for root in roots if 0 < root < self.seconds]


class Checks:
    def __init__(self, parameters: Parameters, *, tick_hz: int) -> None:
        self._forward = parameters.forward
        self._tick_hz = tick_hz
        configure = parameters.configure
        self._configure = configure
        self._per_rad = configure.microsteps_per_rad
        self._low = [limit * P_STEP - 1 for limit in configure.joint_min]
        self._high = [limit * P_STEP + 1 for limit in configure.joint_max]
        self._velocity = [limit * V_STEP for limit in configure.velocity]
        self._unhomed = [
            min(unhomed * V_STEP, limit)
            for unhomed, limit in zip(configure.unhomed_velocity, self._velocity, strict=True)
        ]
        self._acceleration = [limit * A_STEP for limit in configure.acceleration]

    def objection(
        self,
        *,
        p0: Sequence[int],
        v0: Sequence[int],
        p1: Sequence[int],
        v1: Sequence[int],
        ticks: int,
        homed: bool,
    ) -> Objection | None:
        """What is wrong with the cubic between two knots (units of the messages), if anything."""
        seconds = ticks / self._tick_hz
        cubics = [
            JointCubic(a * P_STEP, b * P_STEP, u * V_STEP, v * V_STEP, seconds)
            for a, b, u, v in zip(p0, p1, v0, v1, strict=True)
        ]
        objection = self._speed_objection(cubics, homed=homed)
        if objection is not None or not homed:
            return objection
        brake = self._brake_ends(cubics)
        return self._joint_objection(cubics, brake) or self._workspace_objection(cubics, brake)

    def _speed_objection(self, cubics: Sequence[JointCubic], *, homed: bool) -> Objection | None:
        h = cubics[0].seconds
        a_slack = 6 * P_STEP / (h * h) + 3 * V_STEP / h
        v_slack = 1.5 * P_STEP / h + V_STEP
        top = self._velocity if homed else self._unhomed
        grace = 1 + RELATIVE_SLACK
        for joint, cubic in enumerate(cubics):
            if cubic.top_acceleration > self._acceleration[joint] * grace + a_slack:
                return Objection(Refusal.ACCELERATION, joint)
            if cubic.top_speed > top[joint] * grace + v_slack:
                return Objection(Refusal.VELOCITY if homed else Refusal.UNHOMED_SPEED, joint)
        return None

    def _brake_ends(self, cubics: Sequence[JointCubic]) -> list[float]:
        """Where the brake from the last knot ends."""
        time = max(abs(c.v1) / a for c, a in zip(cubics, self._acceleration, strict=True))
        return [c.p1 + c.v1 * time / 2 for c in cubics]

    def _joint_objection(
        self, cubics: Sequence[JointCubic], brake: Sequence[float]
    ) -> Objection | None:
        for joint, cubic in enumerate(cubics):
            low = min(self._low[joint], cubic.p0)
            high = max(self._high[joint], cubic.p0)
            if not cubic.stays_within(low, high):
                return Objection(Refusal.JOINT_LIMIT, joint)
            if not low <= brake[joint] <= high:
                return Objection(Refusal.BRAKE, joint)
        return None

    def _workspace_objection(
        self, cubics: Sequence[JointCubic], brake: Sequence[float]
    ) -> Objection | None:
        if self._forward is None:
            return None
        end = [c.p1 for c in cubics]
        middle = [c.position(c.seconds / 2) for c in cubics]
        halfway = [p + (q - p) * 0.75 for p, q in zip(end, brake, strict=True)]
        allowed: float | None = None
        for reason, pose in (
            (Refusal.WORKSPACE, middle),
            (Refusal.WORKSPACE, end),
            (Refusal.BRAKE, halfway),
            (Refusal.BRAKE, brake),
        ):
            outside = self._outside(pose)
            if outside <= TIP_SLACK:
                continue
            if allowed is None:
                allowed = self._outside([c.p0 for c in cubics])
            if outside > allowed + TIP_SLACK:
                return Objection(reason)
        return None

    def _outside(self, microsteps: Sequence[float]) -> float:
        """How far the tool tip is outside its workspace (mm); infinite where there is no tip."""
        assert self._forward is not None
        theta = [p / m for p, m in zip(microsteps, self._per_rad, strict=True)]
        tip = self._forward.tip(theta)
        if tip is None:
            return float("inf")
        configure = self._configure
        outside = 0.0
        ranges = (configure.workspace_x, configure.workspace_y, configure.workspace_z)
        for value, allowed in zip(tip, ranges, strict=True):
            outside = max(outside, allowed[0] - value, value - allowed[1])
        return max(outside, hypot(tip[0], tip[1]) - configure.workspace_radius)
