"""What fits: inside in truth, nothing much larger, and by how much and where what does not."""

from __future__ import annotations

import itertools
import math
from functools import cache
from typing import Any

import numpy as np
import pytest

from deltaviz.mechanism.margin import MarginKind
from deltaviz.robots import Robot, load_robot
from deltaviz.robots.workspace import Belt, Cuboid, Cylinder, Limit, Workspace, inscribed
from deltaviz.robots.workspace.clearances import Clearances, clearances
from tests.robots.workspace import oracle
from tests.robots.workspace.conftest import DELTAS

ARMS = Limit.REACH | Limit.JOINTS | Limit.BALL_JOINTS


@pytest.fixture(scope="module")
def space(stm32: Robot) -> Workspace:
    return stm32.workspace(ARMS)


def skin_of_cylinder(shape: Cylinder, count: int = 200_000, seed: int = 1) -> np.ndarray:
    """Points on its side and its ends."""
    random = np.random.default_rng(seed)
    angle = random.uniform(0, 2 * math.pi, count)
    radius = shape.diameter / 2 * np.ones(count)
    z = shape.floor + shape.height * random.uniform(0, 1, count)
    ends = count // 2
    radius[:ends] *= np.sqrt(random.uniform(0, 1, ends))
    z[:ends] = shape.floor + shape.height * (np.arange(ends) % 2)
    x, y = shape.centre
    return np.stack((x + radius * np.cos(angle), y + radius * np.sin(angle), z), axis=-1)


def skin_of_box(shape: Cuboid, count: int = 200_000, seed: int = 1) -> np.ndarray:
    random = np.random.default_rng(seed)
    sides = np.array((*shape.size, shape.height))
    middle = np.array((*shape.centre, shape.floor + shape.height / 2))
    points = random.uniform(-0.5, 0.5, (count, len(sides)))
    face = np.arange(count) % len(sides)
    points[np.arange(count), face] = np.sign(random.uniform(-1, 1, count)) / 2
    corners = np.array(list(itertools.product((-0.5, 0.5), repeat=len(sides))))
    return middle + sides * np.concatenate((corners, points))


def some_outside(robot: Robot, points: np.ndarray) -> bool:
    return not oracle.reached(robot, points).all()


def test_the_largest_cylinder_is_inside_and_no_larger_one_is(
    stm32: Robot, space: Workspace
) -> None:
    found = space.largest_cylinder()
    assert found is not None
    shape = found.shape
    assert isinstance(shape, Cylinder)
    assert oracle.reached(stm32, skin_of_cylinder(shape)).all()
    assert found.most < 1.03 * shape.volume
    # Of many others of a little more than the proved bound, each sticks out.
    for height in np.linspace(0.3, 2.5, 45) * shape.height:
        diameter = math.sqrt(1.005 * found.most * 4 / math.pi / height)
        for floor in np.linspace(-460, -200, 53):
            other = Cylinder(diameter, height, floor)
            assert some_outside(stm32, skin_of_cylinder(other, 1500, seed=2))


@pytest.mark.parametrize("height", [20.0, 150.0])
def test_the_widest_cylinder_of_a_height(stm32: Robot, space: Workspace, height: float) -> None:
    found = space.largest_cylinder(height=height)
    assert found is not None
    shape = found.shape
    assert isinstance(shape, Cylinder)
    assert shape.height == pytest.approx(height)
    assert oracle.reached(stm32, skin_of_cylinder(shape)).all()
    assert shape.diameter <= found.most < shape.diameter + 3
    for floor in np.linspace(-460, -200, 521):
        assert some_outside(
            stm32, skin_of_cylinder(Cylinder(found.most + 0.5, height, floor), 3000)
        )


def test_a_cylinder_that_stands_on_a_floor(stm32: Robot, space: Workspace) -> None:
    found = space.largest_cylinder(height=60.0, floor=-380.0)
    assert found is not None
    shape = found.shape
    assert isinstance(shape, Cylinder)
    assert (shape.floor, shape.height) == (-380.0, 60.0)
    assert oracle.reached(stm32, skin_of_cylinder(shape)).all()
    assert some_outside(stm32, skin_of_cylinder(Cylinder(shape.diameter + 1, 60.0, -380.0)))


