"""The online follower: one knot per call, towards a goal that may change at any call.

It always holds a committed plan that ends at rest and has passed the check. A new plan takes its
place only when it has passed too; otherwise, or when time runs out, the committed plan goes on.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from deltaviz.motion.brake import brake_plan
from deltaviz.motion.dynamics import brake_time
from deltaviz.motion.followed import Array, Followed
from deltaviz.motion.goal import AtJointVelocity, AtVelocity, Goal, Rest, ToAngles, ToPoint
from deltaviz.motion.held import Held
from deltaviz.motion.held_by import HeldBy
from deltaviz.motion.jogging import Jog
from deltaviz.motion.knot import Knot
from deltaviz.motion.plan import Plan
from deltaviz.motion.planner import Planner
from deltaviz.motion.seeking import Seeker
from deltaviz.motion.shaping import Way
from deltaviz.motion.space import CartesianSpace, JointSpace, Space

REFRESH = 8  # ticks after which a plan that could be better is made anew
PATIENCE = 64  # ticks; the longest pause between tries that all fail


class Follower:
    """Keeps one robot within its limits. Starts at rest at `theta` (n,) rad.

    `clock` (s) and `budget` (s) bound the time that one call spends on planning.
    """

    def __init__(
        self,
        robot: Followed,
        theta: ArrayLike,
        *,
        period: float = 0.010,
        clock: Callable[[], float] = time.perf_counter,
        budget: float = 0.004,
    ) -> None:
        self._robot = robot
        self._period = period
        self._tip = CartesianSpace(robot)
        self._turn = JointSpace(robot)
        self._planner = Planner(
            robot, (self._tip, self._turn), period=period, clock=clock, budget=budget
        )
        inside = _inside(robot, self._turn)
        pose = robot.kernel.forward(inside[None, :])[0]
        self._seekers = {
            self._tip: Seeker(self._tip, pose),
            self._turn: Seeker(self._turn, inside),
        }
        self._jogs = {space: Jog(space) for space in (self._tip, self._turn)}
        self._held_by = HeldBy(robot)
        self._warm_up(inside, pose)
        start = np.array(theta, dtype=float)
        if start.shape != (robot.joint_count,) or not np.isfinite(start).all():
            raise ValueError(f"theta is {theta}; it must be {robot.joint_count} finite angles")
        self._plan = self._standing(start)
        self._at = 0
        self._goal: Goal = Rest()
        self._override = 1.0
        self._settled = True  # the committed plan is all there is to do
        self._wait = 0  # ticks until planning is tried again
        self._failures = 0
        self._held = False  # a limit keeps the goal from being met
        self._aim = start, self._plan.pose[0]

    def _warm_up(self, inside: Array, pose: Array) -> None:
        """Compiles everything now, so that no call stalls."""
        self._robot.kernel.warm_up()
        state = self._standing(inside)
        for space, q in ((self._turn, inside), (self._tip, pose)):
            state = self._planner.in_space(state, 0, space)
            self._seekers[space].retarget(q + 1e3 * space.unit, q, slide=True)
            way = Way(np.full(space.axes, 0.1 * space.unit), space.top)
            self._planner.begin()
            self._planner(space, state, 0, way)
            self._seekers[space].forget()
        self._planner.forget()

    # What it is doing.

    @property
    def theta(self) -> Array:
        """Angles (n,) of the last knot, rad."""
        return self._plan.theta[self._at]

    @property
    def velocity(self) -> Array:
        """Joint velocities (n,) of the last knot, rad/s."""
        return self._plan.rate[self._at]

    @property
    def xyz(self) -> Array:
        """The tool tip (d,) at the last knot, mm."""
        return self._plan.pose[self._at][: self._tip.tip_axes]

    @property
    def resting(self) -> bool:
        """Whether the committed plan has come to its end."""
        return self._at == self._plan.last

    @property
    def braking(self) -> bool:
        """Whether the last segment was the brake's, which no Cartesian limit binds."""
        return self._plan.braking

    @property
    def target_theta(self) -> Array:
        """The angles (n,) that are followed now; NaN where no angles reach the target."""
        return self._aim[0]

    @property
    def target_xyz(self) -> Array:
        """The tool tip position (d,) that is followed now."""
        return self._aim[1][: self._tip.tip_axes]

    @property
    def held_by(self) -> tuple[Held, ...]:
        """The limits that keep the goal from being met; empty while none does."""
        if not self._held:
            return ()
        return self._held_by(self._plan.pose[self._at], self._wanted_direction())

    # One period.

    def step(self, goal: Goal, *, override: float = 1.0) -> Knot:
        """The next knot towards `goal`. Raises ValueError for a goal that is not finite.

        `override` (0 to 1.5) scales velocities, up to the limits; at 0 the robot comes to rest
        and waits.
        """
        self._planner.begin()
        if goal != self._goal or override != self._override:
            self._accept(goal, override)
        if not self._settled:
            self._replan()
        return self._advance()

    def _accept(self, goal: Goal, override: float) -> None:
        self._check(goal)
        if not 0.0 <= override <= 1.5:
            raise ValueError(f"override is {override}; it must be from 0 to 1.5")
        moved = _what(goal) != _what(self._goal)
        self._goal, self._override = goal, override
        self._settled, self._wait, self._failures = False, 0, 0
        self._held = False
        if self.resting:
            self._planner.forget()
        if not moved:
            return
        self._aim = self._aimed_at(goal)
        space = self._space_of(goal)
        if isinstance(goal, (ToPoint, ToAngles)):
            q = self._in(space).q[0]
            slide = not isinstance(goal, ToPoint) or goal.slide
            theta, pose = self._aim
            target = pose if space is self._tip else theta
            self._seekers[space].retarget(target, q, slide=slide)

    def _check(self, goal: Goal) -> None:
        values = _values(goal)
        count = 0 if isinstance(goal, Rest) else self._space_of(goal).axes
        if isinstance(goal, (ToPoint, AtVelocity)):
            count = self._tip.tip_axes
        if len(values) != count or not all(map(math.isfinite, values)):
            raise ValueError(f"{goal} must have {count} finite values")
        tool = goal.tool if isinstance(goal, ToPoint) else None
        if tool is not None and not (self._robot.tool_axis and math.isfinite(tool)):
            raise ValueError(f"{goal} turns a tool that does not turn, or to no angle")

    def _replan(self) -> None:
        goal = self._goal
        if isinstance(goal, (ToPoint, ToAngles)) and self._seekers[self._space_of(goal)].improve():
            self._wait = 0
        if self._wait > 0:
            self._wait -= 1
            return
        match goal:
            case Rest():
                self._brake()
            case _ if self._override == 0.0 or getattr(goal, "speed", 1.0) == 0.0:
                self._stop()
            case ToPoint() | ToAngles():
                self._seek(goal)
            case AtVelocity() | AtJointVelocity():
                self._jog(goal)

    def _brake(self) -> None:
        self._settled = True
        if not self.resting and not self._plan.braking:
            self._commit(brake_plan(self._turn, self.theta, self.velocity, self._period))

    def _stop(self) -> None:
        """To rest under the jerk limit; failing that, by the brake."""
        self._settled = True
        if self.resting or self._plan.braking:
            return
        space = self._plan.space
        plan = self._planner(space, self._plan, self._at, Way(None, space.top))
        if plan is None:
            self._brake()
        else:
            self._commit(plan)

    def _seek(self, goal: ToPoint | ToAngles) -> None:
        space = self._space_of(goal)
        seeker = self._seekers[space]
        state = self._in(space)
        slide = not isinstance(goal, ToPoint) or goal.slide
        if self.resting and seeker.is_at(state.q[0]):
            self._held = not seeker.exact
            self._settled = not seeker.searching
            return
        speed = space.top * min(1.0, goal.speed * self._override)
        for place, direct in seeker.places(state.q[0], slide=slide):
            if float(np.linalg.norm(place - state.q[0])) < 1e-6 * space.unit:
                continue
            plan = self._planner(space, state, 0, Way(place - state.q[0], speed))
            if plan is not None:
                self._commit(plan)
                self._failures = 0
                self._held = not (seeker.exact and direct)
                whole = float(np.linalg.norm(plan.q[-1] - place)) < 1e-6 * space.unit
                done = direct and whole and not self._planner.eased
                self._settled = done and not seeker.searching
                self._wait = REFRESH if direct else 0
                return
        self._failed()
        if self.resting and slide:
            seeker.stuck()

    def _jog(self, goal: AtVelocity | AtJointVelocity) -> None:
        space = self._space_of(goal)
        state = self._in(space)
        wanted = np.zeros(space.axes)
        wanted[: len(_values(goal))] = _values(goal)  # a tool that turns comes to rest
        wanted *= self._override / max(1.0, space.share(wanted) * self._override)
        ease = self._planner.acceleration
        way, held = self._jogs[space].way(state.q[0], state.v[0], wanted, ease=ease)
        if way.displacement is None and self.resting:
            self._held, self._settled = held, True
            return
        plan = self._planner(space, state, 0, way)
        if plan is None:
            self._failed()
            return
        self._commit(plan)
        self._failures = 0
        self._held = held
        self._settled = not wanted.any()
        self._wait = 0 if held else REFRESH

    def _failed(self) -> None:
        """Nothing legal was found in time: the committed plan goes on. At rest, try less often."""
        self._held = True
        if self.resting:
            self._failures += 1
            self._wait = min(PATIENCE, 2**self._failures)

    def _commit(self, plan: Plan) -> None:
        self._plan = plan
        self._at = 0

    def _advance(self) -> Knot:
        if self._at < self._plan.last:
            self._at += 1
            duration = self._plan.segment
        else:
            duration = self._period
        theta = self._plan.theta[self._at].tolist()
        return Knot(duration, tuple(theta), tuple(self._plan.rate[self._at].tolist()))

    # Helpers.

    def _space_of(self, goal: Goal) -> Space:
        return self._turn if isinstance(goal, (ToAngles, AtJointVelocity)) else self._tip

    def _in(self, space: Space) -> Plan:
        """The present state as a plan of one row in `space`."""
        if self._plan.space is space:
            at = slice(self._at, self._at + 1)
            plan = self._plan
            return Plan(
                space, plan.theta[at], plan.rate[at], plan.pose[at],
                plan.q[at], plan.v[at], plan.a[at], self._period,
            )  # fmt: skip
        return self._planner.in_space(self._plan, self._at, space)

    def _standing(self, theta: Array) -> Plan:
        theta = theta[None, :]
        still = np.zeros_like(theta)
        pose = self._robot.kernel.forward(np.ascontiguousarray(theta))
        return Plan(self._turn, theta, still, pose, theta, still, still, self._period)

    def _aimed_at(self, goal: Goal) -> tuple[Array, Array]:
        """Angles and pose of where the goal leads."""
        kernel = self._robot.kernel
        if isinstance(goal, ToPoint):
            tool = self._tool_at_rest() if goal.tool is None else goal.tool
            pose = self._robot.pose(np.array(goal.xyz, dtype=float), tool)
            return kernel.inverse(pose[None, :])[0], pose
        if isinstance(goal, ToAngles):
            theta = np.array([goal.theta], dtype=float)
            return theta[0], kernel.forward(theta)[0]
        return self._plan.theta[-1], self._plan.pose[-1]

    def _tool_at_rest(self) -> float:
        """The angle at which the brake, whose end is legal, would leave the tool."""
        seconds = brake_time(self.velocity, self._turn.acceleration)
        return float(self.theta[-1] + self.velocity[-1] * seconds / 2)

    def _wanted_direction(self) -> Array:
        """The direction (n,) in which the goal would have the pose go."""
        goal, pose = self._goal, self._plan.pose[self._at]
        match goal:
            case ToPoint():
                return self._aim[1] - pose
            case AtVelocity():
                return np.append(goal.xyz, np.zeros(len(pose) - len(goal.xyz)))
            case ToAngles():
                rate = np.array(goal.theta) - self.theta
            case AtJointVelocity():
                rate = np.array(goal.theta)
            case Rest():
                rate = np.zeros(self._robot.joint_count)
        kernel = self._robot.kernel
        return kernel.tip_velocity(pose[None, :], self.theta[None, :], rate[None, :])[0]


def _values(goal: Goal) -> tuple[float, ...]:
    match goal:
        case ToPoint() | AtVelocity():
            return goal.xyz
        case ToAngles() | AtJointVelocity():
            return goal.theta
        case Rest():
            return ()


def _what(goal: Goal) -> tuple[object, ...]:
    """What a goal asks for, whatever its speed."""
    return type(goal), _values(goal), goal.tool if isinstance(goal, ToPoint) else None


def _inside(robot: Followed, space: JointSpace) -> Array:
    """The pose furthest from all limits, of those with all joints at one share of their range."""
    low = np.asarray(robot.joints.min, dtype=float)
    high = np.asarray(robot.joints.max, dtype=float)
    poses = low + (high - low) * np.linspace(0.02, 0.98, 49)[:, None]
    return poses[int(np.argmax(space.margins(poses).min(axis=1)))]
