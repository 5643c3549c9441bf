"""What lumped rods miss, for the presets and the motion that the workspace's report tells of."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from deltaviz.mechanism.dynamics import RodModel
from deltaviz.robots import Robot, load_robot
from deltaviz.robots.lumped_rods import Missed, missed
from deltaviz.robots.torques import MassesMissing, crossing
from deltaviz.robots.workspace.report import zone_way

PRESETS = ["deltadraw", "fivebar", "stm32", "trossen", "zheng2023"]


def both(robot: Robot, *, quicker: float = 1.0, payload: float = 0.0) -> tuple[Missed, Missed]:
    """Of 2/3 at the elbow, and of halves, on the way through the zone."""
    start, end = zone_way(robot)
    duration = crossing(robot, start, end).duration / quicker
    thirds, halves = (
        missed(robot, start, end, rods=rods, duration=duration, payload=payload)
        for rods in (RodModel.TWO_THIRDS, RodModel.HALVES)
    )
    return thirds, halves


def test_uniform_rods_miss_nothing(stm32: Robot) -> None:
    found = missed(stm32, *zone_way(stm32), rods=RodModel.UNIFORM)
    assert found == Missed(0.0, 0.0, 0.0)


@pytest.mark.parametrize("name", PRESETS)
def test_halves_hold_the_weight_and_two_thirds_the_acceleration(name: str) -> None:
    thirds, halves = both(load_robot(name))
    assert halves.weight < 1e-12 < 0.01 < thirds.weight
    assert thirds.acceleration < halves.acceleration


@pytest.mark.parametrize("name", PRESETS)
def test_the_quicker_the_motion_the_worse_are_halves(name: str) -> None:
    robot = load_robot(name)
    thirds, halves = both(robot)
    assert halves.share < thirds.share  # at the zone's limits weight counts most
    thirds, halves = both(robot, quicker=4.0)
    assert halves.share > thirds.share
    np.testing.assert_allclose(both(robot, quicker=40.0)[1].share, halves.acceleration, rtol=0.05)


def test_a_payload_makes_rods_matter_less(stm32: Robot) -> None:
    light, heavy = both(stm32), both(stm32, payload=1.0)
    for empty, loaded in zip(light, heavy, strict=True):
        assert loaded.share < empty.share


def test_what_cannot_be_told_is_said(stm32: Robot) -> None:
    way = zone_way(stm32)
    with pytest.raises(MassesMissing):
        missed(replace(stm32, masses=None), *way, rods=RodModel.HALVES)
    with pytest.raises(ValueError, match="leaves what the arms reach"):
        missed(stm32, [-500, 0, -300], way[1], rods=RodModel.HALVES)