def test_free_of_the_axis_it_is_no_smaller(uneven: Robot) -> None:
    workspace = uneven.workspace(ARMS)
    central = workspace.largest_cylinder(height=100.0)
    free = workspace.largest_cylinder(height=100.0, centre=None)
    assert central is not None
    assert free is not None
    assert isinstance(central.shape, Cylinder)
    assert isinstance(free.shape, Cylinder)
    assert free.shape.diameter > central.shape.diameter
    assert free.shape.centre != (0.0, 0.0)
    assert free.most < 1.1 * free.shape.diameter
    assert oracle.reached(uneven, skin_of_cylinder(free.shape)).all()


@pytest.mark.parametrize("aspect", [1.0, 279.4 / 215.9])
def test_the_largest_box(stm32: Robot, space: Workspace, aspect: float) -> None:
    found = space.largest_box(height=80.0, aspect=aspect, centre=(0.0, 0.0))
    assert found is not None
    shape = found.shape
    assert isinstance(shape, Cuboid)
    assert shape.size[1] == pytest.approx(aspect * shape.size[0])
    assert oracle.reached(stm32, skin_of_box(shape)).all()
    wider = found.most + 0.5
    for floor in np.linspace(-460, -200, 261):
        other = Cuboid((wider, aspect * wider), 80.0, floor, (0.0, 0.0))
        assert some_outside(stm32, skin_of_box(other, 3000))


def test_the_largest_rectangle_in_a_plane() -> None:
    robot = load_robot("fivebar")
    found = robot.workspace(ARMS).largest_box(centre=(0.0,))
    assert found is not None
    assert isinstance(found.shape, Cuboid)
    assert len(found.shape.size) == 1
    assert oracle.reached(robot, skin_of_box(found.shape)).all()
    assert found.most < 1.03 * found.shape.volume
    with pytest.raises(ValueError, match="no cylinders"):
        robot.workspace().largest_cylinder()


@pytest.mark.parametrize(("height", "told"), [(0.001, "0.001"), (0.25, "0.25"), (4.567, "4.57")])
def test_a_thin_shape_is_told_to_have_a_height(height: float, told: str) -> None:
    assert f"across and {told} mm high" in str(Cylinder(10.0, height, -300.0))
    assert f"by {told} mm" in str(Cuboid((10.0, 20.0), height, -300.0, (0.0, 0.0)))


def test_nothing_fits_where_nothing_is_reached(space: Workspace) -> None:
    assert space.largest_cylinder(height=30.0, floor=100.0) is None
    assert space.largest_cylinder(height=700.0) is None
    assert space.largest_box(height=30.0, centre=(400.0, 0.0)) is None


def test_how_much_a_shape_may_grow(stm32: Robot, space: Workspace) -> None:
    shape = Cylinder(200.0, 60.0, -350.0)
    found = space.fit(shape)
    assert found.fits
    assert found.clearance > 10
    grown = Cylinder(200 + 2 * (by := found.clearance - found.uncertain), 60 + 2 * by, -350 - by)
    assert oracle.reached(stm32, skin_of_cylinder(grown)).all()
    by = found.clearance + 0.5
    assert some_outside(
        stm32, skin_of_cylinder(Cylinder(200 + 2 * by, 60 + 2 * by, -350 - by), 400_000)
    )
    assert found.unreached == 0


def test_how_much_a_shape_must_shrink_and_where(stm32: Robot, space: Workspace) -> None:
    shape = Cylinder(420.0, 120.0, -380.0)
    found = space.fit(shape)
    assert not found.fits
    assert found.clearance < -5
    by = found.clearance - found.uncertain
    shrunk = Cylinder(420 + 2 * by, 120 + 2 * by, -380 - by)
    assert oracle.reached(stm32, skin_of_cylinder(shrunk)).all()
    assert found.where is not None
    assert shape.depth(found.where[None])[0] == pytest.approx(-found.clearance, abs=0.01)
    assert not oracle.reached(stm32, found.where[None])[0]
    assert found.limit is not None
    assert found.limit.kind is MarginKind.JOINT_MAX
    random = np.random.default_rng(8).uniform((-210, -210, -380), (210, 210, -260), (400_000, 3))
    random = random[np.hypot(random[:, 0], random[:, 1]) <= 210]
    assert found.unreached == pytest.approx(1 - oracle.reached(stm32, random).mean(), abs=0.003)


