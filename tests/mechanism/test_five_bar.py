"""The five-bar: against poses solved at 50 digits, against its document, and by its properties."""

import math
import warnings

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from deltaviz.mechanism import FiveBar, GeometryError, Margin, MarginKind, RotaryDelta
from deltaviz.mechanism.stiffness import TYPE_2_RESERVE, planar_stiffness, unit
from tests.mechanism.slopes import assert_jacobian_is_the_slope_of_forward

ROBOTS = {
    "point": FiveBar(base_half=60, platform_half=0, upper_arm=100, forearm=200),
    "platform": FiveBar(base_half=150, platform_half=50, upper_arm=350, forearm=800),
    "one axis": FiveBar(base_half=0, platform_half=0, upper_arm=100, forearm=200),
    "wide platform": FiveBar(base_half=20, platform_half=55, upper_arm=90, forearm=170),
    "long upper arms": FiveBar(base_half=30, platform_half=0, upper_arm=200, forearm=150),
    "uneven": FiveBar(
        base_half=(60.0, 63.0),
        platform_half=(20.0, 18.0),
        upper_arm=(100.0, 104.0),
        forearm=(200.0, 195.0),
    ),
}
robots = st.sampled_from(list(ROBOTS.values()))
angle = st.floats(math.radians(-80), math.radians(110))
angles = st.tuples(angle, angle)


def missed(robot: FiveBar, xz, theta) -> float:
    """How far the forearms' ends are from the pose, by the constraint itself (mm)."""
    lengths = np.linalg.norm(np.asarray(xz)[..., None, :] - robot.elbows(theta), axis=-1)
    return float(np.abs(lengths - np.array(robot.forearm)).max())


def well_conditioned(robot: FiveBar, xz, theta) -> bool:
    size = max(robot.forearm)
    firm = abs(robot.det_jx(xz, theta)) > 1e-3 * size**2
    return bool(firm and np.abs(robot.jq(xz, theta)).min() > 1e-2 * min(robot.upper_arm) * size)


def working(robot: FiveBar, theta) -> np.ndarray:
    """The pose, if it is well away from both singularities; else the example is dropped."""
    xz = robot.forward(theta)
    assume(np.isfinite(xz).all())
    assume(well_conditioned(robot, xz, theta))
    return xz


class TestReference:
    def test_inverse(self, planar_reference):
        theta = planar_reference.mechanism.inverse(planar_reference.column("ik", "xy"))
        assert np.abs(theta - planar_reference.angles("ik")).max() < 1.5e-13

    def test_forward(self, planar_reference):
        xz = planar_reference.mechanism.forward(planar_reference.angles("ik"))
        assert np.abs(xz - planar_reference.column("ik", "xy")).max() < 8e-13

    def test_every_root_of_each_arm(self, planar_reference):
        """Both branches; the working mode's is the first."""
        xz = planar_reference.column("ik", "xy")
        both = planar_reference.mechanism.solutions(xz)
        assert both[:, 0] == pytest.approx(planar_reference.angles("ik"), abs=1.5e-13)
        found = np.sort(np.degrees(np.moveaxis(both, -1, -2)), axis=-1)
        expected = np.sort(planar_reference.column("ik", "theta_all_deg"), axis=-1)
        assert np.abs(found - expected).max() < 1e-11

    def test_jacobian(self, planar_reference):
        jacobian = planar_reference.mechanism.jacobian(planar_reference.angles("ik"))
        expected = planar_reference.column("ik", "J")
        assert np.abs(jacobian - expected).max() < 1e-14 * np.abs(expected).max()

    def test_discriminants(self, planar_reference):
        mechanism = planar_reference.mechanism
        xz, theta = planar_reference.column("ik", "xy"), planar_reference.angles("ik")
        jq, det = planar_reference.column("ik", "jq"), planar_reference.column("ik", "det_Jx")
        np.testing.assert_allclose(mechanism.jq(xz, theta), jq, rtol=1e-13)
        np.testing.assert_allclose(mechanism.det_jx(xz, theta), det, rtol=1e-13)
        assert (jq > 0).all()
        assert (det < 0).all()


