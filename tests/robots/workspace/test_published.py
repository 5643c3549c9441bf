"""The workspaces that the sources tell of: their numbers, and what is right where they err."""

from __future__ import annotations

import numpy as np
import pytest

from deltaviz.robots import Robot, load_robot
from deltaviz.robots.workspace import Cylinder, Limit, Margins
from tests.robots.workspace import oracle
from tests.robots.workspace.conftest import with_

JOINTS = Limit.REACH | Limit.JOINTS


def article_grid() -> np.ndarray:
    """Of the STM32 library: -250:20:250 twice, -460:20:-100, within a radius of 250 mm."""
    side, heights = np.arange(-250.0, 251, 20), np.arange(-460.0, -99, 20)
    points = np.stack(np.meshgrid(side, side, heights, indexing="ij"), axis=-1).reshape(-1, 3)
    return points[np.hypot(points[:, 0], points[:, 1]) <= 250]


@pytest.fixture(scope="module")
def zheng() -> Robot:
    return load_robot("zheng2023")


def test_the_stm32_articles_scan(stm32: Robot) -> None:
    points = article_grid()
    inside = points[Margins.of(stm32, Limit.REACH).least(points) >= 0]
    assert len(inside) == 5928
    radius = np.hypot(inside[:, 0], inside[:, 1])
    widest = {z: radius[inside[:, 2] == z].max() for z in np.unique(inside[:, 2])}
    assert [widest[z] for z in (-460, -440, -400, -360)] == pytest.approx(
        [14.1, 103.0, 192.4, 247.0], abs=0.05
    )
    assert all(r == pytest.approx(247.0, abs=0.1) for z, r in widest.items() if z >= -360)
    within = Margins.of(stm32, JOINTS).least(points) >= 0
    assert within.sum() == 3786


def test_the_stm32_robots_true_reach(stm32: Robot) -> None:
    """It is no dome: the centre is reached between two heights only, and 250 mm was the scan's."""
    workspace = stm32.workspace(Limit.REACH)
    axis = np.zeros((20_001, 3))
    axis[:, 2] = np.linspace(-480, -180, len(axis))
    on_axis = axis[workspace.margins.least(axis) >= 0, 2]
    assert (on_axis.min(), on_axis.max()) == pytest.approx((-461.3, -209.2), abs=0.05)
    (row,) = workspace.reach([-120.0])
    angle, radius = np.meshgrid(np.radians(np.arange(0, 121, 0.5)), np.arange(0, 420, 0.25))
    x, y = (radius * np.cos(angle)).ravel(), (radius * np.sin(angle)).ravel()
    slice_ = np.stack((x, y, np.full(x.shape, -120.0)), axis=-1)
    reached = oracle.reached(stm32, slice_, joints=False, lean=False)
    assert row.farthest == pytest.approx(np.hypot(x, y)[reached].max(), abs=0.6)
    assert row.farthest == pytest.approx(380, abs=3)
    assert row.all_around == 0
    assert row.nearest is not None
    assert row.nearest > 100


def test_zhengs_extents(zheng: Robot) -> None:
    """Published are -680..680 in x and y, which three arms cannot have."""
    robot = with_(zheng, min_deg=-47.0, max_deg=88.0)
    box = robot.workspace(JOINTS).extents
    assert (box.low[0], box.high[0]) == pytest.approx((-676, 737), abs=1)
    assert (box.low[2], box.high[2]) == pytest.approx((-1230, -410), abs=5)
    assert box.high[1] == pytest.approx(680, abs=10)
    assert box.low[1] == pytest.approx(-box.high[1], abs=0.5)


def test_the_largest_cylinder_of_zhengs_height(zheng: Robot) -> None:
    found = zheng.workspace(JOINTS).largest_cylinder(height=260.0)
    assert found is not None
    assert isinstance(found.shape, Cylinder)
    assert found.shape.diameter == pytest.approx(1010, abs=5)
    assert found.shape.floor == pytest.approx(-906, abs=5)
    assert found.most < found.shape.diameter + 2


@pytest.mark.parametrize(
    ("low", "high", "lean", "fits"),
    [
        (-51.1, 86.0, 38.6, True),
        (-51.0, 86.0, 38.6, False),
        (-51.1, 85.9, 38.6, False),
        (-51.1, 86.0, 38.4, False),
        (-45.0, 90.0, 45.0, False),
    ],
)
def test_what_zhengs_wide_cylinder_takes(
    zheng: Robot, low: float, high: float, lean: float, fits: bool
) -> None:
    """Diameter 1120 mm between -780 and -620: 160 mm high, not 260 as is said."""
    robot = with_(zheng, min_deg=low, max_deg=high, ball_joint_max_deg=lean)
    workspace = robot.workspace(JOINTS | Limit.BALL_JOINTS, tolerance=0.05)
    assert workspace.fit(Cylinder(1120.0, 160.0, -780.0)).fits is fits


@pytest.mark.parametrize(
    ("z", "corners_reached"), [(-225.0, 4), (-235.0, 4), (-245.0, 2), (-275.0, 0)]
)
def test_a_sheet_of_paper_under_the_drawing_robot(z: float, corners_reached: int) -> None:
    """US letter, as its zone says: its corners are reached in the zone's upper part only."""
    robot = load_robot("deltadraw")
    assert (robot.zone.x, robot.zone.y) == ((-107.95, 107.95), (-139.7, 139.7))
    assert robot.zone.z[0] <= z <= robot.zone.z[1]
    corners = np.array([(x, y, z) for x in (-107.95, 107.95) for y in (-139.7, 139.7)])
    reached = robot.workspace().margins.least(corners) >= 0
    assert reached.sum() == corners_reached
    np.testing.assert_array_equal(reached, oracle.reached(robot, corners))
    middle = np.array([(0.0, 0.0, z)])
    assert oracle.reached(robot, middle).all()