def test_a_box_that_is_wholly_out_of_reach(space: Workspace) -> None:
    found = space.fit(Cuboid((100.0, 100.0), 50.0, 200.0, (0.0, 0.0)))
    assert not found.fits
    assert found.unreached == 1.0
    assert found.clearance == pytest.approx(-25, abs=0.3)


def served(robot: Robot, belt: Belt) -> tuple[float, float] | None:
    """The longest run of places over all of the belt's width and height, tried every half mm."""
    x = np.arange(-400, 400, 0.5)
    side = np.linspace(-belt.width / 2, belt.width / 2, 61) + belt.offset
    z = np.linspace(belt.floor, belt.floor + belt.height, 5)
    grid = np.stack(np.meshgrid(x, side, z, indexing="ij"), axis=-1)
    if belt.axis == 1:
        grid = grid[..., [1, 0, 2]]
    free = oracle.reached(robot, grid.reshape(-1, 3)).reshape(len(x), -1).all(axis=1)
    edges = np.flatnonzero(np.diff(np.concatenate(([0], free, [0]))))
    runs = [(float(x[a]), float(x[b - 1])) for a, b in edges.reshape(-1, 2)]
    return max(runs, key=lambda run: run[1] - run[0], default=None)


@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize(("width", "offset"), [(200.0, 0.0), (120.0, 60.0)])
def test_the_stretch_of_a_belt(
    stm32: Robot, space: Workspace, axis: int, width: float, offset: float
) -> None:
    belt = Belt(width, 40.0, -340.0, axis=axis, offset=offset)
    found, expected = space.serve(belt), served(stm32, belt)
    assert expected is not None
    assert found.fits
    assert (found.start, found.end) == pytest.approx(expected, abs=1.0)
    assert not space.serve(Belt(width, 40.0, -340.0, axis, offset, stretch=500.0)).fits


def test_a_belt_that_is_too_wide(stm32: Robot, space: Workspace) -> None:
    belt = Belt(800.0, 40.0, -340.0)
    found = space.serve(belt)
    assert not found.fits
    assert (found.length, found.start) == (0.0, None)
    assert served(stm32, Belt(found.widest - 0.5, 40.0, -340.0)) is not None
    assert found.none_wider < found.widest + 1.0
    assert served(stm32, Belt(found.none_wider, 40.0, -340.0)) is None
    assert found.widest_at is not None
    low, high = (served_about(stm32, belt, found.widest_at, side) for side in (-1.0, 1.0))
    assert all(
        limit is not None and limit.kind in kinds
        for limit, kinds in zip(found.limits, (low, high), strict=True)
    )


def served_about(robot: Robot, belt: Belt, place: float, side: float) -> set[MarginKind]:
    """What keeps the tool tip from going to one side of a belt of any width."""
    z = belt.floor + np.linspace(0, belt.height, 9)
    y = side * np.linspace(0, 400, 1601)
    grid = np.array([[(place, aside, up) for up in z] for aside in y])
    free = oracle.reached(robot, grid.reshape(-1, 3)).reshape(len(y), -1)
    first = int(np.flatnonzero(~free.all(axis=1))[0])
    outside = grid[first + 2][~free[first + 2]]
    return {why.limit.kind for point in outside for why in robot.reach(point).reasons}


def test_a_belt_near_the_widest_gets_no_contradictory_answer(space: Workspace) -> None:
    """What is told to be served at a width, is."""
    widest = space.serve(Belt(800.0, 0.0, -230.0)).widest
    found = space.serve(Belt(widest - 0.01, 0.0, -230.0))
    assert found.fits
    assert found.widest >= widest - 0.01


