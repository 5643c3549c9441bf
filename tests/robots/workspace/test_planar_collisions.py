"""Self-collision of the five-bar, whose parts all lie in one plane."""

from __future__ import annotations

import itertools
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from deltaviz.mechanism import FiveBar
from deltaviz.mechanism.margin import MarginKind
from deltaviz.robots import Robot, load_robot
from deltaviz.robots.bodies import PlanarBodies
from deltaviz.robots.workspace import Limit, Margins
from tests.robots.workspace import oracle
from tests.robots.workspace.lines import Line, gap

HINGES = [{"base"}, {"platform"}, {"base", "upper arm"}, {"platform", "forearm"}]


def robot_of(name: str) -> Robot:
    robot = load_robot("fivebar")
    lengths: dict[str, Any] = {
        "fivebar": {},
        "on one axis": {"base_half": 0.0},
        "with one wrist": {"platform_half": 0.0},
        "uneven": {"base_half": (70, 85), "platform_half": (30, 0), "forearm": (205, 190)},
    }[name]
    same: dict[str, Any] = {"base_half": 80, "platform_half": 20, "upper_arm": 100, "forearm": 200}
    tool = (7.0, -12.0) if name == "uneven" else (0.0, 0.0)
    return replace(robot, mechanism=FiveBar(**(same | lengths)), tool_offset=tool)


def parts(robot: Robot, tip: np.ndarray) -> list[Line]:
    """The robot's parts in one pose, from its lengths and its angles alone."""
    mechanism, bodies, out = robot.mechanism, robot.bodies, []
    assert isinstance(mechanism, FiveBar)
    assert isinstance(bodies, PlanarBodies)
    (centre,) = oracle.in_space(robot, tip)
    for i, (arm, side) in enumerate(zip(oracle.arms(robot, tip), (-1.0, 1.0), strict=True)):
        motor = np.array((side * mechanism.base_half[i], 0.0, 0.0))
        wrist = np.array((side * mechanism.platform_half[i], 0.0, 0.0))
        elbow = arm.elbow[0] + wrist
        out += [
            ("base", i, np.zeros(3), motor, bodies.base_thickness / 2),
            ("platform", i, centre, centre + wrist, bodies.platform_thickness / 2),
            ("upper arm", i, motor, elbow, bodies.upper_arm_width / 2),
            ("forearm", i, elbow, centre + wrist, bodies.forearm_width / 2),
        ]
    return [line for line in out if (line[2] != line[3]).any()]


def joined(one: Line, other: Line) -> bool:
    """On base or platform, or by an axis in which both end."""
    shared = any(np.linalg.norm(a - b) < 1e-9 for a in one[2:4] for b in other[2:4])
    of_a_kind = one[0] == other[0] or one[1] == other[1]
    return {one[0], other[0]} in HINGES or (of_a_kind and shared)


def least_gap(robot: Robot, tip: np.ndarray) -> tuple[float, list[frozenset[tuple[str, int]]]]:
    """And between which parts, all that are as near."""
    found = {
        frozenset((one[:2], other[:2])): gap(one, other)
        for one, other in itertools.combinations(parts(robot, tip), 2)
        if not joined(one, other)
    }
    least = min(found.values())
    return least, [pair for pair, value in found.items() if value < least + 1e-4]


NAMES = ("fivebar", "on one axis", "with one wrist", "uneven")


