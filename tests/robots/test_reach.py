"""Why a point is out of reach: which arm, which limit, and by how much."""

from dataclasses import replace

import numpy as np
import pytest

from deltaviz.mechanism import MarginKind
from deltaviz.robots import load_robot
from deltaviz.robots.robot import Zone

OPEN = Zone(z=(-2000.0, 2000.0), radius=2000.0)


def only(reach, kind, arm=None):
    found = [reason for reason in reach.reasons if reason.limit.kind is kind and reason.arm == arm]
    assert len(found) == 1, str(reach)
    return found[0]


def test_legal(stm32):
    reach = stm32.reach([0, 0, -300])
    assert reach.legal
    assert reach.reasons == ()
    assert str(reach) == "Within reach and all limits."
    assert reach.theta == pytest.approx(stm32.inverse([0, 0, -300]))


def test_too_far(stm32):
    reach = stm32.reach([0, 0, -500])
    assert not reach.legal
    assert reach.theta is None
    for arm in range(3):
        reason = only(reach, MarginKind.TYPE_1, arm)
        assert reason.excess == pytest.approx(np.hypot(500, 40) - 125 - 338)
        assert f"Arm {arm + 1} cannot reach it: 38.60 mm too far away" in str(reason)
    below = only(reach, MarginKind.Z_MIN)
    assert below.excess == pytest.approx(60)
    assert "Z -500 mm is 60.00 mm below the workspace (-440 to -225 mm)." in str(reach)


def test_too_near_for_one_arm_only(stm32):
    reach = replace(stm32, zone=OPEN).reach([150, 0, -170])
    reason = only(reach, MarginKind.TYPE_1, 0)
    assert reason.excess == pytest.approx(338 - 125 - np.hypot(110, 170))
    assert "too close" in str(reason)
    assert [found.arm for found in reach.reasons if found.unit == "mm"] == [0]


def test_a_joint_limit_names_arm_angle_and_excess(stm32):
    reach = stm32.reach([0, 200, -230])
    reason = only(reach, MarginKind.JOINT_MIN, 1)
    angle = np.degrees(stm32.inverse([0, 200, -230])[1])
    assert reason.unit == "deg"
    assert reason.excess == pytest.approx(-45 - angle)
    assert f"Arm 2 would stand at {angle:.2f}°" in str(reason)
    assert "its lower limit of -45°" in str(reason)


def test_the_upper_joint_limit(stm32):
    tip = stm32.forward(np.radians([93.0, 60.0, 60.0]))
    reason = only(stm32.reach(tip), MarginKind.JOINT_MAX, 0)
    assert reason.excess == pytest.approx(3.0, abs=1e-6)


def test_ball_joints(stm32):
    tip = [0.0, 250.0, -300.0]
    reason = only(stm32.reach(tip), MarginKind.BALL_JOINT, 0)
    assert reason.excess == pytest.approx(np.degrees(np.arcsin(250 / 338)) - 45)
    assert "ball joints of arm 1 would stand at 47.70°" in str(reason)


def test_the_radius(stm32):
    reason = only(stm32.reach([231.5, 0, -300]), MarginKind.RADIUS)
    assert reason.excess == pytest.approx(1.5)
    assert str(reason) == "It is 1.50 mm outside the workspace's radius of 230 mm."


def test_a_box(stm32):
    boxed = replace(stm32, zone=Zone(z=(-440, -225), x=(-50, 60), y=(-70, 80)))
    for point, kind, excess in (
        ([-51, 0, -300], MarginKind.X_MIN, 1),
        ([62, 0, -300], MarginKind.X_MAX, 2),
        ([0, -73, -300], MarginKind.Y_MIN, 3),
        ([0, 84, -300], MarginKind.Y_MAX, 4),
    ):
        reach = boxed.reach(point)
        assert len(reach.reasons) == 1
        assert only(reach, kind).excess == pytest.approx(excess)


def test_near_the_edge_of_reach(stm32):
    free = replace(
        stm32,
        zone=OPEN,
        joints=replace(stm32.joints, min=(-3.0,) * 3, max=(3.0,) * 3),
    )
    reach = free.reach([0, 0, -460.5])
    for arm in range(3):
        reason = only(reach, MarginKind.TYPE_1, arm)
        assert "nearly straight" in str(reason)
        assert "0.77 mm from the edge of its reach" in str(reason)


def test_above_the_elbows(stm32):
    free = replace(stm32, zone=OPEN)
    assert "hold the effector" in str(only(free.reach([0, 0, 300]), MarginKind.TYPE_2))


def test_a_tool_counts(stm32):
    longer = replace(stm32, tool_offset=(0.0, 0.0, -30.0))
    assert longer.reach([0, 0, -330]).theta == pytest.approx(stm32.inverse([0, 0, -300]))
    assert not longer.reach([0, 0, -235]).legal


@pytest.mark.parametrize(
    ("bad", "says"),
    [
        ([0, 0, np.nan], "finite"),
        ([0, np.inf, -300], "finite"),
        ([0, 0], "shape"),
        ([[0, 0, -300]], "one point"),
    ],
)
def test_what_is_no_point(stm32, bad, says):
    with pytest.raises(ValueError, match=says):
        stm32.reach(bad)


def test_in_a_plane():
    robot = load_robot("fivebar")
    reach = robot.reach([0, -350])
    for arm in range(2):
        excess = np.hypot(60, 350) - 300
        assert only(reach, MarginKind.TYPE_1, arm).excess == pytest.approx(excess)
    assert "Z -350 mm is 110.00 mm below the workspace" in str(reach)
    assert "X 104 mm is 4.00 mm above the workspace" in str(robot.reach([104, -160]))
    with pytest.raises(ValueError, match=r"xyz has shape \(3,\)"):
        robot.reach([0, 0, -200])


def test_legal_is_what_margins_say(preset):
    """One truth: `reach` agrees with `margins` and with the kernel, everywhere."""
    rng = np.random.default_rng(4)
    space = preset.zone
    wide = 1.2 * (space.radius or max(box[1] for box in (space.x, space.y) if box))
    across = len(preset.axes) - 1
    low, high = [-wide] * across + [space.z[0] - 20], [wide] * across + [space.z[1] + 20]
    points = rng.uniform(low, high, (400, len(preset.axes)))
    theta = preset.kernel.inverse(points)
    legal = (preset.kernel.margins(points, theta) >= 0).all(axis=-1)
    assert 0.1 < legal.mean() < 0.9
    for point, expected in zip(points, legal, strict=True):
        reach = preset.reach(point)
        assert reach.legal == expected, f"{point}: {reach}"
        assert reach.legal or reach.reasons
        assert all(reason.excess > 0 for reason in reach.reasons)
