"""Paper, tables: how much of them is reached, judged by elementary triangles."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from deltaviz.robots import Robot, load_robot
from deltaviz.robots.workspace import Limit, Margins
from deltaviz.robots.workspace.cells import hull
from deltaviz.robots.workspace.sheets import (
    Chart,
    Disc,
    Rectangle,
    Sheet,
    best_level,
    farthest,
    spare,
)
from tests.robots.workspace import oracle

TRIANGLES = Limit.REACH | Limit.JOINTS | Limit.BALL_JOINTS  # what the judge knows of


@pytest.fixture(scope="module")
def trossen() -> Robot:
    return load_robot("trossen")


@pytest.fixture(scope="module")
def margins(trossen: Robot) -> Margins:
    return Margins.of(trossen, TRIANGLES)


def points_of(sheet: Sheet, apart: float) -> np.ndarray:
    box = sheet.box
    x, y = (
        np.arange(low + apart / 2, high, apart)
        for low, high in zip(box.low[:2], box.high[:2], strict=True)
    )
    grid = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    points = np.column_stack((grid, np.full(len(grid), sheet.level)))
    return points[sheet.depth(points) >= 0]


@pytest.mark.parametrize("sheet", [Rectangle((210, 297), -156), Disc(300, -170)])
def test_what_is_out_of_reach_is_the_judge_s(
    trossen: Robot, margins: Margins, sheet: Sheet
) -> None:
    dense = points_of(sheet, 2.0)
    legal = oracle.reached(trossen, dense)
    chart = Chart.of(margins, sheet)
    assert chart.share == pytest.approx(legal.mean(), abs=0.005)
    assert 0.3 < chart.share < 0.9
    miss = farthest(margins, chart)
    assert miss is not None
    assert not oracle.reached(trossen, miss.point[None])[0]
    legal_points = dense[legal]

    def away(points: np.ndarray) -> np.ndarray:
        """From each to the nearest legal point of the sheet."""
        return np.array([np.linalg.norm(legal_points - p, axis=-1).min() for p in points])

    assert miss.out == pytest.approx(away(miss.point[None])[0], abs=2.5)
    assert miss.out >= away(dense[~legal][::7]).max() - 3.0


def rim(sheet: Sheet) -> np.ndarray:
    box = sheet.box
    if isinstance(sheet, Disc):
        turns = np.linspace(0, 2 * np.pi, 3000)
        ring = sheet.diameter / 2 * np.column_stack((np.cos(turns), np.sin(turns)))
    else:
        shares = np.linspace(0, 1, 800)[:, None]
        (x0, y0), (x1, y1) = box.low[:2], box.high[:2]
        corners = np.array(((x0, y0), (x1, y0), (x1, y1), (x0, y1), (x0, y0)))
        ring = np.concatenate([a + shares * (b - a) for a, b in itertools.pairwise(corners)])
    return np.column_stack((ring, np.full(len(ring), sheet.level)))


@pytest.mark.parametrize("of", ["rectangle", "disc", "disc that is too large"])
def test_what_fits_can_grow_by_what_is_to_spare_and_no_more(
    trossen: Robot, margins: Margins, of: str
) -> None:
    def grown(by: float) -> Sheet:
        if of == "rectangle":
            return Rectangle((100 + 2 * by, 80 + 2 * by), -156)
        return Disc((140 if of == "disc" else 400) + 2 * by, -156)

    left = spare(margins, grown(0.0))
    assert (left > 0) == (of != "disc that is too large")
    assert oracle.reached(trossen, rim(grown(left - 0.01))).all()
    assert not oracle.reached(trossen, rim(grown(left + 0.2))).all()


def test_it_lies_where_most_of_it_is_reached(trossen: Robot, margins: Margins) -> None:
    box = hull(margins)
    assert box is not None

    def share(level: float) -> float:
        return float(oracle.reached(trossen, points_of(Rectangle((210, 297), level), 6.0)).mean())

    level = best_level(margins, box, lambda z: Rectangle((210, 297), z))
    heights = np.linspace(box.low[2], box.high[2], 30)
    assert share(level) >= max(map(share, heights.tolist())) - 0.03
