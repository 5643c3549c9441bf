"""An empty workspace is a result, with the limit that leaves nothing."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from deltaviz.mechanism import RotaryDelta
from deltaviz.robots import Robot
from deltaviz.robots.workspace import Cylinder, Empty, Limit, levels
from tests.robots.workspace.conftest import with_


def long_and_short(robot: Robot) -> Robot:
    """Arm 1 cannot come as near as arm 2 can reach."""
    mechanism = RotaryDelta(
        base_radius=115, effector_radius=75, upper_arm=100, forearm=(1000, 150, 300)
    )
    return replace(robot, mechanism=mechanism)


def fat(robot: Robot) -> Robot:
    assert robot.bodies is not None
    return replace(robot, bodies=replace(robot.bodies, rod_diameter=300))


def aside(robot: Robot) -> Robot:
    """One arm far down, two far up: they meet, but well away from all three arms' planes."""
    low, high = np.radians((75.0, -45.0, -45.0)), np.radians((85.0, -35.0, -35.0))
    joints = replace(robot.joints, min=tuple(low.tolist()), max=tuple(high.tolist()))
    return with_(replace(robot, joints=joints), ball_joint_max_deg=5.0)


def flat(robot: Robot) -> Robot:
    """Forearms only just longer than it is from elbow to centre, and joints near the horizontal."""
    mechanism = RotaryDelta(base_radius=286, effector_radius=75, upper_arm=125, forearm=338)
    return with_(replace(robot, mechanism=mechanism), min_deg=-1.0, max_deg=1.0)


CASES = [
    (long_and_short, "arms reach no point in common"),
    (lambda r: with_(r, min_deg=-179.0, max_deg=-175.0), "joint limits the forearms"),
    (aside, "a ball joint would be beyond its limit"),
    # All arms almost straight: the forearms are nearly parallel.
    (lambda r: with_(r, min_deg=93.0, max_deg=96.0), "too near a singularity"),
    (flat, "too near a singularity"),
    (fat, "parts of the robot would touch"),
    (lambda r: replace(r, zone=replace(r.zone, z=(-900, -800))), "No point of the zone"),
]


@pytest.mark.parametrize(("change", "reason"), CASES, ids=[reason for _, reason in CASES])
def test_the_reason(stm32: Robot, change, reason: str) -> None:
    workspace = change(stm32).workspace(Limit.ALL)
    assert workspace.empty
    assert workspace.reason is not None
    assert reason in workspace.reason
    assert not len(workspace.boundary.vertices)
    assert workspace.volume == 0
    assert workspace.largest_cylinder() is None
    assert workspace.largest_box() is None
    with pytest.raises(Empty, match=reason):
        _ = workspace.extents


def test_it_has_levels_and_nothing_fits(stm32: Robot) -> None:
    robot = long_and_short(stm32)
    (only,) = levels(robot)
    assert not len(only.faces)
    found = robot.workspace().fit(Cylinder(10.0, 10.0, -200.0))
    assert not found.fits
    assert found.unreached == 1.0


def test_what_is_not_empty_has_no_reason(robot: Robot) -> None:
    workspace = robot.workspace(tolerance=5.0)
    assert not workspace.empty
    assert workspace.reason is None
