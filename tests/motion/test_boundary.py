"""Where a target is out of reach, the robot settles where it is nearest."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from deltaviz.motion.follower import Follower
from deltaviz.motion.goal import ToPoint
from deltaviz.robots import Robot, load_robot
from deltaviz.robots.robot import Joints, Zone

Array = NDArray[np.float64]
TARGETS = 8


def legal(robot: Robot, places: Array) -> Array:
    return places[robot.margins(places, robot.inverse(places)).min(axis=-1) >= 0]


def nearest(robot: Robot, cloud: Array, target: Array, rng: np.random.Generator) -> float:
    """The distance to the legal region, by random search from the nearest of a cloud."""
    best = np.inf
    for start in cloud[np.argsort(np.linalg.norm(cloud - target, axis=1))[:3]]:
        place, distance, spread = start, float(np.linalg.norm(start - target)), 30.0
        while spread > 0.02:
            trials = legal(robot, place + rng.normal(size=(300, 3)) * spread)
            distances = np.linalg.norm(trials - target, axis=1)
            if len(trials) and distances.min() < distance - 1e-3:
                place, distance = trials[distances.argmin()], float(distances.min())
            else:
                spread /= 2
        best = min(best, distance)
    return best


@pytest.mark.parametrize("name", ["stm32", "trossen", "zheng2023", "deltadraw"])
def test_unreachable_targets_are_approached_as_far_as_possible(name: str) -> None:
    robot = load_robot(name)
    rng = np.random.default_rng(11)
    low, high = robot.zone.z
    width = robot.zone.radius or 150.0
    box = [-width, -width, low], [width, width, high]
    cloud = legal(robot, rng.uniform(*box, size=(20000, 3)))
    follower = Follower(robot, robot.homing.ready, clock=lambda: 0.0, budget=1.0)
    excess: list[float] = []
    while len(excess) < TARGETS:
        across, up = 1.6 * width, 0.5 * width
        target = rng.uniform([-across, -across, low - up], [across, across, high + up])
        if len(legal(robot, target[None, :])):
            continue
        goal = ToPoint(tuple(target.tolist()))
        still = 0
        while still < 20:
            before = follower.xyz
            follower.step(goal)
            still = still + 1 if np.array_equal(before, follower.xyz) else 0
        least = nearest(robot, cloud, target, rng)
        excess.append(float(np.linalg.norm(follower.xyz - target)) - least)
    assert max(excess) < 1.0


def test_a_place_behind_a_bend_of_the_boundary_is_reached() -> None:
    """With wide limits many straight lines between legal places leave the legal region."""
    robot = replace(
        load_robot("stm32"),
        joints=Joints((-np.pi / 2,) * 3, (2.0,) * 3, np.radians(70)),
        zone=Zone(z=(-445.0, -20.0), radius=400.0),
    )
    rng = np.random.default_rng(3)
    places = legal(robot, rng.uniform([-400, -400, -445], [400, 400, -20], size=(4000, 3)))
    share = np.linspace(0, 1, 60)[:, None]
    follower = Follower(robot, robot.homing.ready, clock=lambda: 0.0, budget=1.0)
    bends = 0
    for place in places:
        line = follower.xyz + (place - follower.xyz) * share
        if len(legal(robot, line)) == len(line):
            continue
        bends += 1
        for _ in range(400):
            follower.step(ToPoint(tuple(place.tolist())))
        assert follower.xyz == pytest.approx(place, abs=1e-3)
        if bends == 6:
            break
    assert bends == 6
