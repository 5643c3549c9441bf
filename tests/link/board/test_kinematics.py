"""The board's own kinematics: poses solved at 50 digits, and those of the robots."""

from __future__ import annotations

import json
from math import radians
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deltaviz import load_robot
from deltaviz.link.board.five_bar import FiveBar
from deltaviz.link.board.parameters import parameters_from
from deltaviz.link.board.rotary_delta import RotaryDelta
from deltaviz.link.configuration import configure_from

PRESETS = ["stm32", "trossen", "zheng2023", "deltadraw"]
REFERENCE = Path(__file__).parents[2] / "data" / "reference"
DELTAS = sorted(path.stem for path in REFERENCE.glob("*.json"))
FIVE_BARS = sorted(path.stem for path in (REFERENCE / "five_bar").glob("*.json"))


def tip_of(arms, theta):
    tip = arms.tip(theta)
    assert tip is not None
    return tip


def forward_of(robot, *, side=1):
    """Its arms as the robot has them, in double precision; with side -1, their mirror image."""
    arms = robot.mechanism
    return RotaryDelta(
        base_radius=arms.base_radius,
        effector_radius=arms.effector_radius,
        upper_arm=arms.upper_arm,
        forearm=arms.forearm,
        azimuth=[side * radians(azimuth) for azimuth in arms.azimuths_deg],
        tool_offset=robot.tool_offset,
    )


@pytest.mark.parametrize("name", PRESETS)
def test_its_own_forward_kinematics_agrees_with_the_robots(name):
    robot = load_robot(name)
    forward = forward_of(robot)
    rng = np.random.default_rng(3)
    theta = rng.uniform(radians(-60), radians(110), (400, 3))
    theirs = robot.forward(theta)
    round_trip = robot.inverse(theirs)
    reached = 0
    for angles, tip, back in zip(theta, theirs, round_trip, strict=True):
        ours = forward.tip(angles)
        if ours is not None:
            reached += 1
            assert ours == pytest.approx(tuple(tip), abs=1e-9)
        elif not np.isnan(tip).any():
            # Refused although the forearms meet: an arm is past the edge of its reach.
            assert np.isnan(back).any() or np.abs(back - angles).max() > 1e-6
    assert reached > 300


@pytest.mark.parametrize("name", PRESETS)
def test_what_it_is_told_of_the_arms_gives_the_same_tip_within_a_tenth_of_a_micrometre(name):
    robot = load_robot(name)
    parameters = parameters_from(configure_from(robot), tick_hz=200_000)
    assert parameters is not None
    told = parameters.kinematics
    assert told is not None
    for theta in np.random.default_rng(4).uniform(radians(-20), radians(60), (100, 3)):
        assert told.tip(theta) == pytest.approx(forward_of(robot).tip(theta), abs=1e-4)


def test_unequal_arms_each_have_their_own_lengths():
    geometry = {
        "base_radius": (115.0, 117.0, 113.0),
        "effector_radius": (75.0, 74.0, 76.0),
        "upper_arm": (125.0, 126.0, 124.0),
        "forearm": (338.0, 336.0, 340.0),
        "azimuth": (0.0, 2.1, 4.2),
    }
    forward = RotaryDelta(**geometry, tool_offset=(0.0, 0.0, -10.0))
    theta = (0.2, 0.5, 0.1)
    tip = forward.tip(theta)
    assert tip is not None
    x, y, z = tip
    for i in range(3):
        out = (
            geometry["base_radius"][i]
            - geometry["effector_radius"][i]
            + geometry["upper_arm"][i] * np.cos(theta[i])
        )
        elbow = (
            out * np.cos(geometry["azimuth"][i]),
            out * np.sin(geometry["azimuth"][i]),
            -geometry["upper_arm"][i] * np.sin(theta[i]),
        )
        length = np.linalg.norm(np.subtract((x, y, z + 10.0), elbow))
        assert length == pytest.approx(geometry["forearm"][i], abs=1e-9)


def delta_of(geometry):
    return RotaryDelta(
        base_radius=[geometry["base_radius"]] * 3,
        effector_radius=[geometry["effector_radius"]] * 3,
        upper_arm=[geometry["upper_arm"]] * 3,
        forearm=[geometry["forearm"]] * 3,
        azimuth=[radians(azimuth) for azimuth in (0, 120, 240)],
        tool_offset=(0.0, 0.0, 0.0),
    )


def five_bar_of(geometry, tool_offset=(0.0, 0.0, 0.0)):
    return FiveBar(
        **{name: (value,) * 2 for name, value in geometry.items()}, tool_offset=tool_offset
    )


@pytest.fixture(scope="module", params=DELTAS)
def delta(request):
    cases = json.loads((REFERENCE / f"{request.param}.json").read_text())
    return delta_of(cases["geometry"]), cases


@pytest.fixture(scope="module", params=FIVE_BARS)
def five_bar(request):
    cases = json.loads((REFERENCE / "five_bar" / f"{request.param}.json").read_text())
    return five_bar_of(cases["geometry"]), cases


def test_angles_of_a_delta(delta):
    arms, cases = delta
    for case in cases["ik"]:
        assert arms.angles(case["xyz"]) == pytest.approx(np.radians(case["theta_deg"]), abs=1e-12)
    for case in cases["unreachable"]:
        assert arms.angles(case["xyz"]) is None


