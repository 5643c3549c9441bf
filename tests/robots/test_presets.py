"""The presets: the geometry that was published, and limits that hang together."""

import math

import numpy as np
import pytest

from deltaviz.mechanism import FiveBar, RotaryDelta
from deltaviz.robots import Robot, load_robot, preset_names
from deltaviz.robots.robot import DriveKind


def delta(robot: Robot) -> RotaryDelta:
    assert isinstance(robot.mechanism, RotaryDelta)
    return robot.mechanism


def test_names_with_the_default_first():
    assert preset_names() == ("stm32", "deltadraw", "fivebar", "trossen", "zheng2023")


def test_stm32_is_the_robot_of_the_contract():
    robot = load_robot("stm32")
    assert (robot.name, robot.kind, robot.joint_count) == ("stm32", "rotary_delta", 3)
    assert np.degrees(robot.joints.min) == pytest.approx([-45] * 3)
    assert np.degrees(robot.joints.max) == pytest.approx([90] * 3)
    assert robot.joints.ball_joint_max == pytest.approx(math.radians(45))
    assert robot.zone.z == (-440, -225)
    assert robot.zone.radius == 230
    assert np.degrees(robot.limits.joint.velocity) == pytest.approx([340] * 3)
    assert np.degrees(robot.limits.joint.acceleration) == pytest.approx([4500] * 3)
    assert np.degrees(robot.limits.joint.unhomed_velocity) == pytest.approx([5] * 3)
    cartesian = robot.limits.cartesian
    assert (cartesian.velocity, cartesian.acceleration, cartesian.jerk) == (600, 6000, 150000)
    assert robot.drive.microsteps_per_rad == pytest.approx([3200 / (2 * math.pi)] * 3)
    assert robot.drive.driver == "DRV8825"
    assert robot.homing.direction == -1
    assert np.degrees(robot.homing.switch) == pytest.approx([-50] * 3)
    assert robot.homing.together
    assert robot.homing.ready == (0, 0, 0)
    assert robot.forward(robot.homing.ready) == pytest.approx([0, 0, -294.98983], abs=1e-5)


def test_trossen_is_given_by_its_sides():
    robot = load_robot("trossen")
    assert robot.forward([0, 0, 0]) == pytest.approx([0, 0, -96.859015171], abs=1e-9)
    assert delta(robot).azimuths_deg == (-90, 30, 150)
    assert robot.drive.microsteps_per_rad[0] == pytest.approx(3 * 3200 / (2 * math.pi))


def test_zheng2023_is_table_1_and_its_cylinder_fits():
    robot = load_robot("zheng2023")
    mechanism = delta(robot)
    assert mechanism.upper_arm[0] == 360
    assert mechanism.forearm[0] == 900
    assert (mechanism.base_radius[0], mechanism.effector_radius[0]) == (260, 50)
    around = np.linspace(0, 2 * math.pi, 361)
    for z in np.linspace(*robot.zone.z, 27):
        rim = np.stack([505 * np.cos(around), 505 * np.sin(around), 0 * around + z], axis=-1)
        assert (robot.margins(rim, robot.inverse(rim)) >= 0).all()


def test_deltadraw_draws_in_simulation_only():
    robot = load_robot("deltadraw")
    assert robot.drive.kind is DriveKind.SERVO
    assert robot.drive.simulation_only
    assert robot.drive.microsteps_per_rad == pytest.approx([8000 / (2 * math.pi)] * 3)
    assert not load_robot("stm32").drive.simulation_only
    offset = delta(robot).base_radius[0] - delta(robot).effector_radius[0]
    assert offset == pytest.approx(1.11125 * 25.4)


def test_fivebar_is_the_planar_robot():
    robot = load_robot("fivebar")
    assert (robot.kind, robot.joint_count, robot.axes) == ("five_bar", 2, ("X", "Z"))
    assert isinstance(robot.mechanism, FiveBar)
    assert robot.tool_offset == (0, 0)
    # Both arms in mirror image: 20° down, elbows at x = 60 + 100 cos 20°.
    across, down = 60 + 100 * math.cos(robot.homing.ready[0]), 100 * math.sin(robot.homing.ready[0])
    tip = robot.forward(robot.homing.ready)
    assert tip == pytest.approx([0, -down - math.sqrt(200**2 - across**2)])
    assert robot.zone.x == (-100, 100)
    assert (robot.zone.y, robot.zone.radius, robot.joints.ball_joint_max) == (None,) * 3


def test_ready_is_well_inside(preset):
    tip = preset.forward(preset.homing.ready)
    assert preset.margins(tip, preset.homing.ready).min() > 5
    assert preset.reach(tip).legal


def test_most_of_the_workspace_is_within_reach(preset):
    space = preset.zone
    around = (-(space.radius or 0), space.radius or 0)
    ranges = {"X": space.x or around, "Y": space.y or around, "Z": space.z}
    low, high = np.array([ranges[axis] for axis in preset.axes]).T
    points = np.random.default_rng(3).uniform(low, high, (5000, len(preset.axes)))
    if space.radius is not None:
        points = points[np.hypot(points[:, 0], points[:, 1]) <= space.radius]
    legal = (preset.kernel.margins(points, preset.kernel.inverse(points)) >= 0).all(axis=-1)
    assert legal.mean() > 0.7


def test_no_type_2_singularity_within_the_joint_limits(preset):
    """s + L < l: the published evidence holds for joints within ±90°."""
    for arm in preset.mechanism.arms:
        assert arm.offset + arm.upper_arm < arm.forearm
    assert max(np.abs([preset.joints.min, preset.joints.max]).flat) <= math.radians(90)


def test_the_cartesian_speed_is_within_the_joints_means_at_ready(preset):
    jacobian = preset.jacobian(preset.homing.ready)
    turning = np.abs(np.linalg.inv(jacobian)).max() * preset.limits.cartesian.velocity
    assert turning < 1.5 * preset.limits.joint.velocity[0]


def test_the_switches_can_be_reached_by_all_arms_at_once(preset):
    assert np.isfinite(preset.forward(preset.homing.switch)).all()
    assert (np.array(preset.homing.switch) <= preset.joints.min).all()
