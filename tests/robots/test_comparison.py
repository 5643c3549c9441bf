"""Two robots side by side: what must follow from how they were made."""

from __future__ import annotations

import math
from dataclasses import asdict, replace
from pathlib import Path

import pytest

from deltaviz.mechanism import FiveBar
from deltaviz.robots import Robot, load_robot
from deltaviz.robots.bodies import PlanarBodies
from deltaviz.robots.comparison import Comparison, Row, compare, measure
from deltaviz.robots.comparison_plot import plot

TOLERANCE = 0.5  # mm


@pytest.fixture(scope="module")
def robot() -> Robot:
    return load_robot("fivebar")


def scaled(robot: Robot, by: float) -> Robot:
    mechanism, zone = robot.mechanism, robot.zone
    assert isinstance(mechanism, FiveBar)
    assert zone.x is not None
    lengths = ("base_half", "platform_half", "upper_arm", "forearm")
    grown = {name: [by * v for v in getattr(mechanism, name)] for name in lengths}
    z, x = ((by * low, by * high) for low, high in (zone.z, zone.x))
    assert isinstance(robot.bodies, PlanarBodies)
    bodies = PlanarBodies(**{name: by * width for name, width in asdict(robot.bodies).items()})
    return replace(robot, mechanism=FiveBar(**grown), zone=replace(zone, z=z, x=x), bodies=bodies)


@pytest.fixture(scope="module")
def found(robot: Robot) -> Comparison:
    return compare(
        measure(robot, tolerance=TOLERANCE), measure(scaled(robot, 2), tolerance=2 * TOLERANCE)
    )


@pytest.mark.parametrize(
    ("key", "ratio"),
    [
        ("area_cm2", 4),
        ("x_mm", 2),
        ("z_mm", 2),
        ("farthest_mm", 2),
        ("box_width_mm", 2),
        ("resolution_worst_mm", 2),
        ("resolution_median_mm", 2),
        ("condition_worst", 1),
        ("condition_median", 1),
    ],
)
def test_twice_as_large(found: Comparison, key: str, ratio: float) -> None:
    row = next(row for row in found.rows if row.key == key)
    assert row.ratio == pytest.approx(ratio, rel=0.03)


def test_finer_steps_are_a_finer_resolution(robot: Robot) -> None:
    steps = tuple(4 * n for n in robot.drive.microsteps_per_rad)
    finer = replace(robot, drive=replace(robot.drive, microsteps_per_rad=steps))
    rows = compare(*(measure(r, tolerance=2.0) for r in (robot, finer))).rows
    ratios = {row.key: row.ratio for row in rows}
    assert ratios["resolution_worst_mm"] == pytest.approx(0.25)
    assert ratios["area_cm2"] == pytest.approx(1)


def test_a_payload_and_masses_of_one_alone(robot: Robot) -> None:
    loaded = measure(robot, tolerance=2.0, payload=0.5)
    rows = {row.key: row for row in compare(measure(robot, tolerance=2.0), loaded).rows}
    assert (rows["holding_nm"].ratio or 0) > 1.5
    weightless = measure(replace(robot, masses=None), tolerance=2.0)
    rows = {row.key: row for row in compare(weightless, loaded).rows}
    assert rows["holding_nm"].values[0] is None
    assert rows["holding_nm"].ratio is None


@pytest.mark.parametrize(
    ("values", "ratio"), [((2.0, 5.0), 2.5), ((0.0, 5.0), None), ((None, 1.0), None)]
)
def test_ratio(values: tuple[float | None, float | None], ratio: float | None) -> None:
    assert Row("reach", "reach_mm", "mm", values).ratio == ratio


def test_the_picture_shows_both(found: Comparison, tmp_path: Path) -> None:
    figure = plot(found, str(tmp_path / "both.svg"))
    assert (tmp_path / "both.svg").stat().st_size > 10_000
    titles = [axes.get_title() for axes in figure.axes]
    assert titles.count("fivebar: condition") == 2
    assert titles.count("fivebar: resolution") == 2
    first, second = (axes.get_xlim() for axes in figure.axes[2:4])
    assert math.isclose(first[1], second[1])  # to one scale
