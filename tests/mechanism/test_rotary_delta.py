import math
import warnings
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from deltaviz.mechanism import GeometryError, RotaryDelta
from tests.mechanism.slopes import assert_jacobian_is_the_slope_of_forward

ROBOTS = {
    "stm32": RotaryDelta(base_radius=115, effector_radius=75, upper_arm=125, forearm=338),
    "trossen": RotaryDelta.from_sides(f=457.3, e=115, upper_arm=112, forearm=232),
    "zheng": RotaryDelta(base_radius=260, effector_radius=50, upper_arm=360, forearm=900),
    "clockwise": RotaryDelta(
        base_radius=115,
        effector_radius=75,
        upper_arm=125,
        forearm=338,
        azimuths_deg=(0, -120, -240),
    ),
    "uneven": RotaryDelta(
        base_radius=(115.0, 117.5, 112.5),
        effector_radius=(75.0, 74.0, 77.0),
        upper_arm=(125.0, 122.0, 127.5),
        forearm=(338.0, 335.0, 342.0),
        azimuths_deg=(3.0, 118.0, 245.0),
    ),
}
robots = st.sampled_from(list(ROBOTS.values()))
angle = st.floats(math.radians(-80), math.radians(110))
angles = st.tuples(angle, angle, angle)


def spheres_missed(robot: RotaryDelta, xyz, theta) -> float:
    """How far the forearms' ends are from the pose, by the constraint itself (mm)."""
    lengths = np.linalg.norm(np.asarray(xyz)[..., None, :] - robot.elbows(theta), axis=-1)
    return float(np.abs(lengths - np.array(robot.forearm)).max())


def well_conditioned(robot: RotaryDelta, xyz, theta) -> bool:
    size = max(robot.forearm)
    firm = abs(robot.det_jx(xyz, theta)) > 1e-3 * size**3
    return bool(firm and np.abs(robot.jq(xyz, theta)).min() > 1e-2 * min(robot.upper_arm) * size)


def working(robot: RotaryDelta, theta) -> np.ndarray:
    """The pose, if it is well away from both singularities; else the example is dropped."""
    xyz = robot.forward(theta)
    assume(np.isfinite(xyz).all())
    assume(well_conditioned(robot, xyz, theta))
    return xyz


@given(robots, angles)
@settings(deadline=None, max_examples=300)
def test_round_trip_from_angles(robot, theta):
    xyz = working(robot, theta)
    assume((robot.jq(xyz, theta) > 0).all())
    back = robot.inverse(xyz)
    assert np.abs(back - theta).max() < 1e-10
    assert np.abs(robot.forward(back) - xyz).max() < 1e-9


@given(robots, angles)
@settings(deadline=None, max_examples=300)
def test_inverse_of_a_pose_with_an_elbow_inside_turns_that_elbow_out(robot, theta):
    xyz = working(robot, theta)
    inside = robot.jq(xyz, theta) < 0
    back = robot.inverse(xyz)
    assert (robot.jq(xyz, back) > 0).all()
    apart = np.abs(np.remainder(back - theta + math.pi, 2 * math.pi) - math.pi)
    assert (apart[inside] > 1e-3).all()
    assert (apart[~inside] < 1e-10).all()
    assume(well_conditioned(robot, xyz, back))
    assume(robot.det_jx(xyz, back) * robot.handedness < 0)
    assert np.abs(robot.forward(back) - xyz).max() < 1e-9


@given(robots, st.tuples(*[st.floats(-1.0, 1.0)] * 3))
@settings(deadline=None, max_examples=300)
def test_nan_exactly_where_an_arm_cannot_reach(robot, place):
    xyz = np.array(place) * (1.2 * (max(robot.upper_arm) + max(robot.forearm)))
    far, near = robot.misses(xyz)
    missed = np.maximum(far, near)
    assume(np.abs(missed).min() > 1e-9)
    theta = robot.inverse(xyz)
    if (missed < 0).all():
        assert np.isfinite(theta).all()
        assert spheres_missed(robot, xyz, theta) < 1e-9
    else:
        assert np.isnan(theta).all()


@given(robots, angles)
@settings(deadline=None, max_examples=300)
def test_forward_puts_the_effector_on_all_three_forearms_and_below(robot, theta):
    xyz = robot.forward(theta)
    assume(np.isfinite(xyz).all())
    assert spheres_missed(robot, xyz, theta) < 1e-6
    assert robot.det_jx(xyz, theta) * robot.handedness <= 1e-6 * max(robot.forearm) ** 3