def test_how_joints_move_when_the_tip_does(delta):
    arms, cases = delta
    for case in cases["ik"]:
        moves = case["velocity_case"]
        found = arms.motions(case["xyz"], moves["v"], moves["a"])
        assert found is not None
        assert [m.angle for m in found] == pytest.approx(np.radians(case["theta_deg"]), abs=1e-12)
        assert [m.rate for m in found] == pytest.approx(moves["theta_dot"], rel=1e-9)
        assert [m.acceleration for m in found] == pytest.approx(moves["theta_ddot"], rel=1e-8)
        inverse = np.linalg.inv(case["J"])
        assert [m.gain for m in found] == pytest.approx(np.linalg.norm(inverse, axis=1), rel=1e-9)


def test_above_the_elbows_no_joint_moves():
    """There, too, the forearms may meet with the elbows outside: in the wrong assembly."""
    cases = json.loads((REFERENCE / "trossen.json").read_text())
    arms, seen = delta_of(cases["geometry"]), 0
    for case in cases["fk"]:
        other = case["xyz_other_assembly"]
        angles = arms.angles(other)
        if angles is not None and np.allclose(angles, np.radians(case["theta_deg"]), atol=1e-9):
            seen += 1
            assert arms.motions(other, (1.0, 0.0, 0.0), (0.0, 0.0, 0.0)) is None
    assert seen > 0


def test_a_five_bar(five_bar):
    arms, cases = five_bar
    assert len(cases["ik"]) == 50
    for case in cases["ik"]:
        x, z = case["xy"]
        theta = np.radians(case["theta_deg"])
        assert arms.angles((x, 0.0, z)) == pytest.approx(theta, abs=1e-12)
        assert arms.tip(theta) == pytest.approx((x, 0.0, z), abs=1e-9)
        rates = np.linalg.solve(case["J"], (20.0, -30.0))
        found = arms.motions((x, 0.0, z), (20.0, 0.0, -30.0), (0.0, 0.0, 0.0))
        assert found is not None
        assert [m.rate for m in found] == pytest.approx(rates, rel=1e-9)


@settings(deadline=None)
@given(left=st.floats(-0.3, 1.0), right=st.floats(-0.3, 1.0), still=st.integers(0, 1))
def test_a_five_bars_accelerations_are_those_of_its_positions(left, right, still):
    """Second differences along a parabola of the tip."""
    arms = five_bar_of(
        {"base_half": 150.0, "platform_half": 50.0, "upper_arm": 350.0, "forearm": 800.0}
    )
    tip = np.array(tip_of(arms, (left, right)))
    velocity = np.array((70.0, 0.0, -120.0)) * (1 - still)
    turn = np.array((300.0, 0.0, -400.0))
    found = arms.motions(tuple(tip), tuple(velocity), tuple(turn))
    assert found is not None
    h = 1e-3
    before, here, after = (
        np.array(arms.angles(tuple(tip + velocity * t + turn * t * t / 2))) for t in (-h, 0.0, h)
    )
    expected = (after - 2 * here + before) / h**2
    assert [m.acceleration for m in found] == pytest.approx(expected, rel=1e-3, abs=1e-4)


def test_a_five_bar_reaches_only_its_plane():
    geometry = {"base_half": 60.0, "platform_half": 20.0, "upper_arm": 100.0, "forearm": 200.0}
    arms = five_bar_of(geometry, tool_offset=(5.0, 7.0, -30.0))
    tip = tip_of(arms, (0.3, 0.2))
    assert tip[1] == 7.0
    assert arms.angles(tip) == pytest.approx((0.3, 0.2))
    for beside in (-0.02, 0.02):
        assert arms.angles((tip[0], tip[1] + beside, tip[2])) is None
    assert arms.angles((tip[0], tip[1] + 0.009, tip[2])) is not None


def test_a_five_bars_arms_may_differ():
    arms = FiveBar(
        base_half=(60.0, 62.0),
        platform_half=(20.0, 19.0),
        upper_arm=(100.0, 104.0),
        forearm=(200.0, 190.0),
        tool_offset=(0.0, 0.0, 0.0),
    )
    theta = (0.4, 0.6)
    x, _, z = tip_of(arms, theta)
    left = (-(40.0 + 100.0 * np.cos(0.4)), -100.0 * np.sin(0.4))
    right = (43.0 + 104.0 * np.cos(0.6), -104.0 * np.sin(0.6))
    assert np.hypot(x - left[0], z - left[1]) == pytest.approx(200.0)
    assert np.hypot(x - right[0], z - right[1]) == pytest.approx(190.0)
    assert z < min(left[1], right[1])


def test_arms_that_stand_clockwise():
    robot = load_robot("stm32")
    x, y, z = tip_of(forward_of(robot), (0.1, 0.5, 0.3))
    mirrored = forward_of(robot, side=-1)
    assert mirrored.tip((0.1, 0.5, 0.3)) == pytest.approx((x, -y, z))
    assert mirrored.motions((x, -y, z), (1.0, 0.0, 0.0), (0.0, 0.0, 0.0)) is not None
