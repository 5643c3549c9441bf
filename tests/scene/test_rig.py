from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
import viser

from deltaviz.robots import Robot
from deltaviz.robots.coordinates import in_robot, is_planar
from deltaviz.scene import rotations
from deltaviz.scene.rig import Dimensions, Rig, arm_poses, shaft_top
from deltaviz.scene.units import metres


@pytest.fixture(params=["robot", "other_robot", "planar_robot", "tool_robot"])
def drawn(request: pytest.FixtureRequest) -> Robot:
    return request.getfixturevalue(request.param)


@pytest.mark.parametrize("offset", [(0, 0, 0), (60, 0, 0), (-30, 45, 8)])
def test_the_drawn_robot_closes(drawn: Robot, offset: tuple[float, float, float]) -> None:
    """Arms and rods, turned as they are drawn, end where the next part begins."""
    tip = np.add((0.0, 0.0, sum(drawn.zone.z) / 2), offset)
    if is_planar(drawn):
        tip[1] = 0.0
    size = Dimensions.of(drawn)
    centre = metres(tip)
    x, y, z = centre.tolist()
    theta = tuple(drawn.inverse(in_robot(drawn, tip.tolist())).tolist())
    poses = arm_poses(size, theta, (x, y, z))
    assert len(poses) == drawn.mechanism.joints
    for i, pose in enumerate(poses):
        arm, rod = (rotations.matrix(np.array(q)) for q in (pose.arm_wxyz, pose.rod_wxyz))
        motor = size.base_radius[i] * size.outward[i]
        assert motor + arm[:, 0] * size.upper_arm[i] == pytest.approx(np.array(pose.elbow))
        assert arm[:, 1] == pytest.approx(size.sideways[i])
        wrist = centre + size.effector_radius[i] * size.outward[i]
        assert pose.elbow - rod[:, 2] * size.forearm[i] == pytest.approx(wrist, abs=1e-9)


def test_the_tool_hangs_below_the_effector(scene_api: viser.SceneApi, robot: Robot) -> None:
    longer = dataclasses.replace(robot, tool_offset=(0.0, 0.0, -30.0))
    rig = Rig(scene_api, "/rig", Dimensions.of(longer))
    rig.move((0.0, 0.0, 0.0), (0.0, 0.0, -330.0))
    assert rig.effector.position == pytest.approx((0.0, 0.0, -0.300))


def test_an_unknown_pose_leaves_the_rig_where_it_is(
    scene_api: viser.SceneApi, robot: Robot
) -> None:
    rig = Rig(scene_api, "/rig", Dimensions.of(robot))
    rig.move((0.0, 0.0, 0.0), (0.0, 0.0, -330.0))
    rig.move((math.nan, 0.0, 0.0), (0.0, 0.0, -340.0))
    assert rig.effector.position == pytest.approx((0.0, 0.0, -0.330))


def test_the_links_of_a_five_bar_keep_its_platform_level(
    scene_api: viser.SceneApi, planar_robot: Robot
) -> None:
    """Each is parallel to what it stands beside, so its side at the elbow does not turn."""
    size = Dimensions.of(planar_robot)
    rig = Rig(scene_api, "/planar", size)
    tip = (-50.0, -190.0)
    rig.move(tuple(planar_robot.inverse(tip).tolist()), tip)
    assert rig.effector.position == pytest.approx((-0.05, 0.0, -0.19))
    motor = size.base_radius[0] * size.outward[0]
    wrist = rig.effector.position + size.effector_radius[0] * size.outward[0]
    assert size.level_by is not None
    arm_link, rod_link = rig.links
    arm = rotations.matrix(arm_link.wxyz)[:, 0] * size.upper_arm[0]
    assert arm_link.position + arm == pytest.approx(rig.forearms[0].position + size.level_by)
    rod = -rotations.matrix(rod_link.wxyz)[:, 2] * size.forearm[0]
    assert motor + arm + size.level_by + rod == pytest.approx(wrist + size.level_by)


def test_the_tool_turns_and_its_shaft_points_at_it(
    scene_api: viser.SceneApi, tool_robot: Robot
) -> None:
    size = Dimensions.of(tool_robot)
    rig = Rig(scene_api, "/tool", size)
    tip = (60.0, -30.0, -320.0)
    theta = tool_robot.inverse(tip)
    theta[3] = math.radians(90)
    rig.move(tuple(theta.tolist()), tip)
    pointer = rotations.matrix(rig.tool.wxyz)[:, 0]
    assert pointer == pytest.approx((0.0, 1.0, 0.0), abs=1e-9)  # counter-clockwise from above
    top = np.array(shaft_top(size))
    for shaft in rig.shafts:
        along = -rotations.matrix(shaft.wxyz)[:, 2]
        assert np.cross(along, metres(tip) - top) == pytest.approx(np.zeros(3), abs=1e-12)
        assert along @ (metres(tip) - top) > 0