class TestDocument:
    """The 2-DOF document, with its mistakes corrected: its angles are 180° less ours."""

    def test_its_angles(self, planar_reference):
        ours = np.degrees(planar_reference.mechanism.inverse(planar_reference.column("ik", "xy")))
        theirs = planar_reference.column("ik", "doc_thetaL_R_deg")
        assert np.abs((180 - ours) - theirs).max() < 1e-11

    def test_forward_from_the_middle_of_the_elbows(self):
        """P = M - n √(l² - |D|²/4), for forearms alike."""
        robot = ROBOTS["point"]
        theta = np.radians([[20.0, 50.0], [-30.0, 65.0], [0.0, 0.0]])
        left = np.stack([-60 - 100 * np.cos(theta[:, 0]), -100 * np.sin(theta[:, 0])], -1)
        right = np.stack([60 + 100 * np.cos(theta[:, 1]), -100 * np.sin(theta[:, 1])], -1)
        d = right - left
        size = np.linalg.norm(d, axis=-1, keepdims=True)
        normal = np.stack([-d[:, 1], d[:, 0]], -1) / size
        expected = (left + right) / 2 - normal * np.sqrt(200.0**2 - size**2 / 4)
        assert robot.forward(theta) == pytest.approx(expected, abs=1e-12)

    def test_a_base_reduced_to_a_point(self):
        """Where the document divides by f. On the axis both arms stand alike, by the cosine rule:
        the shoulder's angle between upper arm and axis."""
        robot = ROBOTS["one axis"]
        for depth in (120.0, 200.0, 290.0):
            shoulder = math.acos((100**2 + depth**2 - 200**2) / (2 * 100 * depth))
            theta = robot.inverse([0.0, -depth])
            assert theta == pytest.approx([math.pi / 2 - shoulder] * 2)
            assert robot.forward(theta) == pytest.approx([0.0, -depth])

    def test_platform_width_is_taken_off_the_base(self):
        """Ignoring the platform is up to 24° off, as its readers were."""
        point, platform = (
            ROBOTS["point"],
            FiveBar(base_half=110, platform_half=50, upper_arm=100, forearm=200),
        )
        xz = np.array([[30.0, -180.0], [-55.0, -210.0]])
        assert platform.inverse(xz) == pytest.approx(point.inverse(xz), abs=1e-14)
        ignored = FiveBar(base_half=110, platform_half=0, upper_arm=100, forearm=200)
        assert np.degrees(np.abs(ignored.inverse(xz) - platform.inverse(xz))).max() > 10

    def test_the_forearm_needs_not_be_twice_the_upper_arm(self):
        robot = FiveBar(base_half=40, platform_half=10, upper_arm=110, forearm=170)
        theta = robot.inverse([25.0, -150.0])
        assert missed(robot, [25.0, -150.0], theta) < 1e-12

    def test_left_and_right_are_not_mixed_up(self):
        """Seen in a mirror the arms change places; atan2 tells x from -x."""
        for name in ("point", "platform", "one axis", "wide platform"):
            robot = ROBOTS[name]
            scale = robot.forearm[0] / 200
            xz = np.array([[70.0, -150.0], [-20.0, -200.0]]) * scale
            mirrored = robot.inverse(xz * [-1, 1])
            assert mirrored == pytest.approx(robot.inverse(xz)[:, ::-1], abs=1e-14)
            assert np.abs(robot.inverse(xz)[0, 0] - robot.inverse(xz)[0, 1]) > 0.1

    def test_an_arm_is_the_deltas_with_nothing_sideways(self):
        delta = RotaryDelta(base_radius=100, effector_radius=40, upper_arm=100, forearm=200)
        planar = FiveBar(base_half=100, platform_half=40, upper_arm=100, forearm=200)
        for x, z in ((30.0, -180.0), (-60.0, -190.0)):
            assert planar.inverse([x, z])[1] == pytest.approx(delta.inverse([x, 0.0, z])[0])


