"""A fourth joint that turns the tool: part of the robot, no part of the mechanism."""

from dataclasses import replace

import numpy as np
import pytest

from deltaviz.mechanism import Margin, MarginKind
from deltaviz.robots import RobotFileError
from deltaviz.robots.load import parse_robot
from deltaviz.robots.presets import preset_text


def test_the_joint_is_appended(tool_robot, stm32):
    assert tool_robot.joint_count == 4
    assert tool_robot.mechanism == stm32.mechanism
    assert np.degrees(tool_robot.joints.min) == pytest.approx([-45, -45, -45, -175])
    assert np.degrees(tool_robot.limits.joint.velocity) == pytest.approx([340, 340, 340, 600])
    assert np.degrees(tool_robot.homing.switch) == pytest.approx([-50, -50, -50, -180])
    assert np.degrees(tool_robot.homing.max_travel) == pytest.approx([170, 170, 170, 370])
    assert len(tool_robot.drive.microsteps_per_rad) == len(tool_robot.drive.invert) == 4
    assert stm32.joint_count == 3
    assert not stm32.tool_axis


def test_the_tip_knows_nothing_of_it(tool_robot, stm32):
    theta = np.radians([[10.0, 20.0, 30.0, -90.0], [10.0, 20.0, 30.0, 120.0]])
    tip = tool_robot.forward(theta)
    assert tip == pytest.approx(stm32.forward(theta[:, :3]))
    assert (tip[0] == tip[1]).all()
    jacobian = tool_robot.jacobian(theta)
    assert jacobian.shape == (2, 3, 4)
    assert (jacobian[..., 3] == 0).all()
    with pytest.raises(ValueError, match=r"theta has shape \(3,\)"):
        tool_robot.forward([0, 0, 0])


def test_inverse_leaves_the_tool_at_its_ready_angle(tool_robot):
    turned = replace(tool_robot, homing=replace(tool_robot.homing, ready=(0, 0, 0, 0.3)))
    theta = turned.inverse([[10.0, -20.0, -300.0], [0.0, 0.0, -900.0]])
    assert theta[0, 3] == 0.3
    assert np.isnan(theta[1]).all(), "a row of NaN stays whole"
    assert len(turned.reach([10, -20, -300]).theta) == 4


def test_its_limits_are_margins(tool_robot):
    names = tool_robot.margin_names
    assert names[-2:] == (Margin(MarginKind.TOOL_MIN, 3), Margin(MarginKind.TOOL_MAX, 3))
    assert str(names[-1]) == "upper limit of the tool's turn"
    tip = tool_robot.forward([0, 0, 0, 0])
    for angle, legal in ((-175.0, True), (-175.1, False), (175.0, True), (175.1, False)):
        theta = np.array([0, 0, 0, np.radians(angle)])
        assert (tool_robot.margins(tip, theta) >= 0).all() == legal


def test_full_speed_of_the_tool_counts_as_full_speed_of_the_tip(tool_robot):
    turn = tool_robot.limits.joint.velocity[3] * tool_robot.turn_scale
    assert turn == pytest.approx(tool_robot.limits.cartesian.velocity)


class TestKernel:
    """The kernel's poses are the tip and the turn, in mm: as many numbers as joints."""

    @pytest.fixture
    def theta(self):
        angles = np.random.default_rng(3).uniform(-0.7, 1.5, (200, 4))
        angles[:, 3] = np.random.default_rng(4).uniform(-3.5, 3.5, 200)
        return angles

    @pytest.fixture
    def poses(self, tool_robot, theta):
        return tool_robot.kernel.forward(theta)

    def test_forward_and_inverse(self, tool_robot, theta, poses):
        assert poses[:, :3] == pytest.approx(tool_robot.forward(theta))
        assert poses[:, 3] == pytest.approx(theta[:, 3] * tool_robot.turn_scale)
        back = tool_robot.kernel.inverse(poses)
        same = np.abs(back - theta).max(axis=1) < 1e-9
        assert same.mean() > 0.9  # but for elbows that stood inside
        assert (back[:, 3] == pytest.approx(theta[:, 3])) or np.isnan(back).any()

    def test_out_of_reach_is_a_whole_row(self, tool_robot):
        assert np.isnan(tool_robot.kernel.inverse(np.array([[0.0, 0.0, -900.0, 10.0]]))).all()

    def test_margins_are_the_robots(self, tool_robot, theta, poses):
        ours = tool_robot.kernel.margins(poses, theta)
        assert ours == pytest.approx(tool_robot.margins(poses[:, :3], theta), abs=1e-9)
        far = np.array([[0.0, 0.0, -900.0, 10.0]])
        unknown = tool_robot.kernel.margins(far, np.full((1, 4), np.nan))
        assert np.isfinite(unknown).all()
        assert unknown.min() < 0

    def test_velocities(self, tool_robot, theta, poses):
        turning = np.random.default_rng(5).normal(size=theta.shape)
        moving = tool_robot.kernel.tip_velocity(poses, theta, turning)
        expected = (tool_robot.jacobian(theta) @ turning[..., None])[..., 0]
        assert moving[:, :3] == pytest.approx(expected, rel=1e-6, abs=1e-6)
        assert moving[:, 3] == pytest.approx(turning[:, 3] * tool_robot.turn_scale)
        assert tool_robot.kernel.joint_velocity(poses, theta, moving) == pytest.approx(
            turning, rel=1e-6, abs=1e-6
        )


