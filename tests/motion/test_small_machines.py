"""Machines of two and of four joints follow by the same code: linear ones, easy to judge."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest
from numpy.typing import ArrayLike, NDArray

from deltaviz.mechanism.bounds import ROUNDING, Bounds
from deltaviz.mechanism.margin import Margin
from deltaviz.motion.follower import Follower
from deltaviz.motion.goal import AtJointVelocity, AtVelocity, Goal, Rest, ToAngles, ToPoint
from deltaviz.robots import Robot, load_robot
from deltaviz.robots.robot import CartesianMotion, JointMotion, Joints, Limits, Zone

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Skewed:
    """xyz = matrix · theta: what every joint moves is a direction of its own."""

    matrix: tuple[tuple[float, ...], ...]

    @property
    def joints(self) -> int:
        return len(self.matrix)

    @property
    def axes(self) -> tuple[str, ...]:
        return ("X", "Y", "V", "Z") if self.joints == 4 else ("X", "Z")

    @property
    def margin_names(self) -> tuple[Margin, ...]:
        return ()

    @property
    def forearm(self) -> tuple[float, ...]:
        return (1.0,) * self.joints

    @property
    def joint_scale(self) -> tuple[float, ...]:
        return (100.0,) * self.joints

    def inverse(self, xyz: ArrayLike) -> Array:
        return np.linalg.solve(np.array(self.matrix), np.asarray(xyz, dtype=float)[..., None])[
            ..., 0
        ]

    def forward(self, theta: ArrayLike) -> Array:
        return np.asarray(theta, dtype=float) @ np.array(self.matrix).T

    def jacobian(self, theta: ArrayLike) -> Array:
        shape = np.shape(theta)[:-1]
        return np.broadcast_to(np.array(self.matrix), (*shape, self.joints, self.joints))

    def margins(self, xyz: ArrayLike, theta: ArrayLike) -> Array:
        return np.zeros((*np.shape(xyz)[:-1], 0))

    def nearest_angles(self, xyz: ArrayLike) -> Array:
        return self.inverse(xyz)

    def sideways(self, xyz: ArrayLike) -> Array:
        return np.zeros((*np.shape(xyz)[:-1], 0))

    def misses(self, xyz: ArrayLike) -> tuple[Array, Array]:
        return -np.ones(np.shape(xyz)), -np.ones(np.shape(xyz))

    def kernel(self, bounds: Bounds) -> SkewedKernel:
        return SkewedKernel(
            np.array(self.matrix), np.asarray(np.linalg.inv(self.matrix), dtype=np.float64), bounds
        )


@dataclass(frozen=True)
class SkewedKernel:
    matrix: Array
    back: Array
    bounds: Bounds

    def inverse(self, xyz: Array) -> Array:
        return np.ascontiguousarray(xyz @ self.back.T)

    def forward(self, theta: Array) -> Array:
        return np.ascontiguousarray(theta @ self.matrix.T)

    def margins(self, xyz: Array, theta: Array) -> Array:
        limits = self.bounds
        assert limits.z is not None
        low = 100 * (theta - np.array(limits.joint_min))
        high = 100 * (np.array(limits.joint_max) - theta)
        box = np.stack([xyz[:, -1] - limits.z[0], limits.z[1] - xyz[:, -1]], axis=-1)
        return np.concatenate((low, high, box), axis=-1) + ROUNDING

    def joint_velocity(self, xyz: Array, theta: Array, velocity: Array) -> Array:
        return np.ascontiguousarray(velocity @ self.back.T)

    def tip_velocity(self, xyz: Array, theta: Array, velocity: Array) -> Array:
        return np.ascontiguousarray(velocity @ self.matrix.T)

    def warm_up(self) -> None:
        pass


def machine(matrix: list[list[float]]) -> Robot:
    count = len(matrix)
    like = load_robot("stm32")
    return Robot(
        name=f"skewed{count}",
        kind="skewed",
        mechanism=Skewed(tuple(map(tuple, matrix))),
        tool_offset=(0.0,) * count,
        joints=Joints((-1.0,) * count, (1.5,) * count, 1.0),
        zone=Zone(z=(-60.0, 60.0)),
        limits=Limits(
            JointMotion((4.0,) * count, (50.0,) * count, (0.1,) * count),
            CartesianMotion(400.0, 4000.0, 100000.0),
        ),
        drive=like.drive,
        homing=like.homing,
    )


TWO = [[90.0, 30.0], [-20.0, 70.0]]
FOUR = [[90.0, 0, 20, 0], [0, 80.0, 0, 30], [10, 0, 100.0, 0], [0, -30, 0, 70.0]]


@pytest.fixture(params=[TWO, FOUR], ids=["two joints", "four joints"])
def robot(request: pytest.FixtureRequest) -> Robot:
    return machine(request.param)


def goal(robot: Robot, rng: np.random.Generator) -> Goal:
    count = robot.joint_count
    makers: list[Callable[[], Goal]] = [
        lambda: ToPoint(tuple(rng.uniform(-200, 200, count).tolist())),
        lambda: ToAngles(tuple(rng.uniform(-1.2, 1.7, count).tolist())),
        lambda: AtVelocity(tuple(rng.uniform(-300, 300, count).tolist())),
        lambda: AtJointVelocity(tuple(rng.uniform(-5, 5, count).tolist())),
        Rest,
    ]
    return makers[int(rng.integers(len(makers)))]()


def test_every_limit_holds_between_the_knots(robot: Robot) -> None:
    rng = np.random.default_rng(3)
    matrix = np.array(robot.mechanism.jacobian(np.zeros(robot.joint_count)))
    follower = Follower(robot, np.zeros(robot.joint_count), clock=lambda: 0.0, budget=1.0)
    theta, rate = np.zeros(robot.joint_count), np.zeros(robot.joint_count)
    target, left = goal(robot, rng), 0
    at = np.linspace(0.0, 1.0, 11)[:, None]
    travelled = 0.0
    for _ in range(1500):
        if left == 0:
            target, left = goal(robot, rng), int(rng.integers(1, 60))
        left -= 1
        knot = follower.step(target)
        before, slope, t = theta, rate, knot.duration
        theta, rate = np.array(knot.theta), np.array(knot.velocity)
        d = theta - before
        c2, c3 = 3 * d - t * (2 * slope + rate), -2 * d + t * (slope + rate)
        poses = before + slope * t * at + c2 * at**2 + c3 * at**3
        rates = slope + (2 * c2 * at + 3 * c3 * at**2) / t
        turns = (2 * c2 + 6 * c3 * at) / t**2
        assert np.all((poses >= -1.0001) & (poses <= 1.5001))
        assert np.abs((poses @ matrix.T)[:, -1]).max() <= 60.01
        assert np.abs(rates).max() <= 4.0
        assert np.abs(turns).max() <= 50.0
        if not follower.braking:
            assert np.linalg.norm(rates @ matrix.T, axis=1).max() <= 400.0
            assert np.linalg.norm(turns @ matrix.T, axis=1).max() <= 4000.0
        stop = theta + rate * np.max(np.abs(rate) / 50.0) / 2
        assert np.all((stop >= -1.0001) & (stop <= 1.5001))
        assert abs((matrix @ stop)[-1]) <= 60.01
        travelled += float(np.abs(d).max())
    assert travelled > 10.0


def test_the_nearest_place_to_an_unreachable_target_is_found(robot: Robot) -> None:
    """With linear kinematics the legal region is convex: no step around the place is nearer."""
    rng = np.random.default_rng(5)
    for _ in range(4):
        follower = Follower(robot, np.zeros(robot.joint_count), clock=lambda: 0.0, budget=1.0)
        target = rng.uniform(-1, 1, robot.joint_count)
        target *= 400.0 / np.linalg.norm(target)
        for _ in range(400):
            follower.step(ToPoint(tuple(target.tolist())))
        assert follower.resting
        around = follower.xyz + rng.normal(size=(4000, robot.joint_count)) * 3
        legal = around[robot.margins(around, robot.inverse(around)).min(axis=1) >= 0]
        least = np.linalg.norm(legal - target, axis=1).min()
        assert np.linalg.norm(follower.xyz - target) <= least + 1.0
        assert follower.held_by


def test_axes_are_named_for_the_machine() -> None:
    robot = machine(TWO)
    follower = Follower(robot, (0.0, 0.0), clock=lambda: 0.0, budget=1.0)
    for _ in range(200):
        follower.step(AtVelocity((0.0, 100.0)))
    (held,) = follower.held_by
    assert held.limit == "At the top of the workspace (Z 60.0 mm)"
    assert held.way_out == ("-Z",)