class TestProperties:
    @given(robots, angles)
    @settings(deadline=None, max_examples=300)
    def test_round_trip_from_angles(self, robot, theta):
        xz = working(robot, theta)
        assume((robot.jq(xz, theta) > 0).all())
        back = robot.inverse(xz)
        apart = np.abs(np.remainder(back - theta + math.pi, 2 * math.pi) - math.pi)
        assert apart.max() < 1e-10
        assert np.abs(robot.forward(back) - xz).max() < 1e-9

    @given(robots, st.tuples(*[st.floats(-1.0, 1.0)] * 2))
    @settings(deadline=None, max_examples=300)
    def test_nan_exactly_where_an_arm_cannot_reach(self, robot, place):
        xz = np.array(place) * (1.2 * (max(robot.upper_arm) + max(robot.forearm)))
        far, near = robot.misses(xz)
        out = np.maximum(far, near)
        assume(np.abs(out).min() > 1e-9)
        theta = robot.inverse(xz)
        if (out < 0).all():
            assert missed(robot, xz, theta) < 1e-9
            assert (robot.jq(xz, theta) > 0).all()
        else:
            assert np.isnan(theta).all()
        assert (np.isnan(robot.solutions(xz)).all(axis=-2) == (out > 0)).all()
        assert np.isfinite(robot.nearest_angles(xz)).all()

    @given(robots, angles)
    @settings(deadline=None, max_examples=300)
    def test_forward_is_nan_exactly_where_the_forearms_cannot_meet(self, robot, theta):
        left, right = robot.elbows(theta)
        apart = float(np.linalg.norm(right - left))
        one, two = robot.forearm
        spare = min(one + two - apart, apart - abs(one - two))
        assume(abs(spare) > 1e-6)
        xz = robot.forward(theta)
        assert np.isfinite(xz).all() == (spare > 0)
        if spare > 0:
            assert missed(robot, xz, theta) < 1e-6
            assert robot.det_jx(xz, theta) < 0

    @given(robots, angles)
    @settings(deadline=None, max_examples=200)
    def test_both_assemblies(self, robot, theta):
        xz = working(robot, theta)
        below, above = robot.assemblies(theta)
        assert below == pytest.approx(xz, abs=1e-12)
        assert missed(robot, above, theta) < 1e-6
        assert robot.det_jx(above, theta) == pytest.approx(-robot.det_jx(below, theta))

    @given(robots, st.tuples(*[st.floats(-1.0, 1.0)] * 2))
    @settings(deadline=None, max_examples=200)
    def test_four_working_modes_lead_to_one_place(self, robot, place):
        xz = np.array(place) * (max(robot.upper_arm) + max(robot.forearm))
        both = robot.solutions(xz)
        assume(np.isfinite(both).all())
        for left in both[:, 0]:
            for right in both[:, 1]:
                theta = np.array([left, right])
                assert missed(robot, xz, theta) < 1e-9
                assume(well_conditioned(robot, xz, theta))
                ways = robot.assemblies(theta)
                assert np.abs(ways - xz).max(axis=-1).min() < 1e-8
        signs = np.sign(robot.jq(xz, both))
        assert (signs[0] >= 0).all()
        assert (signs[1] <= 0).all()

    @given(robots, angles)
    @settings(deadline=None, max_examples=200)
    def test_jacobian_is_the_slope_of_forward(self, robot, theta):
        working(robot, theta)
        assert_jacobian_is_the_slope_of_forward(robot, theta)

    @given(robots, st.tuples(*[st.floats(-1.0, 1.0)] * 2))
    @settings(deadline=None, max_examples=200)
    def test_margins_are_finite_and_negative_out_of_reach(self, robot, place):
        xz = np.array(place) * (3 * (max(robot.upper_arm) + max(robot.forearm)))
        theta = robot.inverse(xz)
        values = robot.margins(xz, theta)
        assert np.isfinite(values).all()
        if np.isnan(theta).any():
            assert values.min() < 0


