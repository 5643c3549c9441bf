"""The board's kinematics in C against poses solved at 50 digits, and against the robots' own.

Errors are those of single precision: of a forward solution in micrometres, of an inverse one in
thousandths of a degree. One microstep of a small machine is 112 of these.
"""

from __future__ import annotations

import json
from dataclasses import replace
from math import degrees, radians
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deltaviz import load_robot
from deltaviz.link.messages import RobotKind
from deltaviz.mechanism import RotaryDelta
from tests.firmware import c_library
from tests.firmware.two_judges import gantry

REFERENCE = Path(__file__).parents[1] / "data" / "reference"
FIVE_BARS = sorted(path.stem for path in (REFERENCE / "five_bar").glob("*.json"))
PRESETS = ["stm32", "trossen", "zheng2023", "deltadraw"]
TICK_HZ = 200_000

FORWARD_UM = 0.25  # at all reference poses; their longest arm reaches 1.8 m
INVERSE_MDEG = 0.5
MILLIONTHS = 1.0  # of upper arm and forearm together, wherever the host lets a robot go

UNEVEN = RotaryDelta(
    base_radius=(115.0, 117.5, 112.5),
    effector_radius=(75.0, 74.0, 77.0),
    upper_arm=(125.0, 122.0, 127.5),
    forearm=(338.0, 335.0, 342.0),
    azimuths_deg=(3.0, 118.0, 245.0),
)
CLOCKWISE = RotaryDelta(
    base_radius=115, effector_radius=75, upper_arm=125, forearm=338, azimuths_deg=(240, 120, 0)
)
MECHANISMS = {name: load_robot(name).mechanism for name in PRESETS} | {
    "uneven": UNEVEN,
    "clockwise": CLOCKWISE,
}


def board(mechanism: Any, **changes: Any) -> c_library.CParameters:
    configure = c_library.delta_configure(mechanism, **changes)
    parameters = c_library.parameters_from(configure, tick_hz=TICK_HZ)
    assert parameters is not None
    return parameters


def apart(theta, expected):
    """Difference of angles, however they wrap, in thousandths of a degree."""
    turned = np.subtract(theta, expected)
    return np.degrees(np.abs(np.remainder(turned + np.pi, 2 * np.pi) - np.pi)) * 1000


@pytest.fixture(scope="module", params=sorted(path.stem for path in REFERENCE.glob("*.json")))
def reference(request):
    cases = json.loads((REFERENCE / f"{request.param}.json").read_text())
    mechanism = RotaryDelta(**cases["geometry"])
    return SimpleNamespace(cases=cases, mechanism=mechanism, board=board(mechanism))


@pytest.fixture(scope="module", params=FIVE_BARS)
def five_bar(request):
    cases = json.loads((REFERENCE / "five_bar" / f"{request.param}.json").read_text())
    each = {name: (value,) * 2 for name, value in cases["geometry"].items()}
    configure = replace(
        gantry(2).configure,
        kind=RobotKind.FIVE_BAR,
        base_radius=each["base_half"],
        effector_radius=each["platform_half"],
        upper_arm=each["upper_arm"],
        forearm=each["forearm"],
        ready=(300, 300),
    )
    parameters = c_library.parameters_from(configure, tick_hz=TICK_HZ)
    assert parameters is not None
    return SimpleNamespace(cases=cases, board=parameters)


@pytest.fixture(scope="module", params=MECHANISMS)
def robot(request):
    """A mechanism, the board's parameters for it, and random poses that the host would allow."""
    mechanism = MECHANISMS[request.param]
    theta = np.random.default_rng(1).uniform(-np.pi / 2, np.pi * 0.75, (4000, 3))
    xyz = mechanism.forward(theta)
    legal = (mechanism.margins(xyz, theta) >= 0).all(axis=-1)
    return SimpleNamespace(
        mechanism=mechanism, board=board(mechanism), theta=theta[legal], xyz=xyz[legal]
    )


def test_forward(reference):
    errors = []
    for case in reference.cases["fk"]:
        tip = c_library.forward(reference.board, np.radians(case["theta_deg"]))
        if all(case["elbow_out"]):
            assert tip is not None, case
            errors.append(np.abs(np.subtract(tip, case["xyz"])).max() * 1000)
        else:
            assert tip is None, case
    assert len(errors) > 40
    assert max(errors) < FORWARD_UM, f"forward is off by {max(errors):.3f} um"


def test_inverse(reference):
    errors = []
    for case in reference.cases["ik"]:
        theta = c_library.inverse(reference.board, case["xyz"])
        assert theta is not None, case
        errors.append(apart(theta, np.radians(case["theta_deg"])).max())
    assert len(errors) == 100
    assert max(errors) < INVERSE_MDEG, f"inverse is off by {max(errors):.3f} thousandths of a °"


