"""Three coordinates at the surfaces, the robot's own behind them."""

from __future__ import annotations

import pytest

from deltaviz.robots import Robot, load_robot
from deltaviz.robots.coordinates import CoordinateError, in_robot, in_space, is_planar


@pytest.fixture(scope="module")
def planar() -> Robot:
    return load_robot("fivebar")


def test_a_planar_robots_y_is_0(planar: Robot, stm32: Robot) -> None:
    assert in_robot(planar, (1, 0, -200)) == (1, -200)
    assert in_space((1, -200)) == (1, 0, -200)
    assert is_planar(planar)
    assert in_robot(stm32, (1, 2, -300)) == in_space((1, 2, -300)) == (1, 2, -300)
    assert not is_planar(stm32)


@pytest.mark.parametrize("y", [5.0, -1e-9, float("nan")])
def test_any_other_y_is_refused(planar: Robot, y: float) -> None:
    with pytest.raises(CoordinateError, match="Y must be 0, as fivebar is planar"):
        in_robot(planar, (0.0, y, -200.0))


@pytest.mark.parametrize("count", [1, 2, 4])
def test_other_numbers_of_coordinates_are_a_mistake(planar: Robot, count: int) -> None:
    with pytest.raises(ValueError, match="zip"):
        in_robot(planar, (0.0,) * count)
