"""The guard of Cartesian segments: what the board thinks of the joints' motion that follows.

The tip's cubic is looked at where it begins, where it ends, and at even times between, at most 2 ms
apart: there the joints' positions, speeds and accelerations are exact, between them they may be a
little beyond (tests/link/board/test_tip_checks.py says how much). The brake from the end is judged
as for joint segments. Slack: as there, what rounding to the units of the messages adds being a
matter of the pose.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import sqrt

from deltaviz.link.board.kinematics import JointMotion
from deltaviz.link.board.limits import P_STEP as JOINT_STEP
from deltaviz.link.board.limits import RELATIVE_SLACK, TIP_SLACK, Leeway, Limits, Objection
from deltaviz.link.board.queue import Knot
from deltaviz.link.board.tip import P_STEP, V_STEP
from deltaviz.link.board.tip_path import tip_axes, tip_state
from deltaviz.link.messages import Refusal

APART_MS = 2  # of two looks, at most


class TipChecks:
    """For a robot with arms."""

    def __init__(self, limits: Limits, *, tick_hz: int) -> None:
        assert limits.kinematics is not None
        self._limits = limits
        self._kinematics = limits.kinematics
        self._tick_hz = tick_hz

    def objection(self, start: Knot, end: Knot, ticks: int, *, leeway: Leeway) -> Objection | None:
        """What is wrong with the way between two Cartesian knots, if anything."""
        h = ticks / self._tick_hz
        axes = tip_axes(start, end, h)
        looks = -(-ticks * 1000 // (APART_MS * self._tick_hz))
        allowed = leeway.outside + TIP_SLACK
        motions: list[JointMotion] | None = None
        for look in range(looks + 1):
            state = tip_state(axes, h * look / looks)
            motions = self._kinematics.motions(*state)
            if motions is None:
                return Objection(Refusal.WORKSPACE)
            found = self._joint_objection(motions, leeway, h)
            if found is not None:
                return found
            if self._limits.outside(state[0]) > allowed:
                return Objection(Refusal.WORKSPACE)
        assert motions is not None
        return self._brake_objection(motions, leeway)

    def _joint_objection(
        self, motions: Sequence[JointMotion], leeway: Leeway, h: float
    ) -> Objection | None:
        a_rounding = sqrt(3) * (6 * P_STEP / (h * h) + 3 * V_STEP / h)
        v_rounding = sqrt(3) * (1.5 * P_STEP / h + V_STEP)
        limits, grace = self._limits, 1 + RELATIVE_SLACK
        for joint, motion in enumerate(motions):
            m = limits.per_rad[joint]
            most = limits.acceleration[joint] * grace + m * motion.gain * a_rounding
            if abs(motion.acceleration) * m > most:
                return Objection(Refusal.ACCELERATION, joint)
            most = limits.velocity[joint] * grace + m * motion.gain * v_rounding
            if abs(motion.rate) * m > most:
                return Objection(Refusal.VELOCITY, joint)
            if not self._within(joint, motion.angle * m, leeway):
                return Objection(Refusal.JOINT_LIMIT, joint)
        return None

    def _brake_objection(self, last: Sequence[JointMotion], leeway: Leeway) -> Objection | None:
        per_rad = self._limits.per_rad
        end = [motion.angle * m for motion, m in zip(last, per_rad, strict=False)]
        speeds = [motion.rate * m for motion, m in zip(last, per_rad, strict=False)]
        brake = self._limits.brake_ends(end, speeds)
        for joint, position in enumerate(brake):
            if not self._within(joint, position, leeway):
                return Objection(Refusal.BRAKE, joint)
        halfway = [p + (q - p) * 0.75 for p, q in zip(end, brake, strict=True)]
        far = max(self._limits.outside_at(halfway), self._limits.outside_at(brake))
        if far > leeway.outside + TIP_SLACK:
            return Objection(Refusal.BRAKE)
        return None

    def _within(self, joint: int, position: float, leeway: Leeway) -> bool:
        """With a microstep of slack, as the limits have it: a knot of the tip is rounded, too."""
        began = leeway.began[joint] * JOINT_STEP
        low, high = self._limits.low[joint], self._limits.high[joint]
        return min(low, began - 1) <= position <= max(high, began + 1)
