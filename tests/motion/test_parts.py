"""The parts that the follower is built of, each by itself."""

from __future__ import annotations

import numpy as np
import pytest

from deltaviz.motion import cubic
from deltaviz.motion.brake import brake_legal, brake_plan
from deltaviz.motion.otg import Generator, Request
from deltaviz.motion.shaping import Shaper, Shares, Way
from deltaviz.motion.space import CartesianSpace, JointSpace
from deltaviz.motion.straight import check_straight
from deltaviz.robots import Robot, load_robot


@pytest.fixture(scope="module")
def robot() -> Robot:
    return load_robot("stm32")


# Cubics.


def test_cubic_meets_its_knots_and_its_peaks() -> None:
    rng = np.random.default_rng(2)
    theta, rate = rng.normal(size=(2, 5, 3)), rng.normal(size=(2, 5, 3)) * 3
    first, last = cubic.end_accelerations(theta[0], rate[0], theta[1], rate[1], 0.3)
    peak = cubic.peak_velocity(theta[0], rate[0], theta[1], rate[1], 0.3)
    for k in range(5):
        args = (theta[0, k], rate[0, k], theta[1, k], rate[1, k], 0.3)
        place, slope, bend = cubic.sample(*args, np.linspace(0, 1, 3001))
        assert place[[0, -1]] == pytest.approx(theta[:, k])
        assert slope[[0, -1]] == pytest.approx(rate[:, k])
        assert bend[[0, -1]] == pytest.approx(np.array([first[k], last[k]]))
        assert np.abs(slope).max(axis=0) == pytest.approx(peak[k], abs=1e-4)


# The brake.


def test_brake_runs_on_the_tangent_within_the_acceleration_limit(robot: Robot) -> None:
    space = JointSpace(robot)
    theta, rate = np.array([0.1, 0.2, 0.3]), np.array([3.0, -1.0, 0.5])
    plan = brake_plan(space, theta, rate, 0.01)
    assert not plan.rate[-1].any()
    off = (plan.theta - theta) - np.outer((plan.theta - theta)[:, 0] / 3.0, rate)
    assert np.abs(off).max() < 1e-12
    first, last = cubic.end_accelerations(
        plan.theta[:-1], plan.rate[:-1], plan.theta[1:], plan.rate[1:], plan.segment
    )
    most = max(np.abs(first).max(), np.abs(last).max()) / space.acceleration[0]
    assert 0.95 < most <= 0.985


@pytest.mark.parametrize("speed", [1e-9, 0.01, 0.3, 5.9])
def test_brake_segments_are_such_as_the_board_takes(robot: Robot, speed: float) -> None:
    plan = brake_plan(JointSpace(robot), np.zeros(3), np.array([speed, 0.0, 0.0]), 0.01)
    assert 0.00399 <= plan.segment <= 0.050
    for tick_hz in (200_000, 40_000):  # on silicon, and in the emulator
        ticks = plan.segment * tick_hz
        assert ticks == pytest.approx(round(ticks), abs=1e-6)


def test_brake_into_a_limit_is_illegal(robot: Robot) -> None:
    theta = robot.inverse([0.0, 0.0, -432.0])
    assert brake_legal(robot, theta, np.full(3, 0.1)) is None
    assert "lower end of the workspace" in (brake_legal(robot, theta, np.full(3, 4.0)) or "")
    assert brake_legal(robot, theta, np.full(3, -4.0)) is None


# Jerk-limited motion.


def request(**changes: object) -> Request:
    values: dict[str, object] = {
        "displacement": np.array([80.0, 0.0, 0.0]),
        "velocity": np.zeros(3),
        "acceleration": np.zeros(3),
        "held": (True, True, True),
        "max_velocity": np.full(3, 300.0),
        "max_acceleration": np.full(3, 4000.0),
        "max_jerk": np.full(3, 80000.0),
        "together": False,
    }
    return Request(**{**values, **changes})  # type: ignore[arg-type]


def test_motion_obeys_its_limits_and_arrives() -> None:
    rows = Generator(3, 1e-3)(request(velocity=np.array([100.0, 50.0, -30.0])), 0.001)
    assert rows is not None
    q, v, a = rows
    assert q[-1] == pytest.approx([80.0, 0.0, 0.0])
    assert not v[-1].any()
    assert np.abs(v).max() <= 300.0 + 1e-6
    assert np.abs(a).max() <= 4000.0 + 1e-6
    assert np.abs(np.diff(a, axis=0)).max() <= 80000.0 * 0.001 + 1e-6
    assert np.diff(q, axis=0) == pytest.approx(0.0005 * (v[1:] + v[:-1]), abs=1e-4)


def test_axes_that_are_not_held_come_to_rest_where_they_may() -> None:
    rows = Generator(3, 1e-3)(
        request(velocity=np.array([0.0, 60.0, 0.0]), held=(True, False, False)), 0.01
    )
    assert rows is not None
    assert rows[0][-1][1] > 1.0
    assert not rows[1][-1].any()