def test_what_ends_the_stretch_of_a_belt(stm32: Robot, space: Workspace) -> None:
    found = space.serve(Belt(200.0, 40.0, -340.0))
    assert found.start is not None
    assert found.end is not None
    for limit, place in zip(found.limits, (found.start - 1.0, found.end + 1.0), strict=True):
        assert limit is not None
        grid = [(place, y, z) for y in np.linspace(-100, 100, 81) for z in (-340, -320, -300)]
        broken = {why.limit.kind for point in grid for why in stm32.reach(point).reasons}
        assert limit.kind in broken


@pytest.mark.long
def test_a_flat_cylinder_between_parts_that_nearly_touch() -> None:
    """Where the proof is coarsest: a metre wide, ended by a rod beside its own upper arm."""
    robot = load_robot("zheng2023")
    workspace = robot.workspace()
    found = workspace.largest_cylinder(height=100.0)
    assert found is not None
    assert isinstance(found.shape, Cylinder)
    assert (workspace.margins.least(skin_of_cylinder(found.shape)) >= 0).all()
    assert found.most < found.shape.diameter + 3


@pytest.mark.long
def test_a_sheet_takes_no_minute(monkeypatch: pytest.MonkeyPatch) -> None:
    """It fits between measured places almost anywhere; that was cut finer until all turns were
    spent."""
    measured: list[int] = []

    def counted(*arguments: Any, **options: Any) -> Clearances:
        found = clearances(*arguments, **options)
        measured.append(len(found.places))
        return found

    plate = workspace_of("stm32").largest_cylinder(height=20.0)
    monkeypatch.setattr(inscribed, "clearances", counted)
    sheet = workspace_of("stm32").largest_cylinder(height=0.001)
    assert sheet is not None
    assert plate is not None
    assert isinstance(sheet.shape, Cylinder)
    assert isinstance(plate.shape, Cylinder)
    assert plate.shape.diameter - 0.5 < sheet.shape.diameter <= sheet.most
    assert sum(measured) < 5000


@cache
def workspace_of(name: str) -> Workspace:
    return load_robot(name).workspace()


def widest(
    workspace: Workspace, aspect: float | None, height: float, floor: float | None = None
) -> tuple[float, float, float]:
    """(found, none above, where it stands) of a centred box whose second side is `aspect` times
    its first, or with None of a cylinder."""
    if aspect is None:
        found = workspace.largest_cylinder(height=height, floor=floor)
    else:
        found = workspace.largest_box(height=height, floor=floor, centre=(0.0, 0.0), aspect=aspect)
    if found is None:
        return 0.0, 0.0, math.nan
    shape = found.shape
    width = shape.diameter if isinstance(shape, Cylinder) else shape.size[0]
    return width, found.most, shape.floor


SHARES, ASPECTS = (0.15, 0.45), (None, 1.0, 1.5, 0.6)
QUICK = {("stm32", 1.5, 0.45)}


@pytest.mark.parametrize(
    ("name", "aspect", "share"),
    [
        pytest.param(*case, marks=() if case in QUICK else pytest.mark.long)
        for case in itertools.product(DELTAS, ASPECTS, SHARES)
    ],
)
def test_what_is_found_is_as_wide_as_what_is_proved(
    name: str, aspect: float | None, share: float
) -> None:
    """On each side within a quarter of the resolution, wherever it stands; and no floor is better
    than the one that was chosen."""
    workspace = workspace_of(name)
    height = share * float(workspace.extents.size[2])
    found, most, chosen = widest(workspace, aspect, height)
    assert 0 < found <= most <= found + 2 * workspace.fine
    floors = chosen + height * np.array((-0.01, 0.002))
    at_a_floor = [widest(workspace, aspect, height, z)[0] for z in (*floors.tolist(), chosen)]
    assert max(at_a_floor) <= found + 2 * workspace.fine


@pytest.mark.parametrize(
    ("name", "sides", "height"), [("stm32", 300.0, 100.0), ("zheng2023", 780.0, 200.0)]
)
def test_a_box_that_stands_on_some_floor_stands_without_one(
    name: str, sides: float, height: float
) -> None:
    """Its corners touch where few rays go."""
    workspace = workspace_of(name)
    floor = {"stm32": -350.02, "zheng2023": -845.9}[name]
    assert workspace.fit(Cuboid((sides, sides), height, floor, (0.0, 0.0))).fits
    assert widest(workspace, 1.0, height)[0] >= sides
