"""The pull of the board: one knot whenever it has less than the horizon left to run."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Protocol, cast

from deltaviz.link.session import Session
from deltaviz.machine.creep import Creep
from deltaviz.machine.guard import Guard
from deltaviz.motion import Follower
from deltaviz.motion.goal import AtJointVelocity, AtVelocity, Goal, Rest, ToAngles, ToPoint
from deltaviz.motion.held import Held
from deltaviz.motion.knot import Knot
from deltaviz.robots import Robot

PERIOD = 0.010  # s of board time in one knot


class Follows(Protocol):
    """What makes the knots: the follower, or its stand-in while the pose is unknown."""

    @property
    def theta(self) -> Sequence[float]: ...
    @property
    def xyz(self) -> Sequence[float]: ...
    @property
    def velocity(self) -> Sequence[float]: ...
    @property
    def resting(self) -> bool: ...
    @property
    def held_by(self) -> tuple[Held, ...]: ...
    @property
    def target_xyz(self) -> Sequence[float]: ...
    @property
    def target_theta(self) -> Sequence[float]: ...

    def step(self, goal: Goal, *, override: float = 1.0) -> Knot: ...


FollowerMaker = Callable[[Robot, Sequence[float]], Follows]


def make_follower(robot: Robot, theta: Sequence[float]) -> Follows:
    follower = Follower(robot, theta, period=PERIOD)
    return cast("Follows", follower)  # its arrays are sequences of floats


def warm_up(robot: Robot) -> None:
    """Run through what the control loop runs, so that no first motion waits for a compiler."""
    robot.kernel.warm_up()
    ready = robot.homing.ready
    follower, guard = make_follower(robot, ready), Guard(robot, ready, homed=True)
    still, moves = (0.0,) * len(robot.axes), (1.0,) * len(robot.axes)
    for goal in (
        AtVelocity(moves),
        AtJointVelocity((1.0,) * robot.joint_count),
        ToPoint(tuple(v + 1.0 for v in follower.xyz)),
        ToAngles(ready),
        AtVelocity(still),
        Rest(),
    ):
        for _ in range(3):
            guard.refusal(follower.step(goal))
            _ = follower.held_by


class Drive:
    """One epoch's motion: follower, guard, session. Made when a person begins to move."""

    def __init__(
        self, robot: Robot, session: Session, *, homed: bool, follower: FollowerMaker
    ) -> None:
        theta = session.theta or ()
        self.follower = follower(robot, theta) if homed else Creep(robot, theta, period=PERIOD)
        self.homed = homed
        self.still = 0  # knots in a row that did not move
        self._session = session
        self._guard = Guard(robot, theta, homed=homed)
        self._goal: Goal | None = None
        self._retry = float("-inf")
        session.begin()  # last, as what comes before takes time, and an arming must be fresh

    def pull(self, goal: Goal, *, override: float, horizon: float, now: float) -> str | None:
        """Send one knot towards `goal`, if the board has less than `horizon` (s) left to run.
        What the guard refused, or None.

        At rest nothing is queued, so that the next motion starts at once.
        """
        if goal != self._goal:
            self._goal = goal
            self.still = 0
        elif self.still and now < self._retry:
            return None
        if not self._session.wants_knot(now, horizon=horizon):
            return None
        before = tuple(self.follower.theta)
        knot = self.follower.step(goal, override=override)
        if not any(knot.velocity) and knot.theta == before and self.follower.resting:
            self.still += 1
            self._retry = now + PERIOD
            return None
        self.still = 0
        refusal = self._guard.refusal(knot)
        if refusal is None:
            self._session.segment(knot, now)
        return refusal

    def hungry(self, now: float, *, horizon: float) -> bool:
        """Whether another knot is due at once."""
        return not self.still and self._session.wants_knot(now, horizon=horizon)
