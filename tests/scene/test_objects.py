"""Things that lie in the scene: what is drawn and told of them, judged point by point."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from deltaviz.mechanism import RotaryDelta
from deltaviz.robots import Robot, load_robot
from deltaviz.scene.workspace.laying import UNREACHED, Lay, Serve
from deltaviz.scene.workspace.objects import Kind, Thing
from tests.robots.workspace import oracle


def is_hatched(pixels: np.ndarray) -> np.ndarray:
    """(..., 4) to (...): one of the hatch's two colours, which are both redder than green."""
    return (pixels[..., 3] == 255) & (pixels[..., 0] > pixels[..., 1])


@pytest.mark.parametrize("kind", [Kind.A4, Kind.TABLE, Kind.ROUND_TABLE, Kind.BELT_X])
def test_what_is_hatched_is_what_the_arms_do_not_reach(
    kind: Kind, steady: np.random.Generator
) -> None:
    robot, level = load_robot("trossen"), -170.0
    (laid,) = Lay(robot, Thing(kind, 300, 240), level).pictures()
    section = laid.section
    size = section.high - section.low
    rows, columns = section.image.shape[:2]
    shares = steady.random((3000, 2))
    points = 1000 * (section.low + np.column_stack((shares * size[:2], np.zeros(3000))))
    assert points[:, 2] == pytest.approx(level)
    legal = oracle.reached(robot, points)
    pixel = 1000 * size[0] / columns
    near = [oracle.reached(robot, points + pixel * np.array(way)) for way in
            ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0))]  # fmt: skip
    sure = (np.array(near) == legal).all(axis=0)
    pixels = section.image[(shares[:, 1] * rows).astype(int), (shares[:, 0] * columns).astype(int)]
    on = np.abs(np.linalg.norm(points[:, :2], axis=1)) < 149 if kind is Kind.ROUND_TABLE else sure
    sure &= on
    assert (is_hatched(pixels[sure]) == ~legal[sure]).all()
    assert 200 < legal[sure].sum() < sure.sum() - 200
    if kind is Kind.ROUND_TABLE:
        corners = np.linalg.norm(points[:, :2], axis=1) > 152
        assert not pixels[corners, 3].any()


def test_the_hatch_can_be_told_without_its_hue() -> None:
    (laid,) = Lay(load_robot("trossen"), Thing(Kind.A4, 0, 0), -170.0).pictures()
    image = laid.section.image
    lightness = image[..., :3].astype(float) @ (0.21, 0.72, 0.07)
    hatched = lightness[is_hatched(image)]
    assert np.quantile(hatched, 0.8) - np.quantile(hatched, 0.2) > 80
    assert tuple(UNREACHED) in {tuple(p) for p in image[..., :3].reshape(-1, 3).tolist()}


def test_the_farthest_point_is_said_and_why() -> None:
    robot = load_robot("trossen")
    (laid,) = Lay(robot, Thing(Kind.TABLE, 300, 200), -156.0).pictures()
    assert "Table 300 by 200 mm at Z -156 mm: does not fit" in laid.text
    grid = np.stack(np.meshgrid(np.linspace(-150, 150, 301), np.linspace(-100, 100, 201)), -1)
    points = np.column_stack((grid.reshape(-1, 2), np.full(301 * 201, -156.0)))
    assert f"{100 * oracle.reached(robot, points).mean():.0f}\u00a0% within" in laid.text
    assert "at X -150, Y -100 mm: arm 2 upper joint limit." in laid.text


def test_where_no_height_is_chosen_it_lies_where_it_fits(robot: Robot) -> None:
    (laid,) = Lay(robot, Thing(Kind.A4, 0, 0), None).pictures()
    assert "A4 paper" in laid.text
    assert ": fits, with at least" in laid.text
    x, y = np.meshgrid(np.linspace(-105, 105, 40), np.linspace(-148.5, 148.5, 40))
    points = np.column_stack((x.ravel(), y.ravel(), np.full(x.size, laid.section.level)))
    assert oracle.reached(robot, points).all()
    assert not is_hatched(laid.section.image).any()


def test_a_belt_is_served_between_two_places_over_its_whole_width() -> None:
    robot, level = dataclasses.replace(load_robot("zheng2023"), bodies=None), -700.0
    (served,) = Serve(robot, Thing(Kind.BELT_Y, 0, 0), level).pictures()
    words = served.text.split("Y ")[-1].split(" mm;")[0].split(" to ")
    start, end = map(float, words)
    across = np.linspace(-400, 400, 801)

    def whole(y: float) -> bool:
        points = np.column_stack((across, np.full(801, y), np.full(801, level)))
        return bool(oracle.reached(robot, points).all())

    assert all(map(whole, np.linspace(start + 1, end - 1, 60)))
    assert not whole(start - 2)
    assert not whole(end + 2)
    (small,) = Serve(load_robot("trossen"), Thing(Kind.BELT_X, 0, 0), -160.0).pictures()
    assert "not served over its whole width" in small.text


def test_a_robot_that_reaches_nothing_says_so(robot: Robot) -> None:
    short = RotaryDelta(
        base_radius=115, effector_radius=75, upper_arm=20, forearm=21, azimuths_deg=(0, 120, 240)
    )
    unable = dataclasses.replace(robot, mechanism=short)
    (laid,) = Lay(unable, Thing(Kind.BELT_X, 0, 0), None).pictures()
    assert "nothing of it is within reach" in laid.text
    assert is_hatched(laid.section.image).any()
    assert not (laid.section.image[..., 1] > laid.section.image[..., 0]).any()