def test_how_joints_move_when_the_tip_does(reference):
    """A pose near the edge of reach is among them; the others are a hundred times better."""
    for case in reference.cases["ik"]:
        moves = case["velocity_case"]
        found = c_library.joint_motions(reference.board, case["xyz"], moves["v"], moves["a"])
        assert found is not None
        inverse = np.linalg.inv(case["J"])
        sizes = np.linalg.norm(inverse, axis=1)
        assert [m.gain for m in found] == pytest.approx(sizes, rel=1e-3)
        for i, motion in enumerate(found):
            assert motion.rate == pytest.approx(
                moves["theta_dot"][i], abs=3e-5 * sizes[i] * np.linalg.norm(moves["v"])
            )
            assert motion.acceleration == pytest.approx(
                moves["theta_ddot"][i], abs=2e-4 * (sizes[i] * np.linalg.norm(moves["a"]) + 1)
            )


def test_a_five_bar(five_bar):
    forward, inverse = [], []
    for case in five_bar.cases["ik"]:
        (x, z), theta = case["xy"], np.radians(case["theta_deg"])
        tip = c_library.forward(five_bar.board, theta)
        back = c_library.inverse(five_bar.board, (x, 0.0, z))
        assert tip is not None
        assert back is not None
        forward.append(np.abs(np.subtract(tip, (x, 0.0, z))).max() * 1000)
        inverse.append(apart(back, theta).max())
        rates = np.linalg.solve(case["J"], (20.0, -30.0))
        found = c_library.joint_motions(
            five_bar.board, (x, 0.0, z), (20.0, 0.0, -30.0), (0.0, 0.0, 0.0)
        )
        assert found is not None
        assert [m.rate for m in found] == pytest.approx(rates, abs=1e-5 * np.abs(rates).max())
    assert len(forward) == 50
    assert max(forward) < FORWARD_UM * 4, f"forward is off by {max(forward):.3f} um"
    assert max(inverse) < INVERSE_MDEG, f"inverse is off by {max(inverse):.3f} thousandths of a °"


def test_out_of_reach(reference):
    for case in reference.cases["unreachable"]:
        assert max(case["margin_mm"]) > 0.1
        assert c_library.inverse(reference.board, case["xyz"]) is None, case


def test_at_the_edge_of_reach(reference):
    """At the edge rounding decides whether it reaches; 10 um to either side it may not."""
    for case in reference.cases["singular_type1"]:
        theta = np.radians(case["theta_deg"])
        leg, sign = case["leg"], 1 if case["kind"] == "extended" else -1
        edge = np.array(case["xyz"])
        elbow = reference.mechanism.elbows(theta)[leg]
        away = (edge - elbow) / np.linalg.norm(edge - elbow) * sign * 0.010
        inside = c_library.inverse(reference.board, edge - away)
        assert inside is not None, case
        assert np.delete(apart(inside, reference.mechanism.inverse(edge - away)), leg).max() < 1
        assert c_library.inverse(reference.board, edge + away) is None, case


def test_forearms_that_cannot_meet_or_meet_everywhere(reference):
    for kind in ("fk_no_solution", "fk_indeterminate"):
        for case in reference.cases[kind]:
            assert c_library.forward(reference.board, np.radians(case["theta_deg"])) is None, case


def test_wherever_the_host_lets_a_robot_go(robot):
    assert len(robot.theta) > 2000
    size = max(robot.mechanism.joint_scale) + max(robot.mechanism.forearm)
    forward, inverse = [], []
    for theta, xyz in zip(robot.theta, robot.xyz, strict=True):
        tip, back = c_library.forward(robot.board, theta), c_library.inverse(robot.board, xyz)
        assert tip is not None, theta
        assert back is not None, xyz
        forward.append(np.linalg.norm(np.subtract(tip, xyz)) / size * 1e6)
        inverse.append(apart(back, theta).max())
    assert max(forward) < MILLIONTHS, f"forward is off by {max(forward):.2f} millionths"
    assert max(inverse) < INVERSE_MDEG, f"inverse is off by {max(inverse):.3f} thousandths of a °"


def test_reach_is_judged_as_by_the_robot(robot):
    """Points in and around the workspace; those within 10 um of the edge are left out."""
    most = max(robot.mechanism.joint_scale) + max(robot.mechanism.forearm)
    points = np.random.default_rng(2).uniform(-most, most, (4000, 3))
    misses = np.max(robot.mechanism.misses(points), axis=(0, -1))
    reached = 0
    for xyz, miss in zip(points, misses, strict=True):
        if abs(miss) > 0.010:
            assert (c_library.inverse(robot.board, xyz) is not None) == (miss < 0), (xyz, miss)
            reached += miss < 0
    assert reached > 50


