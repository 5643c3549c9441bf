"""From a way to a plan that has passed the check: slower and slower, within a time budget."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from deltaviz.motion.check import Checker, Fault, Verdict
from deltaviz.motion.followed import Array, Followed
from deltaviz.motion.plan import Plan
from deltaviz.motion.shaping import Shaper, Shares, Way
from deltaviz.motion.space import CartesianSpace, JointSpace, Space

TRIES = 5  # of one tick, over all ways
AIM = 0.985  # of a limit: where a slower try should end up
RESERVE = 0.997  # of the joints' limits: the rest is for rounding to the board's numbers
TIP_RESERVE = 0.9985  # of the tip's: the rest is for what lies between the knots
RECOVERY = 1.3  # how much of what was given up is asked for again at the next plan
PLAN_AHEAD = 2.0  # s of steady motion
MOST_KNOTS = 400  # of one plan: what asks for more has been slowed down in vain
SLOWEST = 0.02  # share of the limits below which it begins anew
NUDGE = 0.98  # to where ruckig may find a solution after all
BRAKE_SLOWER = 0.6  # a brake that leaves the legal region: go slower by this


class Planner:
    """Plans from a state, remembering how much had to be given up last time."""

    def __init__(
        self, robot: Followed, spaces: tuple[Space, Space], *, period: float,
        clock: Callable[[], float], budget: float,
    ) -> None:  # fmt: skip
        joint, tip = robot.limits.joint, robot.limits.cartesian
        self.check = Checker(
            robot.kernel,
            velocity=np.asarray(joint.velocity, dtype=float) * RESERVE,
            acceleration=np.asarray(joint.acceleration, dtype=float) * RESERVE,
            tip_axes=len(robot.axes),
            tip_velocity=tip.velocity * TIP_RESERVE,
            tip_acceleration=tip.acceleration * TIP_RESERVE,
        )
        self._shapers = {space: Shaper(space, period) for space in spaces}
        self._period = period
        self._clock = clock
        self._budget = budget
        self._began = 0.0
        self._ends = 0.0
        self._tries = 0
        self.velocity: float = 1.0  # shares of the limits that the last plan was made with
        self.acceleration: float = 1.0
        self.refused: Verdict | None = None  # why the last way was not taken

    def begin(self) -> None:
        """A tick begins: its budget of time and tries is whole."""
        self._ends = self._clock() + self._budget
        self._tries = 0
        self.refused = None

    def forget(self) -> None:
        """As if nothing had been planned: the full limits come first again."""
        self.velocity = self.acceleration = 1.0
        self.refused = None

    @property
    def eased(self) -> bool:
        """Whether the last plan is slower than its limits would allow elsewhere."""
        return self.velocity < 1.0 or self.acceleration < 1.0

    def __call__(self, space: Space, plan: Plan, at: int, way: Way) -> Plan | None:
        """A plan along `way` from row `at` of `plan` (of the same space), or None.

        A way that takes long is planned in part: the plan then ends on it, not at its end.
        """
        velocity = min(1.0, self.velocity * RECOVERY)
        acceleration = min(1.0, self.acceleration * RECOVERY)
        q, v, a = plan.q[at], plan.v[at], plan.a[at]
        before = self._tries
        while self._may_try():
            part = way.within(PLAN_AHEAD * velocity)
            rows = self._shapers[space](q, v, a, part, Shares(velocity, acceleration))
            if rows is None:  # a gap in ruckig's solutions: they are small
                velocity *= NUDGE
                continue
            if len(rows[0]) > MOST_KNOTS:
                velocity = acceleration = 0.0
                break
            made = self._with_joints(space, plan, at, rows)
            if made is None:
                return None
            verdict = self.check(made.theta, made.rate, made.pose, made.segment)
            if verdict.fault is Fault.PATH:
                self.refused = verdict
                return None
            if verdict.velocity <= 1.0 and verdict.acceleration <= 1.0:
                if verdict.fault is Fault.NONE:
                    self.velocity, self.acceleration = velocity, acceleration
                    return made
                self.refused = verdict
                velocity *= BRAKE_SLOWER
                continue
            if verdict.velocity > 1.0:
                velocity *= AIM / verdict.velocity
            if verdict.acceleration > 1.0:
                share = max(0.1, AIM / verdict.acceleration)
                acceleration *= share
                # Part of it comes from turning fast, which only a lower speed helps.
                velocity *= math.sqrt(share) if self._tries > 1 else 1.0
        if min(velocity, acceleration) < SLOWEST:
            self.velocity = self.acceleration = 1.0
        elif self._tries > before:  # the next tick goes on from here
            self.velocity, self.acceleration = velocity / RECOVERY, acceleration / RECOVERY
        return None

    def _may_try(self) -> bool:
        """Whether there is a try left, and time for one that takes as long as the last."""
        now = self._clock()
        last = now - self._began if self._tries > 0 else 0.0
        if self._tries >= TRIES or now + last >= self._ends:
            return False
        self._began = now
        self._tries += 1
        return True

    def _with_joints(
        self, space: Space, plan: Plan, at: int, rows: tuple[Array, Array, Array]
    ) -> Plan | None:
        q, v, a = rows
        theta, rate, pose = space.knots(q, v)
        if not np.isfinite(rate).all():
            return None
        theta[0], rate[0] = plan.theta[at], plan.rate[at]
        return Plan(space, theta, rate, pose, q, v, a, self._period)

    def in_space(self, plan: Plan, at: int, space: CartesianSpace | JointSpace) -> Plan:
        """The state in row `at` of `plan` as a plan of one row in another space."""
        theta, rate = plan.theta[at], plan.rate[at]
        joints = plan.space.joints(theta, rate, plan.a[at])
        q, v, a = space.state(theta, rate, joints)
        rows = (theta[None], rate[None], plan.pose[at][None], q[None], v[None], a[None])
        return Plan(space, *rows, self._period)
