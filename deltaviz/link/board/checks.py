"""The board guards itself: what it thinks of a segment, whatever the host thought.

Judged are exactly the motions that would run: the cubic (its end accelerations, its velocity and
position extrema), the brake from its end, and the tool tip at the middle and the end of both.
Slack: what rounding to the units of the messages can add, a thousandth of each limit, one
microstep, and a tenth of a millimetre. Where an epoch began outside a limit, it may not lead
further out.
"""

from __future__ import annotations

from collections.abc import Sequence

from deltaviz.link.board.limits import (
    P_STEP,
    RELATIVE_SLACK,
    TIP_SLACK,
    V_STEP,
    Limits,
    Objection,
)
from deltaviz.link.board.real_cubic import RealCubic
from deltaviz.link.messages import Refusal


class Checks:
    def __init__(self, limits: Limits, *, tick_hz: int) -> None:
        self._limits = limits
        self._tick_hz = tick_hz

    def objection(
        self,
        *,
        p0: Sequence[int],
        v0: Sequence[int],
        p1: Sequence[int],
        v1: Sequence[int],
        ticks: int,
        homed: bool,
        outside: float,
    ) -> Objection | None:
        """What is wrong with the cubic between two knots (units of the messages), if anything.
        `outside` (mm): how far outside its workspace the tip may be (`Leeway`)."""
        seconds = ticks / self._tick_hz
        cubics = [
            RealCubic(a * P_STEP, b * P_STEP, u * V_STEP, v * V_STEP, seconds)
            for a, b, u, v in zip(p0, p1, v0, v1, strict=True)
        ]
        objection = self._speed_objection(cubics, homed=homed)
        if objection is not None or not homed:
            return objection
        brake = self._limits.brake_ends([c.p1 for c in cubics], [c.v1 for c in cubics])
        found = self._joint_objection(cubics, brake)
        return found or self._workspace_objection(cubics, brake, outside)

    def _speed_objection(self, cubics: Sequence[RealCubic], *, homed: bool) -> Objection | None:
        h = cubics[0].seconds
        a_slack = 6 * P_STEP / (h * h) + 3 * V_STEP / h
        v_slack = 1.5 * P_STEP / h + V_STEP
        limits = self._limits
        top = limits.velocity if homed else limits.unhomed
        grace = 1 + RELATIVE_SLACK
        for joint, cubic in enumerate(cubics):
            if cubic.top_acceleration > limits.acceleration[joint] * grace + a_slack:
                return Objection(Refusal.ACCELERATION, joint)
            if cubic.top_speed > top[joint] * grace + v_slack:
                return Objection(Refusal.VELOCITY if homed else Refusal.UNHOMED_SPEED, joint)
        return None

    def _joint_objection(
        self, cubics: Sequence[RealCubic], brake: Sequence[float]
    ) -> Objection | None:
        for joint, cubic in enumerate(cubics):
            low = min(self._limits.low[joint], cubic.p0)
            high = max(self._limits.high[joint], cubic.p0)
            if not cubic.stays_within(low, high):
                return Objection(Refusal.JOINT_LIMIT, joint)
            if not low <= brake[joint] <= high:
                return Objection(Refusal.BRAKE, joint)
        return None

    def _workspace_objection(
        self, cubics: Sequence[RealCubic], brake: Sequence[float], allowed: float
    ) -> Objection | None:
        limits = self._limits
        if limits.kinematics is None:
            return None
        end = [c.p1 for c in cubics]
        middle = [c.position(c.seconds / 2) for c in cubics]
        halfway = [p + (q - p) * 0.75 for p, q in zip(end, brake, strict=True)]
        for reason, pose in (
            (Refusal.WORKSPACE, middle),
            (Refusal.WORKSPACE, end),
            (Refusal.BRAKE, halfway),
            (Refusal.BRAKE, brake),
        ):
            if limits.outside_at(pose) > allowed + TIP_SLACK:
                return Objection(reason)
        return None
