"""Margins: on which side of the limits points are, how far from them, and proofs about balls."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial import KDTree

from deltaviz.mechanism.margin import MarginKind
from deltaviz.robots import Robot
from deltaviz.robots.workspace import Limit, Margins
from deltaviz.robots.workspace.cells import hull, reach_box
from tests.robots.workspace import oracle
from tests.robots.workspace.conftest import with_

ARMS = Limit.REACH | Limit.JOINTS | Limit.BALL_JOINTS


def points_around(robot: Robot, count: int, seed: int = 1) -> np.ndarray:
    box = reach_box(Margins.of(robot))
    return np.random.default_rng(seed).uniform(box.low, box.high, (count, len(box.low)))


@pytest.mark.parametrize(
    ("limits", "joints", "lean"),
    [(Limit.REACH, False, False), (Limit.REACH | Limit.JOINTS, True, False), (ARMS, True, True)],
)
def test_the_sign_is_what_triangles_say(
    robot: Robot, limits: Limit, joints: bool, lean: bool
) -> None:
    points = points_around(robot, 40_000)
    expected = oracle.reached(robot, points, joints=joints, lean=lean)
    margin = Margins.of(robot, limits).least(points)
    assert 400 < expected.sum() < 39_000
    np.testing.assert_array_equal(margin >= 0, expected)


def test_with_all_limits_it_is_what_the_controller_allows(robot: Robot) -> None:
    """The controller's own margins are other code, of angles; collisions it does not know."""
    points = points_around(robot, 40_000)
    with np.errstate(invalid="ignore"):
        allowed = (robot.margins(points, robot.inverse(points)) >= 0).all(axis=-1)
    margin = Margins.of(robot, Limit.ALL & ~Limit.COLLISIONS).least(points)
    assert allowed.sum() > 400
    np.testing.assert_array_equal(margin >= 0, allowed)


def test_inside_it_is_the_distance_from_the_nearest_point_outside(stm32: Robot) -> None:
    """Of arms, joints and ball joints, whose walls have a distance in closed form."""
    margins = Margins.of(stm32, ARMS)
    boundary = stm32.workspace(ARMS, tolerance=0.5).boundary
    inside = points_around(stm32, 20_000)
    inside = inside[margins.least(inside) >= 0]
    margin = margins.least(inside)
    ways = np.random.default_rng(2).normal(size=inside.shape)
    ways /= np.linalg.norm(ways, axis=-1, keepdims=True)
    assert oracle.reached(stm32, inside + 0.999 * margin[:, None] * ways).all()
    distance, _ = KDTree(boundary.vertices).query(inside)
    assert (margin <= distance + 1e-3).all()
    # The nearest vertex is no farther than an edge from the nearest point of the mesh. (How far
    # type 2 is, which limits the reach too, is told about.)
    kinds = np.array([name.kind is MarginKind.TYPE_2 for name in margins.names])
    told = ~kinds[margins.nearest(inside)[1]]
    assert told.mean() > 0.8
    assert (np.hypot(margin + 0.5, boundary.cell) >= distance - 0.5)[told].all()


def test_the_nearest_limit_has_its_name(stm32: Robot) -> None:
    robot = with_(stm32, max_deg=40.0)
    margins = Margins.of(robot)
    tips = robot.forward(np.radians([[-44.9, 0, 0], [20, 39.9, 20]]))
    names = [margins.names[code] for code in margins.nearest(tips)[1]]
    assert (names[0].kind, names[0].arm) == (MarginKind.JOINT_MIN, 0)
    assert (names[1].kind, names[1].arm) == (MarginKind.JOINT_MAX, 1)
    aside = Margins.of(stm32, ARMS).nearest([0.0, 245.0, -280.0])
    assert aside[0] == pytest.approx(338 * math.sin(math.radians(45)) - 245)
    name = margins.names[int(aside[1])]
    assert (name.kind, name.arm) == (MarginKind.BALL_JOINT, 0)


@pytest.mark.parametrize("limits", [Limit.REACH, ARMS, Limit.MACHINE, Limit.ALL])
def test_bounds_hold_everywhere_in_their_balls(robot: Robot, limits: Limit) -> None:
    margins = Margins.of(robot, limits)
    box = hull(margins)
    assert box is not None
    random = np.random.default_rng(3)
    size = float(box.size.max())
    for radius in (0.03 * size, 0.005 * size):
        centres = random.uniform(box.low - radius, box.high + radius, (1500, len(box.low)))
        lower, upper = margins.bounds(centres, radius)
        ways = random.normal(size=(*centres.shape[:1], 60, centres.shape[1]))
        ways /= np.linalg.norm(ways, axis=-1, keepdims=True)
        inner = margins.least(centres[:, None] + radius * ways) >= 0
        assert inner[lower >= 0].all()
        assert not inner[upper < 0].any()
    # They say something: few small balls away from the boundary are left open.
    alike = inner.all(axis=1) | ~inner.any(axis=1)
    assert ((lower >= 0) | (upper < 0))[alike].mean() > 0.75


def test_bounds_hold_where_arms_are_straight_or_folded(stm32: Robot) -> None:
    """Elbows turn fastest there: by the root of the way."""
    margins = Margins.of(stm32, Limit.REACH)
    random = np.random.default_rng(4)
    box = reach_box(margins)
    points = random.uniform(box.low, box.high, (60_000, 3))
    edge = np.abs(margins.some(points, np.zeros((len(points), 1), np.intp))[:, 0]) < 0.5
    centres = points[edge]
    assert len(centres) > 50
    for radius in (0.05, 1.0, 8.0):
        lower, upper = margins.bounds(centres, radius)
        ways = random.normal(size=(len(centres), 200, 3))
        ways /= np.linalg.norm(ways, axis=-1, keepdims=True)
        legal = margins.least(centres[:, None] + radius * ways) >= 0
        assert legal[lower >= 0].all()
        assert not legal[upper < 0].any()


def test_a_wide_joint_range_is_no_narrow_one(stm32: Robot) -> None:
    """More than half a turn between the limits."""
    joints = replace(stm32.joints, min=(math.radians(-140),) * 3, max=(math.radians(110),) * 3)
    robot = replace(stm32, joints=joints)
    points = points_around(robot, 40_000)
    expected = oracle.reached(robot, points, lean=False)
    found = Margins.of(robot, Limit.REACH | Limit.JOINTS).least(points) >= 0
    np.testing.assert_array_equal(found, expected)