def test_forward_is_none_where_the_inverse_would_not_return(robot):
    theta = np.random.default_rng(3).uniform(-np.pi, np.pi, (4000, 3))
    xyz = robot.mechanism.forward(theta)
    margins = robot.mechanism.margins(xyz, theta)
    refused = 0
    for angles, tip, margin in zip(theta, xyz, margins, strict=True):
        ours = c_library.forward(robot.board, angles)
        if np.isnan(tip).any() or (margin[:3] < -10).any():  # mm past an arm's edge, about
            refused += 1
            assert ours is None, angles
        elif (margin > 0).all():
            assert ours is not None, angles
    assert refused > 400


@pytest.mark.parametrize("name", PRESETS)
@settings(deadline=None)
@given(data=st.data())
def test_round_trip(name, data):
    """To the tip that a person sees, within all the robot's limits."""
    robot = load_robot(name)
    parameters = board(robot.mechanism, tool_offset=tuple(robot.tool_offset))
    angles = zip(robot.joints.min, robot.joints.max, strict=True)
    theta = [data.draw(st.floats(low, high), "theta") for low, high in angles]
    tip = robot.forward(np.array(theta))
    if np.isnan(tip).any() or not robot.reach(tip).legal:
        return
    back = c_library.inverse(parameters, tuple(tip))
    assert back is not None
    again = c_library.forward(parameters, back)
    assert again is not None
    off = float(np.abs(np.subtract(again, tip)).max()) * 1000
    size = max(robot.mechanism.joint_scale) + max(robot.mechanism.forearm)
    assert off < 2e-3 * MILLIONTHS * size, f"the round trip is off by {off:.2f} um"


def test_upper_arms_straight_up_straight_down_and_level():
    mechanism = MECHANISMS["stm32"]
    for theta in np.radians([(90, 90, 90), (90, 0, 0), (-0.0, 90, 89.9), (-89, -89, 0), (0, 0, 0)]):
        xyz = mechanism.forward(theta)
        tip = c_library.forward(board(mechanism), theta)
        reached = np.abs(mechanism.inverse(xyz) - theta).max() < 1e-6
        assert (tip is not None) == reached
        if tip is not None:
            assert np.abs(np.subtract(tip, xyz)).max() < 1e-3
            back = c_library.inverse(board(mechanism), tip)
            assert back is not None
            assert apart(back, theta).max() < INVERSE_MDEG


def test_effector_in_the_plane_of_the_motors():
    """Where a solution that divides by z fails; the tool shifts the tip."""
    mechanism = RotaryDelta(base_radius=100, effector_radius=40, upper_arm=150, forearm=160)
    parameters = board(mechanism, tool_offset=(3.0, -2.0, -15.0), ready=(1000,) * 3)
    for xyz in ((0.0, 0.0, 0.0), (20.0, 10.0, 0.0), (0.0, -30.0, 0.0)):
        expected = mechanism.inverse(xyz)
        assert np.isfinite(expected).all()
        theta = c_library.inverse(parameters, tuple(np.add(xyz, (3.0, -2.0, -15.0))))
        assert theta is not None
        assert apart(theta, expected).max() < INVERSE_MDEG


def test_no_numbers_and_no_tip():
    parameters = board(MECHANISMS["stm32"])
    for odd in (float("nan"), float("inf"), -float("inf"), 1e30):
        assert c_library.inverse(parameters, (0.0, odd, -300.0)) is None
        assert odd == 1e30 or c_library.forward(parameters, (0.1, odd, 0.1)) is None


def test_a_board_without_a_geometry_knows_no_tip():
    configure = c_library.delta_configure(UNEVEN, kind=RobotKind.JOINTS_ONLY)
    parameters = c_library.parameters_from(configure, tick_hz=TICK_HZ)
    assert parameters is not None
    assert c_library.forward(parameters, (0.1, 0.2, 0.3)) is None
    assert c_library.inverse(parameters, (0.0, 0.0, -300.0)) is None


def test_published_poses():
    """FireStep's own tests: tip relative to 247.893 mm below the base."""
    mechanism = RotaryDelta.from_sides(f=190.526, e=131.636, upper_arm=90, forearm=270)
    parameters = board(mechanism, tool_offset=(0.0, 0.0, 247.893))
    theta = c_library.inverse(parameters, (1.0, 2.0, 3.0))
    assert theta is not None
    assert sorted(map(degrees, theta)) == pytest.approx([-2.438102, -1.955057, -1.360184], abs=1e-4)
    tip = c_library.forward(parameters, (radians(1),) * 3)
    assert tip == pytest.approx((0.0, 0.0, -1.57663), abs=1e-4)
