"""The guard alone: good knots pass, each kind of bad knot is caught, whoever made it."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from deltaviz.machine import intent as i
from deltaviz.machine.creep import Creep
from deltaviz.machine.drive import FollowerMaker
from deltaviz.machine.guard import FURTHEST, Guard
from deltaviz.machine.mode import Mode
from deltaviz.motion import Follower
from deltaviz.motion.goal import AtJointVelocity, AtVelocity, Goal, ToPoint
from deltaviz.motion.knot import Knot
from deltaviz.robots import Robot

ME = "me"
PERIOD = 0.010


def moving_knots(robot: Robot, count: int = 20) -> list[Knot]:
    follower = Follower(robot, robot.homing.ready, period=PERIOD, clock=lambda: 0.0)
    return [follower.step(AtVelocity((300.0, 0.0, 0.0))) for _ in range(count)]


def test_what_the_follower_makes_passes(stm32: Robot) -> None:
    guard = Guard(stm32, stm32.homing.ready, homed=True)
    for knot in moving_knots(stm32, 200):
        assert guard.refusal(knot) is None


def test_a_refused_knot_changes_nothing(stm32: Robot) -> None:
    guard = Guard(stm32, stm32.homing.ready, homed=True)
    knots = moving_knots(stm32)
    assert guard.refusal(knots[0]) is None
    assert guard.refusal(replace(knots[1], theta=(math.nan,) * 3))
    assert guard.refusal(knots[1]) is None


def spoiled(knot: Knot, what: str) -> Knot:
    theta, velocity = list(knot.theta), list(knot.velocity)
    match what:
        case "nan angle":
            theta[1] = math.nan
        case "infinite velocity":
            velocity[0] = math.inf
        case "nan duration":
            return replace(knot, duration=math.nan)
        case "no time":
            return replace(knot, duration=0.0)
        case "too short":
            return replace(knot, duration=0.003)
        case "too long":
            return replace(knot, duration=0.051)
        case "too few joints":
            return replace(knot, theta=knot.theta[:2])
        case "a jump":
            theta[2] += 0.05
        case "too fast":
            velocity[0] = 6.2
        case "a velocity that does not fit":
            velocity[0] += 0.5
        case _:
            raise AssertionError(what)
    return replace(knot, theta=tuple(theta), velocity=tuple(velocity))


BAD = {
    "nan angle": "not finite",
    "infinite velocity": "not finite",
    "nan duration": "not finite",
    "no time": "segment of 0 ms",
    "too short": "segment of 3 ms",
    "too long": "segment of 51 ms",
    "too few joints": "2 joints",
    "a jump": "above",
    "too fast": "above",
    "a velocity that does not fit": "accelerating",
}


@pytest.mark.parametrize("what", BAD)
def test_a_bad_knot_is_refused_with_its_reason(stm32: Robot, what: str) -> None:
    guard = Guard(stm32, stm32.homing.ready, homed=True)
    knots = moving_knots(stm32)
    for knot in knots[:-1]:
        assert guard.refusal(knot) is None
    assert BAD[what] in str(guard.refusal(spoiled(knots[-1], what)))


def creep_to(robot: Robot, target_deg: Sequence[float]) -> str | None:
    """Slow straight joint motion from the ready pose, which no speed limit objects to."""
    start = np.array(robot.homing.ready)
    guard = Guard(robot, robot.homing.ready, homed=True)
    way = np.radians(target_deg) - start
    seconds = float(np.abs(way).max()) / 0.5
    count = round(seconds / PERIOD)
    for k in range(1, count + 1):
        share = k / count
        smooth, rate = 3 * share**2 - 2 * share**3, (6 * share - 6 * share**2) / seconds
        knot = Knot(PERIOD, tuple(start + way * smooth), tuple(way * rate))
        refused = guard.refusal(knot)
        if refused is not None:
            return refused
    return None


def lowered_by(robot: Robot, speed: float) -> float:
    """Lowers the tip so slowly (mm/s) that no knot goes further than the guard's slack; how far
    below the zone's floor it gets within 5 s."""
    floor = robot.zone.z[0]
    start = np.array([0.0, 0.0, floor + 0.05])
    theta = robot.inverse(start)
    guard = Guard(robot, tuple(theta), homed=True)
    for k in range(1, 501):
        now = min(speed, speed * k / 50)
        start[2] -= now * PERIOD
        theta = robot.inverse(start)
        rate = np.linalg.solve(robot.mechanism.jacobian(theta), (0.0, 0.0, -now))
        if guard.refusal(Knot(PERIOD, tuple(theta), tuple(rate))) is not None:
            break
    return float(floor - start[2])