def test_limits_that_make_no_sense_give_no_motion() -> None:
    assert Generator(3, 1e-3)(request(max_jerk=np.zeros(3)), 0.01) is None
    assert Generator(3, 1e-3)(request(displacement=np.full(3, np.nan)), 0.01) is None
    too_slow = request(max_velocity=np.full(3, 1e-6))  # ruckig's result has no name for this
    assert Generator(3, 1e-3)(too_slow, 0.01) is None


@pytest.mark.parametrize("ahead", [(100.0, 0.0, 0.0), (60.0, 60.0, 60.0), (0.0, -90.0, 20.0)])
def test_from_rest_the_norms_of_the_limits_are_used_up(
    robot: Robot, ahead: tuple[float, ...]
) -> None:
    space = CartesianSpace(robot)
    (limit,) = space.groups
    zero = np.zeros(3)
    way = Way(np.array(ahead) * 2, space.top)
    rows = Shaper(space, 0.001)(zero, zero, zero, way, Shares())
    assert rows is not None
    norms = [np.linalg.norm(part, axis=1).max() for part in rows[1:]]
    assert norms == pytest.approx([limit.velocity, limit.acceleration], rel=0.01)
    jerk = np.linalg.norm(np.diff(rows[2], axis=0), axis=1).max() / 0.001
    assert jerk == pytest.approx(limit.jerk, rel=0.01)


def test_a_turning_tool_has_limits_of_its_own(tool_robot: Robot) -> None:
    """Turn and tip together take as long as the slower of them alone, each at its full limits."""
    space = CartesianSpace(tool_robot)
    tip, turn = space.groups
    zero = np.zeros(4)
    way = np.array([90.0, -60.0, 30.0, 200.0])
    rows = Shaper(space, 0.001)(zero, zero, zero, Way(way, space.top), Shares())
    assert rows is not None
    q, _, a = rows
    assert q[-1] == pytest.approx(way)
    assert np.linalg.norm(a[:, :3], axis=1).max() == pytest.approx(tip.acceleration, rel=0.01)
    assert np.abs(a[:, 3]).max() == pytest.approx(turn.acceleration, rel=0.01)
    assert np.abs(np.cross(q[:, :3], way[:3])).max() < 1e-6, "the tip stays on its line"
    alone = [np.where(np.arange(4) < 3, way, 0.0), np.where(np.arange(4) < 3, 0.0, way)]
    times = []
    for part in alone:
        rows = Shaper(space, 0.001)(zero, zero, zero, Way(part, space.top), Shares())
        assert rows is not None
        times.append(len(rows[0]))
    assert len(q) == max(times)


def test_a_long_way_is_taken_in_parts() -> None:
    turning = Way(np.array([30.0, 40.0, 0.0, -80.0]), np.array([10.0, 20.0])).within(2.0)
    assert turning.displacement == pytest.approx([12.0, 16.0, 0.0, -32.0])
    slow = Way(np.array([30.0, 40.0, 0.0]), np.array([10.0]))
    assert slow.within(5.0) is slow
    part = slow.within(2.0).displacement
    assert part is not None
    assert part == pytest.approx([12.0, 16.0, 0.0])


# Straight lines.


def test_straight_line_within_reach_is_legal(robot: Robot) -> None:
    assert check_straight(robot, (0, 0, -300), (150, 50, -380)) is None
    assert check_straight(robot, (0, 0, -300), (0, 0, -300)) is None
    assert check_straight(robot, (0, 0, -300), (0, 0, -440)) is None


def test_straight_line_says_where_it_breaks_which_limit(robot: Robot) -> None:
    far = check_straight(robot, (0, 0, -300), (0, 0, -500)) or ""
    assert "(0.0, 0.0, -440." in far
    assert "bottom of the workspace (Z -440.0 mm)" in far
    assert "radius (230.0 mm)" in (check_straight(robot, (0, 0, -300), (400, 0, -300)) or "")
    assert check_straight(robot, (0, 0, -300), (np.nan, 0, 0)) is not None


def test_straight_line_between_legal_places_may_be_illegal(robot: Robot) -> None:
    rng = np.random.default_rng(1)
    places = rng.uniform([-220, -220, -440], [220, 220, -225], size=(8000, 3))
    places = places[robot.margins(places, robot.inverse(places)).min(axis=1) >= 0]
    share = np.linspace(0, 1, 60)[:, None]
    refused = 0
    for start, end in zip(places[:800], places[800:1600], strict=True):
        line = start + (end - start) * share
        illegal = bool((robot.margins(line, robot.inverse(line)).min(axis=1) < 0).any())
        why = check_straight(robot, start, end)
        assert why is not None or not illegal
        refused += illegal
    assert refused > 0


def test_straight_line_from_outside_may_lead_inward_only(robot: Robot) -> None:
    assert check_straight(robot, (0, 0, -445), (0, 0, -430)) is None
    assert check_straight(robot, (0, 0, -445), (0, 0, -446)) is not None
