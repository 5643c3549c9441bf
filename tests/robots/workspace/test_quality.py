"""How well robots move, against poses solved at 50 digits and against steps really taken."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from deltaviz.mechanism import FiveBar, RotaryDelta
from deltaviz.robots import Robot, load_robot
from deltaviz.robots.workspace import Quality, quality

REFERENCE = Path(__file__).parents[2] / "data" / "reference"


def reference(name: str) -> tuple[Robot, dict[str, Any]]:
    """The reference poses of a mechanism, and a robot that has it."""
    data = json.loads((REFERENCE / f"{name}.json").read_text())
    planar = name.startswith("five_bar")
    mechanism = (FiveBar if planar else RotaryDelta)(**data["geometry"])
    robot = load_robot("fivebar" if planar else "stm32")
    return replace(robot, mechanism=mechanism), data


@pytest.mark.parametrize("name", ["trossen", "zheng_chen", "stm32", "irb360_like", "lego_like"])
def test_singular_values_and_ball_joints(name: str) -> None:
    robot, data = reference(name)
    cases = data["ik"]
    found = quality(robot, np.array([case["xyz"] for case in cases]))
    sigma = np.array([case["sigma"] for case in cases])
    np.testing.assert_allclose(found.fastest, sigma[:, 0], rtol=1e-9)
    np.testing.assert_allclose(found.slowest, sigma[:, -1], rtol=1e-9)
    np.testing.assert_allclose(found.condition, [case["cond"] for case in cases], rtol=1e-9)
    np.testing.assert_allclose(found.least_force * sigma[:, 0], 1000)
    np.testing.assert_allclose(found.most_force * sigma[:, -1], 1000)
    np.testing.assert_allclose(found.stiffness * sigma[:, 0] ** 2, 1000)
    lean = np.abs([case["forearm_lateral_deg"] for case in cases]).max(axis=1)
    np.testing.assert_allclose(found.ball_joint_deg, lean, atol=1e-9)


@pytest.mark.parametrize("name", ["fivebar_f0", "fivebar_platform", "fivebar_point"])
def test_the_planar_robots_condition(name: str) -> None:
    robot, data = reference(f"five_bar/{name}")
    found = quality(robot, np.array([case["xy"] for case in data["ik"]]))
    jacobians = np.array([case["J"] for case in data["ik"]])
    np.testing.assert_allclose(found.condition, np.linalg.cond(jacobians), rtol=1e-9)
    assert (found.ball_joint_deg == 0).all()


def test_on_the_axis_the_best_condition_is_known() -> None:
    """max(1, √2 cot β) with sin β = (s + L)/l, where the arms stand level."""
    for name in ("stm32", "zheng2023", "trossen"):
        robot = load_robot(name)
        mechanism = robot.mechanism
        assert isinstance(mechanism, RotaryDelta)
        s = mechanism.base_radius[0] - mechanism.effector_radius[0]
        beta = math.asin((s + mechanism.upper_arm[0]) / mechanism.forearm[0])
        z = np.linspace(*robot.zone.z, 4001)
        axis = np.stack((0 * z, 0 * z, z), axis=-1)
        best = np.nanmin(quality(robot, axis).condition)
        assert best == pytest.approx(max(1.0, math.sqrt(2) / math.tan(beta)), abs=2e-3)


def test_the_resolution_is_that_of_steps_really_taken(robot: Robot) -> None:
    """Of all joint steps of one microstep together, the one that moves the tip farthest."""
    arms = robot.mechanism.joints
    theta = np.array(robot.homing.ready)
    tip = robot.forward(theta)
    random = np.random.default_rng(12)
    ways = random.normal(size=(20_000, arms))
    ways /= np.linalg.norm(ways, axis=-1, keepdims=True)
    steps = ways / np.array(robot.drive.microsteps_per_rad[:arms])
    moved = np.linalg.norm(robot.forward(theta + steps) - tip, axis=-1)
    assert quality(robot, tip).resolution == pytest.approx(moved.max(), rel=0.01)


def test_it_shows_singularities(stm32: Robot) -> None:
    robot, data = reference("trossen")
    # At 1e-3 mm before the arm is straight or folded.
    near = [
        side["xyz"]
        for case in data["singular_type1"]
        for side in case["near"]
        if side["leg_reachable"]
    ]
    edge = quality(robot, np.array(near))
    known = np.isfinite(edge.type_1)
    assert known.sum() > 10
    assert edge.type_1[known].max() < 0.02
    # Those that have their elbows outside.
    tips = np.array([case["xyz"] for case in data["singular_type2"]])
    theta = np.radians([case["theta_deg"] for case in data["singular_type2"]])
    outside = (np.abs(robot.mechanism.inverse(tips) - theta) < 1e-6).all(axis=1)
    assert outside.sum() >= 2
    assert np.abs(quality(robot, tips[outside]).type_2).max() < 1e-9
    good = quality(stm32, [0.0, 0.0, -300.0])
    assert good.type_1 > 0.8
    assert good.type_2 > 0.3


def test_joint_margins_are_to_the_nearest_limit(stm32: Robot) -> None:
    tips = stm32.forward(np.radians([[0, 0, 0], [-40, 10, 10], [70, 20, 30]]))
    assert quality(stm32, tips).joint_margin_deg == pytest.approx([45, 5, 20])


def test_out_of_reach_all_is_unknown(robot: Robot) -> None:
    far = np.full(len(robot.tool_offset), 5000.0)
    found = quality(robot, far)
    assert all(np.isnan(getattr(found, name)) for name in Quality.measures())


def test_any_shape_of_points(stm32: Robot) -> None:
    points = np.broadcast_to((10.0, -5.0, -300.0), (2, 4, 3))
    found = quality(stm32, points)
    assert all(getattr(found, name).shape == (2, 4) for name in Quality.measures())