class TestSingular:
    def test_outstretched(self):
        """Type 1: the left arm in one line, from its motor at x = -60."""
        robot = ROBOTS["point"]
        for way in np.radians([-75.0, -60.0, -45.0]):
            edge = np.array([-60 + 300 * math.cos(way), 300 * math.sin(way)])
            inside = edge + (np.array([-60.0, 0.0]) - edge) * 1e-9
            theta = robot.inverse(inside)
            assert abs(robot.jq(inside, theta)[0]) < 1e-3 * robot.jq(inside, theta)[1]
            outside = edge + (edge - np.array([-60.0, 0.0])) * 1e-9
            assert np.isnan(robot.inverse(outside)).all()
            column = robot.margin_names.index(Margin(MarginKind.TYPE_1, 0))
            assert robot.margins(outside, theta)[column] < 0

    def test_forearms_in_one_line(self):
        """Type 2: the platform on the elbows' line, with nothing to hold it."""
        robot = FiveBar(base_half=140, platform_half=0, upper_arm=100, forearm=200)
        theta = np.array([1.0, 1.0]) * math.acos(0.6)
        xz = robot.forward(theta)
        assert xz[0] == pytest.approx(0.0, abs=1e-5)
        assert xz[1] == pytest.approx(-80.0, abs=1e-4)
        assert robot.det_jx([0.0, -80.0], theta) == pytest.approx(0.0, abs=1e-9)
        column = robot.margin_names.index(Margin(MarginKind.TYPE_2))
        reserve = TYPE_2_RESERVE * robot.type_2_scale
        below, flat, above = (
            robot.margins([0.0, -80.0 + z], theta)[column] for z in (-5.0, 0.0, 5.0)
        )
        assert flat == pytest.approx(-reserve)
        assert below > flat > above
        assert (below - flat) / 5 == pytest.approx(1.0, abs=0.1)
        assert np.isnan(robot.forward(theta - [1e-3, 1e-3])).all()

    def test_elbows_in_one_place(self):
        """The platform may swing about them: no place is the right one."""
        robot = ROBOTS["one axis"]
        assert np.isnan(robot.forward(np.radians([90.0, 90.0]))).all()
        assert np.isnan(robot.jacobian(np.radians([90.0, 90.0]))).all()

    def test_an_elbow_inside_is_beyond_its_margin(self):
        robot = ROBOTS["point"]
        xz = np.array([10.0, -220.0])
        outside, inside = robot.solutions(xz)
        column = robot.margin_names.index(Margin(MarginKind.TYPE_1, 1))
        assert robot.margins(xz, outside)[column] > 0
        assert robot.margins(xz, [outside[0], inside[1]])[column] < 0

    def test_stiffness_is_the_reciprocal_of_how_errors_grow(self):
        matrix = unit(np.random.default_rng(2).normal(size=(50, 2, 2)))
        grown = np.linalg.norm(np.linalg.inv(matrix), axis=(-2, -1))
        assert np.abs(planar_stiffness(matrix)) == pytest.approx(1 / grown)
        assert np.sign(planar_stiffness(matrix)) == pytest.approx(np.sign(np.linalg.det(matrix)))
        assert planar_stiffness(np.ones((2, 2))) == 0.0


class TestInput:
    @pytest.mark.parametrize(
        ("change", "says"),
        [
            ({"base_half": -1}, "base_half = -1: must be at least 0"),
            ({"platform_half": -0.5}, "platform_half = -0.5: must be at least 0"),
            ({"upper_arm": 0}, "upper_arm = 0: must be greater than 0"),
            ({"forearm": (200, math.nan)}, "forearm.*must be finite"),
            ({"forearm": (200, 200, 200)}, "forearm.*one number, or 2"),
            ({"base_half": 400}, "base_half.*forearms cannot meet"),
            ({"platform_half": 400}, "base_half.*forearms cannot meet"),
        ],
    )
    def test_what_is_no_five_bar(self, change, says):
        shape = {"base_half": 60, "platform_half": 0, "upper_arm": 100, "forearm": 200}
        with pytest.raises(GeometryError, match=says):
            FiveBar(**(shape | change))

    def test_shapes(self):
        robot = ROBOTS["point"]
        assert robot.inverse([0, -200]).shape == (2,)
        assert robot.forward(np.zeros((4, 3, 2))).shape == (4, 3, 2)
        assert robot.jacobian(np.zeros((4, 3, 2))).shape == (4, 3, 2, 2)
        assert robot.solutions(np.zeros((5, 2))).shape == (5, 2, 2)
        assert robot.sideways(np.zeros((5, 2))).shape == (5, 0)
        assert robot.margins([0, -200], np.zeros((6, 2))).shape == (6, 3)
        assert robot.inverse(np.empty((0, 2))).shape == (0, 2)
        with pytest.raises(ValueError, match=r"xyz has shape \(3,\)"):
            robot.inverse([0, 0, -200])
        with pytest.raises(ValueError, match=r"theta has shape \(3,\)"):
            robot.forward([0, 0, 0])

    def test_no_warnings_and_no_change_of_the_input(self):
        robot = ROBOTS["one axis"]
        points = np.array([[0.0, 0.0], [1e9, 0.0], [0.0, -200.0]])
        kept = points.copy()
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            theta = robot.inverse(points)
            robot.forward(theta)
            robot.jacobian(theta)
            robot.margins(points, theta)
            robot.misses(points)
        assert (points == kept).all()
        assert np.isnan(theta[:2]).all()
        assert np.isfinite(theta[2]).all()

    def test_blocks_and_single_poses_agree(self):
        robot = ROBOTS["uneven"]
        points = np.random.default_rng(3).uniform([-150, -290], [150, -60], (9000, 2))
        many = robot.inverse(points)
        some = np.array([robot.inverse(point) for point in points[::500]])
        np.testing.assert_array_equal(many[::500], some)
