"""The singular surfaces, judged by how a closed arm's length changes when it is moved a little.

An arm is closed where F(P, θ) = |P - elbow(θ)|² - l² is 0. Of type 1 is where θ does not change F
of one arm, of type 2 where a direction of P changes F of none.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from deltaviz.mechanism import FiveBar, RotaryDelta
from deltaviz.robots import Robot, load_robot
from deltaviz.robots.workspace.singular import Kind, Singular, singular

STEP = 1e-4
Judge = Callable[[RotaryDelta, np.ndarray, np.ndarray], np.ndarray]


@pytest.fixture(scope="module")
def robot() -> Robot:
    return load_robot("stm32")


@pytest.fixture(scope="module")
def surfaces(robot: Robot) -> dict[Kind, Singular]:
    found = {kind: singular(robot, kind) for kind in Kind}
    return {kind: surface for kind, surface in found.items() if surface is not None}


def squares(mechanism: RotaryDelta, points: np.ndarray, theta: np.ndarray) -> np.ndarray:
    """|P - elbow|², (n, 3) mm², from the robot's measures alone."""
    columns = []
    for i, azimuth in enumerate(np.radians(mechanism.azimuths_deg)):
        out = mechanism.base_radius[i] - mechanism.effector_radius[i]
        out = out + mechanism.upper_arm[i] * np.cos(theta[:, i])
        down = -mechanism.upper_arm[i] * np.sin(theta[:, i])
        elbow = np.stack((out * math.cos(azimuth), out * math.sin(azimuth), down), axis=-1)
        columns.append(((points - elbow) ** 2).sum(axis=-1))
    return np.stack(columns, axis=-1)


def flatness(mechanism: RotaryDelta, points: np.ndarray, theta: np.ndarray) -> np.ndarray:
    """|det dF/dP| of rows brought to length 1."""
    slopes = [
        (squares(mechanism, points + step, theta) - squares(mechanism, points - step, theta))
        for step in STEP * np.eye(3)
    ]
    rows = np.stack(slopes, axis=-1)
    return np.abs(np.linalg.det(rows / np.linalg.norm(rows, axis=-1, keepdims=True)))


def turning(mechanism: RotaryDelta, points: np.ndarray, theta: np.ndarray) -> np.ndarray:
    """|dF/dθ| of the arm that feels its joint least, as a share of the most that it can be."""
    most = 2 * np.multiply(mechanism.upper_arm, mechanism.forearm)
    ahead, behind = (squares(mechanism, points, theta + way) for way in (STEP, -STEP))
    return (np.abs(ahead - behind) / (2 * STEP * most)).min(axis=-1)


@pytest.mark.parametrize(("kind", "judge"), [(Kind.TYPE_1, turning), (Kind.TYPE_2, flatness)])
def test_control_is_lost_on_the_surfaces_and_not_in_the_workspace(
    robot: Robot, surfaces: dict[Kind, Singular], kind: Kind, judge: Judge
) -> None:
    mechanism = robot.mechanism
    assert isinstance(mechanism, RotaryDelta)
    where = surfaces[kind].vertices
    inside = np.array([(0.0, 0.0, -330.0), (60.0, -40.0, -300.0)])
    for points, is_lost in ((where, True), (inside, False)):
        centre = points - np.asarray(robot.tool_offset)
        theta = mechanism.nearest_angles(centre)
        lengths = np.sqrt(squares(mechanism, centre, theta))
        assert np.abs(lengths - mechanism.forearm).max() < 0.3  # mm: the arms are closed
        value = judge(mechanism, centre, theta)
        if is_lost:  # but for chords at the rims, and where two arms' ends meet
            assert np.median(value) < 1e-3
            assert np.percentile(value, 99) < 0.05
            assert value.max() < 0.14  # the workspace's own reserve from type 1
        else:
            assert value.min() > 0.14
    assert len(where) > 1000


def test_how_near_they_come(surfaces: dict[Kind, Singular]) -> None:
    """The reserve from type 1 is documented as about 2 mm; that from type 2 as a tenth of how
    firmly forearms can hold at all, which is farther."""
    first, second = surfaces[Kind.TYPE_1], surfaces[Kind.TYPE_2]
    assert first.distance is not None
    assert second.distance is not None
    assert 1.0 < first.distance < 3.0 < second.distance < second.near


def test_in_a_plane_an_arm_is_straight_at_its_whole_length() -> None:
    robot = load_robot("fivebar")
    mechanism = robot.mechanism
    assert isinstance(mechanism, FiveBar)
    curves = singular(robot, Kind.TYPE_1)
    assert curves is not None
    assert curves.faces.shape[1] == 2
    centre = curves.vertices - np.asarray(robot.tool_offset)
    misses = []
    for i, side in enumerate((-1.0, 1.0)):
        shoulder = (side * (mechanism.base_half[i] - mechanism.platform_half[i]), 0.0)
        from_it = np.linalg.norm(centre - shoulder, axis=1)
        upper_arm, forearm = mechanism.upper_arm[i], mechanism.forearm[i]
        misses += [np.abs(from_it - (upper_arm + forearm)), np.abs(from_it - (forearm - upper_arm))]
    assert np.min(misses, axis=0).max() < 0.05


def test_where_none_is_near_there_is_none() -> None:
    found = singular(load_robot("trossen"), Kind.TYPE_2)
    assert found is not None
    assert found.distance is None
    assert len(found.faces) == 0
