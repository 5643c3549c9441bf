"""The boundary: on the walls that have a closed form, within its tolerance, closed, whole."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import trimesh
from scipy.spatial import KDTree

from deltaviz.mechanism.margin import MarginKind
from deltaviz.robots import Robot, load_robot
from deltaviz.robots.workspace import Boundary, Limit, levels
from tests.robots.workspace import oracle
from tests.robots.workspace.conftest import with_

ARMS = Limit.REACH | Limit.JOINTS | Limit.BALL_JOINTS


@pytest.fixture(scope="module")
def stm32_boundary(stm32: Robot) -> Boundary:
    return stm32.workspace(ARMS).boundary


def off_wall(robot: Any, kind: MarginKind, arm: int, points: np.ndarray) -> np.ndarray:
    """How far points are from one wall, mm, from its equation in closed form: its value over the
    length of its gradient."""
    mechanism = robot.mechanism
    azimuth = np.radians(mechanism.azimuths_deg[arm])
    upper, fore = mechanism.upper_arm[arm], mechanism.forearm[arm]
    s = mechanism.base_radius[arm] - mechanism.effector_radius[arm]

    def equation(p: np.ndarray) -> np.ndarray:
        u = p[:, 0] * np.cos(azimuth) + p[:, 1] * np.sin(azimuth)
        v = -p[:, 0] * np.sin(azimuth) + p[:, 1] * np.cos(azimuth)
        along, z = u - s, p[:, 2]
        if kind is MarginKind.TYPE_1:
            square = along**2 + v**2 + z**2 + upper**2 - fore**2
            return square**2 - 4 * upper**2 * (along**2 + z**2)
        if kind is MarginKind.BALL_JOINT:
            return np.abs(v) - fore * np.sin(robot.joints.ball_joint_max)
        joints = robot.joints
        limit = joints.min[arm] if kind is MarginKind.JOINT_MIN else joints.max[arm]
        elbow = upper * np.cos(limit), -upper * np.sin(limit)
        return (along - elbow[0]) ** 2 + v**2 + (z - elbow[1]) ** 2 - fore**2

    steps = 1e-3 * np.eye(3)
    slope = [(equation(points + step) - equation(points - step)) / 2e-3 for step in steps]
    return np.abs(equation(points)) / np.linalg.norm(slope, axis=0)


def test_each_vertex_is_on_the_wall_that_it_names(stm32: Robot, stm32_boundary: Boundary) -> None:
    seen = set()
    for code in np.unique(stm32_boundary.limits):
        name = stm32_boundary.names[code]
        assert name.arm is not None
        points = stm32_boundary.vertices[stm32_boundary.limits == code]
        assert off_wall(stm32, name.kind, name.arm, points).max() < 1e-4
        seen.add(name.kind)
    assert seen == {MarginKind.JOINT_MIN, MarginKind.JOINT_MAX, MarginKind.BALL_JOINT}


def distances(boundary: Boundary, points: np.ndarray) -> np.ndarray:
    """From points to the nearest faces of a mesh."""
    corners = boundary.vertices[boundary.faces]
    near = np.asarray(KDTree(corners.mean(axis=1)).query(points, k=60)[-1])
    repeated = np.repeat(points, near.shape[1], axis=0)
    closest = trimesh.triangles.closest_point(corners[near.ravel()], repeated)
    return np.linalg.norm(closest - repeated, axis=-1).reshape(near.shape).min(axis=1)


def test_the_true_boundary_is_within_the_tolerance(stm32: Robot) -> None:
    """Points of it found from inside by halving with other code, edges and corners included."""
    boundary = stm32.workspace(ARMS, tolerance=0.4).boundary
    assert boundary.deviation <= 0.4
    random = np.random.default_rng(5)
    inside = random.uniform((-60, -60, -330), (60, 60, -290), (1500, 3))
    assert oracle.reached(stm32, inside).all()
    way = random.normal(size=inside.shape)
    way /= np.linalg.norm(way, axis=-1, keepdims=True)
    # The first change along each ray.
    shares = np.linspace(0, 500, 1001)
    rays = inside[:, None] + way[:, None] * shares[:, None]
    legal = oracle.reached(stm32, rays.reshape(-1, 3)).reshape(len(inside), -1)
    first = (~legal).argmax(axis=1)
    assert first.min() > 0
    rows = np.arange(len(inside))
    on = oracle.crossing(
        rays[rows, first - 1], rays[rows, first], lambda p: oracle.reached(stm32, p)
    )
    off = distances(boundary, on)
    assert off.max() < 0.4


@pytest.mark.parametrize("name", ["stm32", "zheng2023"])
def test_it_is_a_closed_surface_turned_outward(name: str) -> None:
    boundary = load_robot(name).workspace().boundary
    mesh = trimesh.Trimesh(boundary.vertices, boundary.faces, process=False)
    assert boundary.closed
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    assert boundary.deviation <= 1.0
    assert mesh.volume == pytest.approx(boundary.volume)
    assert boundary.volume > 0


def test_the_volume_is_that_of_the_points_inside(stm32: Robot, stm32_boundary: Boundary) -> None:
    low, high = stm32_boundary.vertices.min(axis=0), stm32_boundary.vertices.max(axis=0)
    points = np.random.default_rng(6).uniform(low, high, (400_000, 3))
    share = oracle.reached(stm32, points).mean()
    assert stm32_boundary.volume == pytest.approx(share * np.prod(high - low), rel=0.005)


def test_a_plane_has_a_closed_line() -> None:
    fivebar = load_robot("fivebar")
    boundary = fivebar.workspace(ARMS, tolerance=0.1).boundary
    assert boundary.dimensions == 2
    assert boundary.closed
    assert boundary.deviation <= 0.1
    low, high = boundary.vertices.min(axis=0), boundary.vertices.max(axis=0)
    axes = [np.linspace(a, b, 1201) for a, b in zip(low, high, strict=True)]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 2)
    share = oracle.reached(fivebar, points).mean()
    assert boundary.volume == pytest.approx(share * np.prod(high - low), rel=0.003)


def test_levels_are_whole_from_the_first(stm32: Robot) -> None:
    found = list(levels(stm32, tolerance=0.8))
    assert len(found) >= 3
    assert all(level.closed and len(level.faces) for level in found)
    assert found[-1].deviation <= 0.8
    assert found[1].deviation > found[-1].deviation
    assert found[0].volume == pytest.approx(found[-1].volume, rel=0.02)
    assert len(found[0].faces) < len(found[-1].faces) / 3


def test_levels_are_not_computed_before_they_are_asked_for(
    stm32: Robot, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(levels.__globals__, "refine", None)  # a call would raise
    assert len(next(levels(stm32)).vertices)


def test_a_small_workspace_is_found() -> None:
    """One degree for each joint: a lens of some millimetres within a metre of reach."""
    robot = with_(load_robot("stm32"), min_deg=-45.0, max_deg=-44.0)
    boundary = robot.workspace(Limit.REACH | Limit.JOINTS, tolerance=0.5).boundary
    low, high = boundary.vertices.min(axis=0), boundary.vertices.max(axis=0)
    theta = np.radians(np.random.default_rng(7).uniform(-45, -44, (2000, 3)))
    tips = robot.forward(theta)
    assert (tips >= low - 0.5).all()
    assert (tips <= high + 0.5).all()
    assert np.ptp(tips, axis=0) == pytest.approx(high - low, rel=0.15)


def test_a_finer_tolerance_is_kept_too(stm32: Robot) -> None:
    coarse = stm32.workspace(tolerance=2.0).boundary
    fine = stm32.workspace(tolerance=0.3).boundary
    assert coarse.deviation <= 2.0
    assert fine.deviation <= 0.3
    assert fine.volume == pytest.approx(coarse.volume, rel=0.005)
