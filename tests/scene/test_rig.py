from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
import viser

from deltaviz.robots import Robot
from deltaviz.scene import rotations
from deltaviz.scene.rig import Dimensions, Rig, arm_poses
from deltaviz.scene.units import metres


@pytest.fixture(params=["robot", "other_robot"])
def drawn(request: pytest.FixtureRequest) -> Robot:
    return request.getfixturevalue(request.param)


@pytest.mark.parametrize("offset", [(0, 0, 0), (60, 0, 0), (-30, 45, 8)])
def test_the_drawn_robot_closes(drawn: Robot, offset: tuple[float, float, float]) -> None:
    """Arms and rods, turned as they are drawn, end where the next part begins."""
    tip = np.add((0.0, 0.0, sum(drawn.workspace.z) / 2), offset)
    size = Dimensions.of(drawn)
    centre = metres(tip)
    x, y, z = centre.tolist()
    poses = arm_poses(size, tuple(drawn.inverse(tip).tolist()), (x, y, z))
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
