"""Robot files with some of their numbers changed."""

from __future__ import annotations

import re

import numpy as np
import pytest

from deltaviz.robots import load_robot, preset_names
from deltaviz.robots.draft import Draft
from deltaviz.robots.errors import Faulty
from deltaviz.robots.load import parse_robot
from deltaviz.robots.presets import preset_text


def draft(name: str) -> Draft:
    return Draft(preset_text(name))


@pytest.mark.parametrize("name", preset_names())
def test_nothing_changed_is_the_robot_itself(name: str) -> None:
    assert draft(name).made({}).robot == load_robot(name)


@pytest.mark.parametrize("name", preset_names())
def test_every_parameter_changes_the_robot_and_its_file(name: str) -> None:
    own = load_robot(name)
    for parameter in draft(name).parameters:
        value = parameter.value + (parameter.high - parameter.value) / 20
        made = draft(name).made({parameter.field: value})
        assert made.robot != own
        read = parse_robot(made.text(name=own.name, notes=()))
        assert read == made.robot


def test_lengths_of_the_file_are_those_that_were_chosen() -> None:
    made = draft("stm32").made({"geometry.forearm": 400.0, "geometry.base_radius": 90.0})
    mechanism = load_robot("stm32").mechanism
    read = parse_robot(made.text(name="other", notes=("Longer.",)))
    assert read.name == "other"
    assert read.mechanism.forearm == (400.0,) * 3  # type: ignore[attr-defined]
    assert read.mechanism.base_radius == (90.0,) * 3  # type: ignore[attr-defined]
    assert read.mechanism.upper_arm == mechanism.upper_arm  # type: ignore[attr-defined]


def test_arms_that_differ_keep_their_differences() -> None:
    text = preset_text("stm32").replace("forearm = 338.0", "forearm = [337.0, 338.0, 339.6]")
    (parameter,) = (p for p in Draft(text).parameters if p.field == "geometry.forearm")
    assert parameter.value == pytest.approx(338.2)
    made = Draft(text).made({"geometry.forearm": 348.2})
    assert made.robot.mechanism.forearm == pytest.approx((347.0, 348.0, 349.6))  # type: ignore[attr-defined]


def test_sides_of_triangles_are_changed_as_such() -> None:
    fields = [parameter.field for parameter in draft("trossen").parameters]
    assert "geometry.base_side" in fields
    assert "geometry.base_radius" not in fields


def test_the_zone_moves_with_the_pose_where_homing_ends_and_only_if_it_must() -> None:
    """The tip's height by Pythagoras: at 0 degrees the elbows stand R + L - r from the axis."""
    own = load_robot("stm32")
    a_little = draft("stm32").made({"geometry.forearm": 340.0})
    assert a_little.robot.zone == own.zone
    assert a_little.zone_moved == 0.0
    far = draft("stm32").made({"geometry.forearm": 560.0})
    across = 115.0 + 125.0 - 75.0
    down = np.sqrt(560.0**2 - across**2) - np.sqrt(338.0**2 - across**2)
    assert far.zone_moved == pytest.approx(-down)
    assert far.robot.zone.z == pytest.approx((-440.0 - down, -225.0 - down), abs=1e-5)


def test_switches_stay_beyond_the_joint_limits() -> None:
    made = draft("stm32").made({"joints.min_deg": -60.0, "joints.max_deg": 95.0})
    assert np.degrees(made.robot.homing.switch) == pytest.approx((-65.0,) * 3)
    assert np.degrees(made.robot.homing.max_travel) == pytest.approx((190.0,) * 3)


@pytest.mark.parametrize(
    ("name", "values", "said"),
    [
        ("trossen", {"geometry.base_side": 915.0}, r"geometry\.forearm = .* must be greater than"),
        ("stm32", {"geometry.forearm": -1.0}, r"geometry\.forearm = -1\.0: must be greater than 0"),
        ("trossen", {"geometry.upper_arm": 170.0}, r"homing\.ready_deg = .* forearms can meet"),
        ("stm32", {"joints.min_deg": 95.0}, r"joints\.min_deg = 95\.0: must be less than"),
    ],
)
def test_what_is_impossible_names_its_field_and_the_rule(
    name: str, values: dict[str, float], said: str
) -> None:
    with pytest.raises(Faulty) as error:
        draft(name).made(values)
    assert re.match(said, str(error.value))
