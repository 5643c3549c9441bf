"""What motors must give, for a payload and for a motion across the zone."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from deltaviz.robots import Robot, load_robot
from deltaviz.robots.torques import MassesMissing, crossing, holding, straight


def test_holding_on_the_axis_is_the_same_for_all_arms(stm32: Robot) -> None:
    tau = holding(stm32, [0.0, 0.0, -300.0])
    assert np.ptp(tau) < 1e-9
    assert (tau < 0).all()  # they push up
    assert (holding(stm32, [0.0, 0.0, -300.0], payload=0.5) < tau - 0.1).all()
    assert np.isnan(holding(stm32, [0.0, 0.0, -900.0])).all()


def test_the_tools_offset_counts(stm32: Robot) -> None:
    long = replace(stm32, tool_offset=(0.0, 0.0, -50.0))
    np.testing.assert_allclose(
        holding(long, [10.0, 20.0, -350.0]), holding(stm32, [10.0, 20.0, -300.0])
    )


def test_a_motion_is_as_quick_as_the_limits_allow(stm32: Robot) -> None:
    motion, duration = straight(stm32, [-100, 0, -300], [100, 0, -300])
    speed = np.linalg.norm(motion.velocity, axis=1)
    change = np.linalg.norm(motion.acceleration, axis=1)
    limits = stm32.limits.cartesian
    joint = stm32.limits.joint
    used = max(
        speed.max() / limits.velocity,
        change.max() / limits.acceleration,
        np.abs(motion.theta_dot / joint.velocity).max(),
        np.abs(motion.theta_ddot / joint.acceleration).max(),
    )
    assert used == pytest.approx(1, abs=1e-3)
    t = np.linspace(0, duration, len(speed))
    np.testing.assert_allclose(
        np.gradient(motion.theta[:, 0], t), motion.theta_dot[:, 0], atol=2e-2
    )
    assert motion.position[0] == pytest.approx([-100, 0, -300])
    assert motion.position[-1] == pytest.approx([100, 0, -300])


@pytest.mark.parametrize("field", ["velocity", "acceleration"])
def test_the_joints_limits_slow_a_motion(stm32: Robot, field: str) -> None:
    ends = [-100, 0, -300], [100, 0, -300]
    motion, quick = straight(stm32, *ends)
    values = motion.theta_dot if field == "velocity" else motion.theta_ddot
    half = tuple((np.abs(values).max(axis=0) / 2).tolist())
    joint = replace(stm32.limits.joint, **{field: half})
    slowed = replace(stm32, limits=replace(stm32.limits, joint=joint))
    _, slow = straight(slowed, *ends)
    assert slow / quick == pytest.approx(2 if field == "velocity" else np.sqrt(2), rel=1e-6)
    found = crossing(slowed, *ends)
    assert found.duration == slow
    assert (found.fastest <= np.array(slowed.limits.joint.velocity) * (1 + 1e-9)).all()


def test_a_way_beyond_the_limits_is_refused_with_the_limit(stm32: Robot) -> None:
    low = stm32.zone.z[0] - 2.0
    with pytest.raises(ValueError, match=r"leaves the limits, most at \(.*, -442.0\) mm: "):
        crossing(stm32, [-40, 0, low], [40, 0, low])


@pytest.mark.parametrize("name", ["stm32", "fivebar"])
def test_quicker_motions_take_more(name: str) -> None:
    robot = load_robot(name)
    start, end = np.zeros((2, len(robot.tool_offset)))
    start[0], end[0] = -60.0, 60.0
    start[-1] = end[-1] = sum(robot.zone.z) / 2
    slow, quick = (crossing(robot, start, end, duration=t) for t in (5.0, 0.2))
    assert (quick.peak > slow.peak).all()
    for found in (slow, quick):
        assert (found.rms <= found.peak).all()
    heavier = crossing(robot, start, end, duration=0.2, payload=1.0)
    assert (heavier.peak > quick.peak).all()


def test_a_way_that_leaves_the_reach_is_refused(stm32: Robot) -> None:
    with pytest.raises(ValueError, match="leaves what the arms reach"):
        crossing(stm32, [-500, 0, -300], [100, 0, -300])


def test_without_masses_it_says_what_is_missing(stm32: Robot) -> None:
    with pytest.raises(MassesMissing, match=r"\[masses\]"):
        holding(replace(stm32, masses=None), [0, 0, -300])