@given(robots, angles)
@settings(deadline=None, max_examples=200)
def test_jacobian_is_the_slope_of_forward(robot, theta):
    working(robot, theta)
    assert_jacobian_is_the_slope_of_forward(robot, theta)


@given(angles)
@settings(deadline=None)
def test_threefold_symmetry(theta):
    """Handing the angles on by one arm turns the pose by a third of a turn."""
    robot = ROBOTS["stm32"]
    xyz = working(robot, theta)
    turned = robot.forward((theta[2], theta[0], theta[1]))
    cos, sin = math.cos(2 * math.pi / 3), math.sin(2 * math.pi / 3)
    expected = [cos * xyz[0] - sin * xyz[1], sin * xyz[0] + cos * xyz[1], xyz[2]]
    assert turned == pytest.approx(expected, abs=1e-9)


@given(angles)
@settings(deadline=None)
def test_order_of_arms_is_only_a_name(theta):
    """Arms listed clockwise are the same machine."""
    listed = ROBOTS["stm32"].forward((theta[0], theta[2], theta[1]))
    assume(np.isfinite(listed).all())
    assert ROBOTS["clockwise"].forward(theta) == pytest.approx(listed, abs=1e-8)


def test_every_arm_uses_its_own_lengths(uneven):
    theta = np.radians([10.0, 25.0, 40.0])
    xyz = uneven.forward(theta)
    assert spheres_missed(uneven, xyz, theta) < 1e-11
    assert uneven.inverse(xyz) == pytest.approx(theta, abs=1e-12)


@pytest.mark.parametrize("name", ["base_radius", "effector_radius", "upper_arm", "forearm"])
@pytest.mark.parametrize("arm", [0, 1, 2])
def test_changing_one_arms_length_changes_that_arms_angle_only(name, arm):
    lengths: dict[str, Any] = {
        "base_radius": 115.0,
        "effector_radius": 75.0,
        "upper_arm": 125.0,
        "forearm": 338.0,
    }
    plain = RotaryDelta(**lengths).inverse([20, -30, -320])
    changed = [lengths[name]] * 3
    changed[arm] += 1.0
    theta = RotaryDelta(**{**lengths, name: changed}).inverse([20, -30, -320])
    assert abs(theta[arm] - plain[arm]) > 1e-4
    assert np.delete(theta, arm) == pytest.approx(np.delete(plain, arm), abs=1e-15)


class TestWhereTextbooksDivideByZero:
    def test_effector_level_with_the_motors(self, trossen):
        robot = RotaryDelta(base_radius=300, effector_radius=50, upper_arm=200, forearm=350)
        theta = robot.inverse([10, 20, 0])
        assert spheres_missed(robot, [10, 20, 0], theta) < 1e-12

    def test_all_elbows_at_one_height(self, stm32):
        for angle_deg in (-45, 0, 30, 90):
            xyz = stm32.forward(np.radians([angle_deg] * 3))
            assert xyz[:2] == pytest.approx([0, 0], abs=1e-12)
            assert np.degrees(stm32.inverse(xyz)) == pytest.approx([angle_deg] * 3, abs=1e-9)

    def test_upper_arms_upright_and_hanging(self, stm32):
        for first in (-90, 90):
            for offset in (-1e-9, 0.0, 1e-9):
                theta = np.radians([first + offset, 10, 20])
                xyz = stm32.forward(theta)
                assert np.isfinite(xyz).all()
                assert spheres_missed(stm32, xyz, theta) < 1e-11

    def test_arms_beyond_the_vertical_do_not_wrap(self, trossen):
        theta = np.radians([100.0, 20.0, 20.0])
        xyz = trossen.forward(theta)
        assert trossen.inverse(xyz) == pytest.approx(theta, abs=1e-10)

    def test_effector_on_the_motor_axis(self):
        robot = RotaryDelta(base_radius=100, effector_radius=50, upper_arm=100, forearm=100)
        far, near = robot.misses([50, 0, 0])
        assert max(far[0], near[0]) == pytest.approx(0)
        assert not np.isinf(robot.inverse([50, 0, 0])).any()


