"""Self-collision: gaps between parts as other code finds them, and what they do to a workspace."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest

from deltaviz.mechanism.margin import MarginKind
from deltaviz.robots import Robot, load_robot
from deltaviz.robots.bodies import Bodies
from deltaviz.robots.workspace import Limit, Margins
from deltaviz.robots.workspace.cells import Cells, hull
from deltaviz.robots.workspace.parts import nearest_parts
from tests.robots.workspace import oracle
from tests.robots.workspace.conftest import DELTAS
from tests.robots.workspace.lines import Line, gap


def parts(robot: Robot, tip: np.ndarray) -> list[Line]:
    """The robot's parts in one pose, from its lengths and its angles alone."""
    mechanism, bodies, out = robot.mechanism, robot.bodies, []
    assert isinstance(bodies, Bodies)
    centre = tip - np.array(robot.tool_offset)
    for i, arm in enumerate(oracle.arms(robot, tip)):
        azimuth = np.radians(mechanism.azimuths_deg[i])  # type: ignore[attr-defined]
        outward = np.array((np.cos(azimuth), np.sin(azimuth), 0.0))
        sideways = np.array((-np.sin(azimuth), np.cos(azimuth), 0.0))
        motor = mechanism.base_radius[i] * outward  # type: ignore[attr-defined]
        wrist = mechanism.effector_radius[i] * outward  # type: ignore[attr-defined]
        elbow, wrist_at = arm.elbow[0] + wrist, centre + wrist
        side = bodies.rod_spacing / 2 * sideways
        out += [
            ("base", i, np.zeros(3), motor, bodies.base_thickness / 2),
            ("effector", i, centre, wrist_at, bodies.effector_thickness / 2),
            ("upper arm", i, motor, elbow, bodies.upper_arm_diameter / 2),
            ("rod", i, elbow - side, wrist_at - side, bodies.rod_diameter / 2),
            ("rod", i, elbow + side, wrist_at + side, bodies.rod_diameter / 2),
        ]
    return out


def joined(one: Line, other: Line) -> bool:
    """By design: the three arms of base or effector; base and its upper arm."""
    names = {one[0], other[0]}
    same = one[0] == other[0] and one[0] in ("base", "effector")
    return same or (names == {"base", "upper arm"} and one[1] == other[1])


@pytest.mark.parametrize("name", [*DELTAS, "uneven"])
def test_the_least_gap_is_that_of_lines(name: str, uneven: Robot) -> None:
    robot = uneven if name == "uneven" else load_robot(name)
    margins = Margins.of(robot)
    points = robot.workspace(Limit.REACH, tolerance=20.0).inside(4000)
    points = np.random.default_rng(9).permutation(points)[:12]
    gaps, codes = margins.gaps(points)
    for point, found, code in zip(points, gaps, codes, strict=True):
        every = {
            (a, b): gap(one, other)
            for (a, one), (b, other) in itertools.combinations(enumerate(parts(robot, point)), 2)
            if not joined(one, other)
        }
        assert found == pytest.approx(min(every.values()), abs=1e-5)
        lines = parts(robot, point)
        nearest = [k for k, value in every.items() if value < found + 1e-4]
        named = {frozenset((lines[a][:2], lines[b][:2])) for a, b in nearest}
        one, other = margins.parts(int(code)) or (None, None)
        assert one is not None
        assert other is not None
        assert frozenset(((one.name, one.arm), (other.name, other.arm))) in named


def test_bounds_of_gaps_hold_in_balls(uneven: Robot) -> None:
    bodies = uneven.bodies
    assert bodies is not None
    for robot in (load_robot("zheng2023"), replace(uneven, bodies=replace(bodies, rod_spacing=27))):
        margins = Margins.of(robot)
        collisions = margins.collisions
        assert collisions is not None
        random = np.random.default_rng(10)
        points = robot.workspace(Limit.REACH | Limit.SINGULARITIES, tolerance=20.0).inside(4000)
        points = random.permutation(points)[:600]
        for radius in (0.5, 4.0):
            r = np.full(len(points), radius)
            lower, upper, _ = collisions.bounds(points, r, margins.arms, margins.rest)
            ways = random.normal(size=(len(points), 80, 3))
            ways *= radius / np.linalg.norm(ways, axis=-1, keepdims=True)
            around = (points[:, None] + ways).reshape(-1, 3)
            gaps = margins.gaps(around)[0].reshape(len(points), -1)
            known = np.isfinite(lower)
            assert known.mean() > 0.7
            assert (gaps >= lower[:, None] - 1e-9)[known].all()
            assert (gaps <= upper[:, None] + 1e-9)[known].all()
            # Tight enough to be of use: a ball's gap is known within some radii.
            assert np.median((upper - lower)[known]) < 8 * radius


@pytest.mark.parametrize("name", [*DELTAS, "fivebar"])
def test_no_parts_touch_within_a_presets_zone(name: str) -> None:
    """Proved: cells of the zone are halved until each is out of reach or free of collisions."""
    robot = load_robot(name)
    margins = Margins.of(robot, Limit.ALL)
    collisions = margins.collisions
    assert collisions is not None
    others = replace(margins, collisions=None)
    box = hull(others)
    assert box is not None
    cells = Cells.of(box, float(box.size.max()) / 8)
    for _ in range(9):
        _, outside = cells.judge(others)
        cells = cells[~outside]
        r = np.full(len(cells), cells.radius)
        centres = cells.centres
        if margins.dimensions == 2:
            centres = np.insert(centres, 1, 0.0, axis=1)
        lower, _, _ = collisions.bounds(centres, r, margins.arms, margins.rest)
        cells = cells[lower < 0]
        if not len(cells):
            break
        cells = cells.halved()
    assert not len(cells)
    nearest = nearest_parts(robot)
    assert nearest is not None
    assert nearest.gap > 1.0


def test_fat_rods_end_the_workspace_where_they_touch(stm32: Robot) -> None:
    assert stm32.bodies is not None
    fat = replace(stm32, bodies=replace(stm32.bodies, upper_arm_diameter=34, rod_diameter=12))
    free, bound = stm32.workspace(), fat.workspace()
    assert bound.volume < 0.97 * free.volume
    tips = bound.boundary.vertices
    kinds = np.array([name.kind is MarginKind.COLLISION for name in bound.boundary.names])
    touching = tips[kinds[bound.boundary.limits]]
    assert len(touching) > 100
    for tip in touching[:: len(touching) // 6]:
        lines = parts(fat, tip)
        pairs = [(a, b) for a, b in itertools.combinations(lines, 2) if not joined(a, b)]
        assert min(gap(a, b) for a, b in pairs) == pytest.approx(0, abs=1e-4)


def test_without_thicknesses_nothing_collides(stm32: Robot) -> None:
    thin = replace(stm32, bodies=None)
    assert nearest_parts(thin) is None
    assert Margins.of(thin).collisions is None