@pytest.mark.parametrize("name", NAMES)
def test_the_least_gap_is_that_of_lines(name: str) -> None:
    robot = robot_of(name)
    margins = Margins.of(robot)
    points = robot.workspace(Limit.REACH, tolerance=5.0).inside(4000)
    points = np.random.default_rng(9).permutation(points)[:60]
    gaps, codes = margins.gaps(points)
    named: set[frozenset[str]] = set()
    for point, found, code in zip(points, gaps, codes, strict=True):
        least, pairs = least_gap(robot, point)
        assert found == pytest.approx(least, abs=1e-5)
        one, other = margins.parts(int(code)) or (None, None)
        assert one is not None
        assert other is not None
        assert frozenset(((one.name, one.arm), (other.name, other.arm))) in pairs
        named.add(frozenset((one.name, other.name)))
    assert len(named) > 1


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("radius", [0.5, 4.0])
def test_bounds_of_gaps_hold_in_balls(name: str, radius: float) -> None:
    robot, random = robot_of(name), np.random.default_rng(10)
    margins = Margins.of(robot, Limit.REACH | Limit.COLLISIONS)
    free = robot.workspace(Limit.REACH | Limit.SINGULARITIES, tolerance=5.0).inside(4000)
    points = random.permutation(free)[:400]
    turns = random.uniform(0, 2 * np.pi, (len(points), 60))
    share = np.sqrt(random.uniform(0, 1, turns.shape))
    ways = radius * share[..., None] * np.stack((np.cos(turns), np.sin(turns)), axis=-1)
    lower, upper = margins.bounds(points, np.full(len(points), radius))
    around = margins.least(points[:, None] + ways)
    known = np.isfinite(lower)
    assert known.mean() > 0.7
    assert (around.min(axis=1) >= lower - 1e-9)[known & (lower >= 0)].all()
    assert (around.max(axis=1) <= upper + 1e-9)[known].all()


@pytest.mark.parametrize(
    ("widths", "names"),
    [
        ({"base_thickness": 150}, {"forearm", "base"}),
        ({"platform_thickness": 240}, {"platform", "base", "upper arm"}),
    ],
)
def test_thick_parts_end_the_workspace_where_they_touch(
    widths: dict[str, float], names: set[str]
) -> None:
    robot = load_robot("fivebar")
    assert isinstance(robot.bodies, PlanarBodies)
    thick = replace(robot, bodies=replace(robot.bodies, **widths))
    bound = thick.workspace()
    assert bound.volume < 0.99 * replace(robot, bodies=None).workspace().volume
    kinds = np.array([name.kind is MarginKind.COLLISION for name in bound.boundary.names])
    touching = bound.boundary.vertices[kinds[bound.boundary.limits]]
    assert len(touching) > 10
    named: set[str] = set()
    for tip in touching[:: max(len(touching) // 20, 1)]:
        least, pairs = least_gap(thick, tip)
        assert least == pytest.approx(0, abs=1e-4)
        named |= {name for name, _ in pairs[0]}
    assert names <= named


def test_the_preset_reaches_as_high_as_its_forearms_clear_the_base() -> None:
    """Found again on a grid: the forearms pass the motors' axes, 80 mm from the middle, at half of
    both their widths, 10 + 7 mm."""
    robot = load_robot("fivebar")
    grid = np.stack(np.meshgrid(np.arange(-40, 40, 0.5), np.arange(-100, -70, 0.1)), axis=-1)
    points = grid.reshape(-1, 2)
    points = points[oracle.reached(robot, points)]
    clear = np.ones(len(points), bool)
    for arm, side in zip(oracle.arms(robot, points), (-1.0, 1.0), strict=True):
        outward = np.array((side, 0.0))
        along = points - arm.elbow[:, ::2]
        to_motor = 80.0 * outward - (points + 20.0 * outward)
        across = along[:, 0] * to_motor[:, 1] - along[:, 1] * to_motor[:, 0]
        clear &= np.abs(across) / np.linalg.norm(along, axis=1) >= 17.0
    assert robot.workspace().extents.high[-1] == pytest.approx(points[clear, 1].max(), abs=0.3)


@pytest.mark.parametrize("widths", [{"forearm_width": 40.1}, {"upper_arm_width": 160.1}])
def test_arms_wider_than_what_they_hang_on_fit_nowhere(widths: dict[str, float]) -> None:
    """Platform and base of the preset hold them 40 and 160 mm apart."""
    robot = load_robot("fivebar")
    assert isinstance(robot.bodies, PlanarBodies)
    workspace = replace(robot, bodies=replace(robot.bodies, **widths)).workspace()
    assert workspace.empty
    assert "parts of the robot would touch" in str(workspace.reason)


def test_without_widths_nothing_collides() -> None:
    assert Margins.of(replace(load_robot("fivebar"), bodies=None)).collisions is None