class TestShapes:
    def test_leading_axes_are_kept(self, stm32):
        xyz = np.broadcast_to([10.0, -20.0, -300.0], (4, 5, 3))
        theta = stm32.inverse(xyz)
        assert theta.shape == (4, 5, 3)
        assert stm32.forward(theta).shape == (4, 5, 3)
        assert stm32.jacobian(theta).shape == (4, 5, 3, 3)
        assert stm32.margins(xyz, theta).shape == (4, 5, 5)
        np.testing.assert_array_equal(theta, np.broadcast_to(theta[0, 0], theta.shape))

    def test_one_point_and_none(self, stm32):
        assert stm32.inverse((0, 0, -300)).shape == (3,)
        assert stm32.inverse(np.empty((0, 3))).shape == (0, 3)
        assert stm32.forward(np.empty((0, 3))).shape == (0, 3)
        assert stm32.jacobian(np.empty((0, 3))).shape == (0, 3, 3)

    def test_whole_numbers_and_single_precision_become_double(self, stm32):
        single = stm32.inverse(np.array([10, 20, -300], dtype=np.float32))
        np.testing.assert_array_equal(single, stm32.inverse([10, 20, -300]))
        assert single.dtype == np.float64

    def test_the_arguments_are_left_alone(self, stm32):
        xyz = np.array([[0.0, 0.0, -300.0], [0.0, 0.0, -900.0]])
        before = xyz.copy()
        stm32.inverse(xyz)
        np.testing.assert_array_equal(xyz, before)

    @pytest.mark.parametrize("bad", [[1, 2], [1, 2, 3, 4], 5.0, [[1, 2]]])
    def test_a_wrong_last_axis_is_refused(self, stm32, bad):
        with pytest.raises(ValueError, match=r"shape .* must be \(\.\.\., 3\)"):
            stm32.inverse(bad)
        with pytest.raises(ValueError, match=r"shape .* must be \(\.\.\., 3\)"):
            stm32.forward(bad)

    def test_one_bad_row_spoils_no_other(self, stm32):
        rows = [[0, 0, -300], [np.nan, 0, -300], [np.inf, 0, -300], [1e300, 0, 0], [0, 0, -900]]
        theta = stm32.inverse(rows)
        assert np.isfinite(theta[0]).all()
        assert np.isnan(theta[1:]).all()


def test_no_warnings_leak(stm32):
    bad = [[np.nan, 0, -300], [np.inf, 0, -300], [1e300, 1e300, 0], [0, 0, 0], [0, 0, -900]]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        stm32.inverse(bad)
        stm32.forward(bad)
        stm32.jacobian(bad)
        stm32.misses(bad)
        stm32.margins(bad, stm32.inverse(bad))


GOOD: dict[str, Any] = {"base_radius": 115, "effector_radius": 75, "upper_arm": 125, "forearm": 338}


class TestConstructor:
    def test_one_number_serves_all_arms(self):
        assert RotaryDelta(**GOOD).forearm == (338.0, 338.0, 338.0)

    def test_keyword_only(self):
        with pytest.raises(TypeError):
            RotaryDelta(115, 75, 125, 338)  # type: ignore

    def test_a_value(self):
        assert RotaryDelta(**GOOD) == RotaryDelta(**{**GOOD, "forearm": [338] * 3})
        with pytest.raises(AttributeError):
            RotaryDelta(**GOOD).forearm = (1.0, 1.0, 1.0)  # type: ignore

    def test_from_sides_and_radii_agree(self):
        sides = RotaryDelta.from_sides(f=457.3, e=115, upper_arm=112, forearm=232)
        assert sides.base_radius[0] == pytest.approx(132.01113905)
        assert sides.effector_radius[0] == pytest.approx(33.19764048)
        assert sides.azimuths_deg == (-90, 30, 150)

    @pytest.mark.parametrize(
        ("field", "value", "rule"),
        [
            ("forearm", 0, "greater than 0"),
            ("forearm", -1, "greater than 0"),
            ("upper_arm", math.nan, "finite"),
            ("upper_arm", math.inf, "finite"),
            ("base_radius", [115, 115], "3"),
            ("base_radius", "long", "one number"),
            ("base_radius", True, "one number"),
            ("effector_radius", [75, -75, 75], "greater than 0"),
            ("base_radius", 600, "cannot close"),
            ("azimuths_deg", (0, 120, 120), "at least 1° apart"),
            ("azimuths_deg", (0, 120, 480), "at least 1° apart"),
            ("azimuths_deg", (0, 120), "3"),
        ],
    )
    def test_what_no_machine_can_be(self, field, value, rule):
        with pytest.raises(GeometryError) as refused:
            RotaryDelta(**{**GOOD, field: value})
        assert refused.value.field == field
        assert field in str(refused.value)
        assert rule in str(refused.value)
