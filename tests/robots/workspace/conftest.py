from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from deltaviz.mechanism import RotaryDelta
from deltaviz.robots import Robot, load_robot

DELTAS = ("stm32", "trossen", "zheng2023", "deltadraw")


def with_(robot: Robot, **changes: Any) -> Robot:
    """A robot with other joint limits (degrees), ball joints (degrees), geometry, or parts."""
    joints = robot.joints
    if "min_deg" in changes:
        joints = replace(joints, min=(np.radians(changes.pop("min_deg")).item(),) * 3)
    if "max_deg" in changes:
        joints = replace(joints, max=(np.radians(changes.pop("max_deg")).item(),) * 3)
    if "ball_joint_max_deg" in changes:
        lean = np.radians(changes.pop("ball_joint_max_deg")).item()
        joints = replace(joints, ball_joint_max=lean)
    return replace(robot, joints=joints, **changes)


@pytest.fixture(scope="session")
def uneven() -> Robot:
    """Every length, direction and limit different, and a tool that stands aside."""
    robot = load_robot("stm32")
    mechanism = RotaryDelta(
        base_radius=(115, 118, 113),
        effector_radius=(75, 74, 77),
        upper_arm=(125, 123, 128),
        forearm=(338, 336, 341),
        azimuths_deg=(2, 119, 243),
    )
    joints = replace(
        robot.joints,
        min=tuple(np.radians((-45, -40, -50)).tolist()),
        max=tuple(np.radians((90, 85, 95)).tolist()),
    )
    return replace(robot, mechanism=mechanism, joints=joints, tool_offset=(5.0, -3.0, -20.0))


@pytest.fixture(scope="session", params=[*DELTAS, "fivebar", "uneven"])
def robot(request: pytest.FixtureRequest, uneven: Robot) -> Robot:
    return uneven if request.param == "uneven" else load_robot(request.param)