def test_knots_cannot_creep_out_by_the_slack_of_each(stm32: Robot) -> None:
    assert lowered_by(stm32, 1.0) < 0.05


def test_a_start_outside_is_judged_by_the_way_in_that_it_has_come(stm32: Robot) -> None:
    """Inwards from 1 mm below the floor, and out again: only so far as it is by then."""
    floor = stm32.zone.z[0]

    def knot(z: float) -> Knot:
        return Knot(0.05, tuple(stm32.inverse([0.0, 0.0, z])), (0.0, 0.0, 0.0))

    def guard() -> Guard:
        return Guard(stm32, tuple(stm32.inverse([0.0, 0.0, floor - 1.0])), homed=True)

    assert guard().refusal(knot(floor - 1.1)) is not None
    inwards = guard()
    assert inwards.refusal(knot(floor - 0.5)) is None
    assert inwards.refusal(knot(floor - 0.6)) is not None
    assert inwards.refusal(knot(floor - 0.5)) is None


def test_a_legal_way_passes(stm32: Robot) -> None:
    assert creep_to(stm32, [20, 20, 20]) is None


@pytest.mark.parametrize(
    ("target", "limit"),
    [
        ((-50, -50, -50), "joint limit|workspace"),
        ((80, 80, 80), "workspace|joint limit"),
        ((90, -40, -40), "arm|workspace|singularity|change over"),
    ],
)
def test_a_way_out_of_the_limits_is_refused(
    stm32: Robot, target: tuple[float, ...], limit: str
) -> None:
    refused = creep_to(stm32, target)
    assert refused is not None
    assert re.search(limit, refused)


@pytest.mark.parametrize(
    ("name", "target", "limit"),
    [
        ("fivebar", (30, 40), None),
        ("fivebar", (-50, -50), "joint limit|workspace"),
        ("fivebar", (80, 80), "lower end of the workspace"),
        ("stm32-tool", (0, 0, 0, 170), None),
        ("stm32-tool", (0, 0, 0, 176), "upper limit of the tool's turn"),
        ("stm32-tool", (0, 0, 0, -176), "lower limit of the tool's turn"),
    ],
)
def test_ways_of_other_robots(
    named_robot: Callable[[str], Robot], name: str, target: tuple[float, ...], limit: str | None
) -> None:
    refused = creep_to(named_robot(name), target)
    assert (refused is None) == (limit is None)
    assert re.search(limit or "", refused or "")


def test_a_brake_that_would_turn_the_tool_too_far_is_refused(
    named_robot: Callable[[str], Robot],
) -> None:
    robot = named_robot("stm32-tool")
    start = np.append(np.zeros(3), robot.joints.max[3] - 0.45)
    guard = Guard(robot, tuple(start), homed=True)
    rate, refused = 0.0, None
    while refused is None:
        start[3] += PERIOD * (rate + 0.6)
        rate += 1.2
        assert start[3] < robot.joints.max[3]
        refused = guard.refusal(Knot(PERIOD, tuple(start), (0.0, 0.0, 0.0, rate)))
    assert refused == "a brake that breaks upper limit of the tool's turn"


def test_a_pose_on_the_other_branch_is_refused(stm32: Robot) -> None:
    """The guard's own comparison, since no lawful way leads there."""
    guard = Guard(stm32, stm32.homing.ready, homed=True)
    kernel = stm32.kernel

    class Mirrored:
        forward = staticmethod(kernel.forward)
        margins = staticmethod(lambda xyz, theta: np.ones((len(xyz), len(stm32.margin_names))))
        inverse = staticmethod(lambda xyz: kernel.inverse(xyz) + 1e-3)

    object.__setattr__(guard, "_robot", _With(stm32, Mirrored()))
    assert "change over" in str(guard.refusal(moving_knots(stm32)[0]))


class _With:
    def __init__(self, robot: Robot, kernel: object) -> None:
        self.kernel = kernel
        self.margin_names = robot.margin_names


def test_a_state_from_which_no_brake_fits_is_refused(stm32: Robot) -> None:
    """Every pose on the way is legal; only where the brake leads is not."""
    guard = Guard(stm32, stm32.homing.ready, homed=True)
    theta, rate, refused, legal = np.zeros(3), 0.0, None, False
    while refused is None:
        push = max(-70.0 * PERIOD, -5.0 - rate)  # arms up, to 5 rad/s
        theta = theta + PERIOD * (rate + push / 2)
        rate += push
        legal = stm32.reach(stm32.forward(theta)).legal
        refused = guard.refusal(Knot(PERIOD, tuple(theta), (rate,) * 3))
    assert "brake" in refused
    assert legal


