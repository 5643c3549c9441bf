"""Designed robots reach what was asked, as told by formulas that the search does not use."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from deltaviz.mechanism.published import cosine_rule, elbow_centres, legs_of
from deltaviz.robots import Robot, load_robot
from deltaviz.robots.design import (
    Designed,
    NothingReaches,
    Preference,
    Ranges,
    Task,
    Wish,
    design,
    search,
)
from deltaviz.robots.design.candidate import Lengths, made
from deltaviz.robots.design.proof import prove
from deltaviz.robots.design.score import UNREACHED, score
from deltaviz.robots.load import parse_robot
from deltaviz.robots.presets import preset_text
from deltaviz.robots.workspace.shapes import Cuboid, Cylinder

FLAT = Wish(Cuboid((200.0,), 80.0, 0.0, (0.0,)))
ROUND = Wish(Cylinder(200.0, 60.0, 0.0))
SHEET = Wish(Cuboid((120.0, 160.0), 10.0, 0.0, (0.0, 0.0)), floor=-250.25)
PLANAR_RANGES = Ranges((0, 200), (20, 200), (60, 500), (-700, -80))
SPATIAL_RANGES = Ranges((75, 275), (20, 200), (60, 500), (-700, -60))


def designed(preset: str, wish: Wish, ranges: Ranges, **given) -> Designed:
    task = Task(load_robot(preset), wish, grain=given.pop("grain", 0.5))
    given = {"generations": 12, "name": "designed", **given}
    return design(task, ranges, template_text=preset_text(preset), **given)


@pytest.fixture(
    scope="module",
    params=[
        ("fivebar", FLAT, PLANAR_RANGES),
        ("stm32", ROUND, SPATIAL_RANGES),
        ("trossen", SHEET, replace(SPATIAL_RANGES, base=(33, 275), floor=(-250.25, -250.25))),
    ],
    ids=["five-bar", "cylinder", "sheet"],
)
def case(request: pytest.FixtureRequest) -> tuple[Designed, Wish, Ranges, Robot]:
    preset, wish, ranges = request.param
    found = designed(preset, wish, ranges)
    return found, wish, ranges, parse_robot(found.text)


def body_points(wish: Wish, floor: float) -> np.ndarray:
    """A dense grid of the wished body, made here from its sides."""
    body, count = wish.body, 41 if wish.dimensions == 3 else 201
    sides = (body.diameter,) * 2 if isinstance(body, Cylinder) else body.size
    axes = [np.linspace(-side / 2, side / 2, count) for side in sides]
    axes.append(np.linspace(floor, floor + body.height, 9))
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, len(axes))
    if isinstance(body, Cylinder):
        radius = np.hypot(points[:, 0], points[:, 1])
        points[radius > 0, :2] *= np.minimum(1, body.diameter / 2 / radius[radius > 0])[:, None]
    return points


def test_every_point_is_within_the_joints_and_ball_joints(case) -> None:
    found, wish, _, robot = case
    points = body_points(wish, found.found.lengths.floor)
    legs = legs_of(robot.mechanism)
    theta = cosine_rule(legs, points - np.array(robot.tool_offset))
    assert np.isfinite(theta).all()
    assert (theta >= np.array(robot.joints.min) - 1e-9).all()
    assert (theta <= np.array(robot.joints.max) + 1e-9).all()
    forearms = points[:, None, :] - elbow_centres(legs, theta)
    assert np.abs(np.linalg.norm(forearms, axis=-1) - robot.mechanism.forearm).max() < 1e-9
    if robot.joints.ball_joint_max is not None:
        for leg in legs:
            lean = np.arcsin(np.abs(leg.seen(points)[1]) / leg.fore)
            assert lean.max() <= robot.joints.ball_joint_max + 1e-9


def test_it_stays_clear_of_singularities(case) -> None:
    """Told by the directions of the forearms alone: 1/‖A⁻¹‖ of their matrix, and each elbow's
    angle."""
    found, wish, _, robot = case
    points = body_points(wish, found.found.lengths.floor)
    legs = legs_of(robot.mechanism)
    theta = cosine_rule(legs, points)
    forearms = points[:, None, :] - elbow_centres(legs, theta)
    directions = forearms / np.linalg.norm(forearms, axis=-1, keepdims=True)
    held = 1 / np.linalg.norm(np.linalg.inv(directions), axis=(-2, -1))
    assert held.min() >= 0.1 - 1e-6


def test_the_quality_that_it_tells_is_that_of_the_whole_body(case) -> None:
    """By differences of the inverse."""
    found, wish, _, robot = case
    points = body_points(wish, found.found.lengths.floor)
    legs, step = legs_of(robot.mechanism), 1e-3
    columns = [
        (cosine_rule(legs, points + d) - cosine_rule(legs, points - d)) / (2 * step)
        for d in step * np.eye(points.shape[-1])
    ]
    sigma = np.linalg.svd(np.stack(columns, axis=-1), compute_uv=False)
    condition = (sigma[:, 0] / sigma[:, -1]).max()
    assert condition == pytest.approx(found.proof.condition, rel=0.02)
    resolution = (1 / sigma[:, -1]).max() / robot.drive.microsteps_per_rad[0]
    assert resolution == pytest.approx(found.proof.resolution, rel=0.02)


def test_sizes_and_grain_are_kept(case) -> None:
    found, wish, ranges, robot = case
    lengths = found.found.lengths
    for name in ("base", "upper_arm", "forearm", "floor"):
        value = getattr(lengths, name)
        low, high = getattr(ranges, name)
        assert low <= value <= high
        if name != "floor" or wish.floor is None:
            assert value % 0.5 == 0
    if wish.floor is not None:
        assert lengths.floor == wish.floor
    assert robot.mechanism.upper_arm[0] == lengths.upper_arm
    assert robot.mechanism.forearm[0] == lengths.forearm


def test_the_file_is_a_whole_robot(case) -> None:
    found, wish, _, robot = case
    assert found.proof.holds
    assert found.proof.fit.clearance - found.proof.fit.uncertain >= 0
    assert robot.name == "designed"
    assert robot.zone.z == (found.found.lengths.floor, found.found.lengths.floor + wish.body.height)
    assert robot.reach(robot.forward(robot.homing.ready)).legal


def test_the_same_seed_finds_the_same() -> None:
    one, again, other = (
        designed("fivebar", FLAT, PLANAR_RANGES, seed=seed, generations=6) for seed in (3, 3, 4)
    )
    assert one.text == again.text
    assert one.found.lengths != other.found.lengths


def test_what_is_preferred_is_better() -> None:
    template = load_robot("fivebar")
    best = {
        preference: search(Task(template, FLAT, preference), PLANAR_RANGES, generations=40).lengths
        for preference in (Preference.CONDITIONING, Preference.RESOLUTION)
    }
    proofs = {p: prove(made(template, at), FLAT, at.floor) for p, at in best.items()}
    conditioned, resolved = proofs[Preference.CONDITIONING], proofs[Preference.RESOLUTION]
    assert conditioned.condition < resolved.condition
    assert resolved.resolution < conditioned.resolution


def test_nothing_within_the_sizes_is_told_with_what_comes_nearest() -> None:
    short = replace(PLANAR_RANGES, upper_arm=(10, 40), forearm=(40, 60))
    with pytest.raises(NothingReaches, match=r"the best miss by \d+\.\d mm") as raised:
        designed("fivebar", FLAT, short)
    assert raised.value.missing > 10
    assert raised.value.best.forearm <= 60


def test_ranges_that_hold_nothing() -> None:
    with pytest.raises(ValueError, match="upper arm: from 5 to 4 mm there is nothing"):
        Ranges((0, 1), (5, 4), (1, 2), (-2, -1))


class TestASearchThatSawTooLittle:
    """It looks at a part of the body only; the proof looks at all of it."""

    @pytest.fixture
    def reserves(self, monkeypatch) -> list[float]:
        """What each round was asked to keep."""
        asked: list[float] = []

        def told(task: Task, *given, **named):
            asked.append(task.reserve)
            return search(task, *given, **named)

        monkeypatch.setattr("deltaviz.robots.design.designing.search", told)
        return asked

    def test_more_reserve_is_asked_for_until_it_is_proved(self, monkeypatch, reserves) -> None:
        whole = Wish.points
        monkeypatch.setattr(Wish, "points", lambda self: 0.9 * whole(self))
        found = designed("fivebar", FLAT, replace(PLANAR_RANGES, forearm=(60, 220)))
        assert reserves[0] == 0
        assert len(reserves) > 1
        assert reserves[1] > 1
        assert found.proof.holds

    def test_without_room_for_it_the_proof_says_no(self, monkeypatch, reserves) -> None:
        monkeypatch.setattr(Wish, "points", lambda self: np.array([[0.0, 40.0]]))
        found = designed("fivebar", FLAT, replace(PLANAR_RANGES, forearm=(60, 150)))
        assert len(reserves) > 1
        assert not found.proof.holds
        assert found.proof.fit.clearance < -5


def test_the_score_counts_missing_mm() -> None:
    template = load_robot("fivebar")
    task = Task(template, FLAT)
    good = search(task, PLANAR_RANGES, generations=10).lengths
    numbers = (good.base, good.upper_arm, good.forearm, good.floor)
    assert score(task, numbers) < UNREACHED
    deeper = [score(task, (*numbers[:3], good.floor - by)) for by in (300, 310)]
    assert deeper[0] > UNREACHED
    assert deeper[1] > deeper[0]


def test_impossible_lengths_score_worst() -> None:
    task = Task(load_robot("fivebar"), FLAT)
    assert score(task, (1000, 10, 10, -300)) == 1e9


def test_parts_that_touch_are_not_reached() -> None:
    """Rods as thick as posts: what the links reach, the parts do not."""
    template = load_robot("stm32")
    assert template.bodies is not None
    numbers = (115.0, 125.0, 338.0, -350.0)
    assert score(Task(template, ROUND), numbers) < UNREACHED
    posts = replace(template.bodies, rod_diameter=90.0, rod_spacing=200.0)
    assert score(Task(replace(template, bodies=posts), ROUND), numbers) >= UNREACHED


def test_rounding_keeps_to_the_grain() -> None:
    lengths = Lengths(100.3, 99.74, 200.1, -300.26).rounded(0.5)
    assert lengths == Lengths(100.5, 99.5, 200.0, -300.5)
    assert not math.isclose(Lengths(0.1, 0.1, 0.1, 0.1).rounded(0.3).base, 0.1)