@pytest.mark.parametrize(
    ("before", "after", "field", "says"),
    [
        ("min_deg = -175", "min_deg = 180", "tool_axis.min_deg", "less than tool_axis.max_deg"),
        ("min_deg = -175", "min_deg = -2000", "tool_axis.min_deg", "between -1080 and 1080"),
        ("max_deg = 175\n", "", "tool_axis.max_deg", "is missing"),
        ("velocity_deg_s = 600", "velocity_deg_s = 0", "tool_axis.limits.velocity_deg_s", "than 0"),
        (
            "velocity_deg_s = 600",
            "velocity_deg_s = 30",
            "tool_axis.homing.fast_deg_s",
            r"at most tool_axis.limits.velocity_deg_s \(30\)",
        ),
        (
            "switch_deg = -180",
            "switch_deg = 0",
            "tool_axis.homing.switch_deg",
            r"tool_axis.min_deg \(-175\)",
        ),
        (
            "max_travel_deg = 370",
            "max_travel_deg = 300",
            "tool_axis.homing.max_travel_deg",
            "at least 355",
        ),
        (
            "[tool_axis.drive]            #",
            "[tool_axis.drive]\nresolution_deg = 0.1 #",
            "tool_axis.drive.resolution_deg",
            'not used with kind = "step_dir"',
        ),
        ("invert = false\n", 'invert = "no"\n', "tool_axis.drive.invert", "true or false"),
        ("ready_deg = 0\n", "ready_deg = 176\n", "tool_axis.homing.ready_deg", "within its limits"),
        ("tool_offset = [0, 0, 0]", "tool_offset = [5, 0, 0]", "geometry.tool_offset", "its tip"),
        ("[tool_axis.limits]", "[tool_axis.limit]", "tool_axis.limit", "did you mean 'limits'"),
    ],
)
def test_what_is_wrong_and_where(tool_text, before, after, field, says):
    assert before in tool_text
    with pytest.raises(RobotFileError, match=rf"line \d+: {field}\b.*{says}"):
        parse_robot(tool_text.replace(before, after))


def test_with_servos_it_is_a_servo():
    tool = """
[tool_axis]
min_deg = -90
max_deg = 90
[tool_axis.limits]
velocity_deg_s = 250
acceleration_deg_s2 = 3000
unhomed_velocity_deg_s = 5
[tool_axis.drive]
DRIVE
[tool_axis.homing]
switch_deg = -95
fast_deg_s = 20
slow_deg_s = 2
backoff_deg = 5
max_travel_deg = 200
ready_deg = 0
"""
    text = preset_text("deltadraw") + tool
    robot = parse_robot(text.replace("DRIVE", "resolution_deg = 0.1"))
    assert robot.drive.microsteps_per_rad[3] == pytest.approx(3600 / (2 * np.pi))
    with pytest.raises(RobotFileError, match=r"tool_axis.drive.resolution_deg = missing: needed"):
        parse_robot(text.replace("DRIVE", ""))


def test_a_five_bar_has_none():
    with pytest.raises(RobotFileError, match="tool_axis is not a known field"):
        parse_robot(preset_text("fivebar") + "\n[tool_axis]\nmin_deg = 0\n")