def test_an_unhomed_robot_turns_no_further_than_a_knot_can_say(stm32: Robot) -> None:
    """With a high gear that is less than a turn. Back it may come."""
    per_rad = stm32.drive.microsteps_per_rad
    furthest = FURTHEST / per_rad[0]
    theta = (furthest - 0.001, 0.0, 0.0)
    guard = Guard(stm32, theta, homed=False)
    creep = Creep(stm32, theta, period=0.010)
    out, back = AtJointVelocity((0.05, 0.0, 0.0)), AtJointVelocity((-0.05, 0.0, 0.0))
    refusals = [guard.refusal(creep.step(out)) for _ in range(10)]
    assert refusals[0] is None
    assert "too far" in str(refusals[-1])
    beyond = (furthest + 0.001, 0.0, 0.0)
    guard, creep = Guard(stm32, beyond, homed=False), Creep(stm32, beyond, period=0.010)
    assert guard.refusal(creep.step(back)) is None


def test_unhomed_only_speed_counts(stm32: Robot) -> None:
    guard = Guard(stm32, (5.0, 5.0, 5.0), homed=False)
    slow = stm32.limits.joint.unhomed_velocity[0] * 0.9
    assert (
        guard.refusal(Knot(PERIOD, (5.0 + slow * PERIOD / 2, 5.0, 5.0), (slow, 0.0, 0.0))) is None
    )
    assert "above" in str(
        guard.refusal(Knot(PERIOD, (5.0 + slow * 3 * PERIOD, 5.0, 5.0), (slow * 3, 0.0, 0.0)))
    )


@pytest.mark.parametrize("homed", [True, False])
@pytest.mark.parametrize(
    ("check", "what"),
    [("_malformed", "nan angle"), ("_too_fast", "a jump"), ("_illegal", "out of the workspace")],
)
def test_without_a_check_the_bad_knot_would_pass(
    stm32: Robot, monkeypatch: pytest.MonkeyPatch, check: str, what: str, homed: bool
) -> None:
    """Each check is needed: remove it, and what it catches goes through."""
    monkeypatch.setattr(Guard, check, lambda *_: None)
    if what == "out of the workspace":
        assert creep_to(stm32, [-50, -50, -50]) is None
        return
    guard = Guard(stm32, stm32.homing.ready, homed=homed)
    knot = spoiled(Knot(PERIOD, stm32.homing.ready, (0.0,) * 3), what)
    if what == "nan angle" and homed:
        monkeypatch.setattr(Guard, "_illegal", lambda *_: None)
    assert guard.refusal(knot) is None


class Buggy:
    """A follower that is right until its knots are spoiled."""

    def __init__(self, good: Any, what: str) -> None:
        self._good = good
        self._what = what
        self._knots = 0

    def __getattr__(self, name: str) -> Any:
        return getattr(self._good, name)

    def step(self, goal: Goal, *, override: float = 1.0) -> Knot:
        knot = self._good.step(goal, override=override)
        self._knots += 1
        return spoiled(knot, self._what) if self._knots > 12 else knot


@pytest.mark.parametrize("what", BAD)
def test_a_bug_in_the_follower_stops_the_robot_and_is_never_sent(
    make_bench: Callable[..., Any], make_follower: FollowerMaker, what: str
) -> None:
    bench = make_bench(follower=lambda robot, theta: Buggy(make_follower(robot, theta), what))
    xyz = bench.snapshot.xyz
    assert xyz is not None
    bench.do(i.MoveToPoint(ME, (xyz[0] + 60, xyz[1], xyz[2]), 1.0))
    bench.run(0.06)
    bench.run_to_rest()
    assert bench.mode is Mode.IDLE
    assert str(bench.snapshot.stop_reason).startswith("The guard refused ")
    assert len(bench.segments()) == 12
    assert all(np.isfinite((*s.p, *s.v)).all() for s in bench.segments())
    bench.check_limits()


def test_goals_reach_the_follower_unchanged(make_bench: Callable[..., Any]) -> None:
    bench = make_bench()
    xyz = bench.snapshot.xyz
    assert xyz is not None
    target = (xyz[0] + 10.0, xyz[1], xyz[2])
    bench.do(i.MoveToPoint(ME, target, 0.5))
    activity = bench.controller._activity
    assert activity is not None
    assert activity.goal == ToPoint(target, speed=0.5, slide=False)
