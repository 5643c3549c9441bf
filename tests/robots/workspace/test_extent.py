"""How far a workspace extends, against points by the million."""

from __future__ import annotations

import numpy as np
import pytest

from deltaviz.robots import Robot
from deltaviz.robots.workspace import Limit
from tests.robots.workspace import oracle

ARMS = Limit.REACH | Limit.JOINTS | Limit.BALL_JOINTS


def test_extents_hold_all_points_and_no_more(robot: Robot) -> None:
    workspace = robot.workspace(ARMS, tolerance=2.0)
    box = workspace.extents
    random = np.random.default_rng(11)
    around = workspace.box
    points = random.uniform(around.low - 20, around.high + 20, (150_000, len(box.low)))
    inside = points[oracle.reached(robot, points)]
    assert (inside >= box.low - workspace.fine).all()
    assert (inside <= box.high + workspace.fine).all()
    # Random points come near the true ends, but for sharp corners.
    assert (box.low > inside.min(axis=0) - 0.06 * box.size).all()
    assert (box.high < inside.max(axis=0) + 0.06 * box.size).all()


def test_the_reach_at_heights(robot: Robot) -> None:
    workspace = robot.workspace(ARMS, tolerance=2.0)
    low, high = workspace.extents.low[-1], workspace.extents.high[-1]
    heights = np.linspace(low, high, 5)[1:-1]
    planar = len(robot.tool_offset) == 2
    angle = np.array([0, np.pi]) if planar else np.linspace(0, 2 * np.pi, 361)
    step = 0.002 * np.abs(workspace.extents.low).max()
    radius = step * np.arange(600)
    around = np.stack((np.cos(angle), np.sin(angle)), axis=-1)[:, : 1 if planar else 2]
    for row, z in zip(workspace.reach(heights), heights, strict=True):
        disc = (radius[:, None, None] * around).reshape(-1, around.shape[1])
        points = np.concatenate((disc, np.full((len(disc), 1), z)), axis=1)
        legal = oracle.reached(robot, points).reshape(len(radius), -1)
        some, every = legal.any(axis=1), legal.all(axis=1)
        assert row.z == z
        assert row.farthest == pytest.approx(radius[some].max(), abs=2 * step)
        assert row.nearest == pytest.approx(radius[some].min(), abs=2 * step)
        whole = radius[: int((~every).argmax())] if not every.all() else radius
        assert row.all_around == pytest.approx(whole.max(initial=0.0), abs=2 * step)


def test_where_nothing_is_reached(stm32: Robot) -> None:
    (row,) = stm32.workspace(ARMS).reach([50.0])
    assert (row.farthest, row.all_around, row.nearest) == (None, 0.0, None)


def test_round_heights_without_asking(stm32: Robot) -> None:
    rows = stm32.workspace(ARMS).reach()
    assert [row.z for row in rows] == [-200.0, -250.0, -300.0, -350.0, -400.0, -450.0]
