import numpy as np
import pytest

from deltaviz.mechanism import Margin, MarginKind, RotaryDelta
from deltaviz.mechanism.stiffness import TYPE_1_RESERVE, TYPE_2_RESERVE, stiffness, unit


def margin(robot: RotaryDelta, kind: MarginKind, arm: int | None, xyz, theta=None) -> np.ndarray:
    theta = robot.inverse(xyz) if theta is None else theta
    return robot.margins(xyz, theta)[..., robot.margin_names.index(Margin(kind, arm))]


def lowering(z: np.ndarray) -> np.ndarray:
    return np.stack([0 * z, 0 * z, z], axis=-1)


def test_the_reserve_ends_before_reach_does(stm32):
    z = np.linspace(-450, -461.26, 2000)
    value = margin(stm32, MarginKind.TYPE_1, 0, lowering(z))
    edge = z[np.argmax(value < 0)]
    assert 1.0 < edge + 461.269 < 4.0
    discriminant = stm32.arms[0].discriminant(*np.array([0, 0, edge]))
    assert discriminant == pytest.approx(TYPE_1_RESERVE, abs=1e-3)


@pytest.mark.parametrize("arm", [0, 1, 2])
def test_type_1_falls_by_about_one_per_mm_across_the_edge_of_reach(stm32, arm):
    down = margin(stm32, MarginKind.TYPE_1, arm, lowering(-461.269 + np.array([4.0, 0.0, -4.0])))
    slopes = np.diff(down) / -4.0
    assert (slopes > 0.5).all()
    assert (slopes < 2.0).all()


def test_margins_stay_finite_and_negative_far_outside(stm32):
    points = np.array([[0, 0, -470], [0, 0, -2000], [5000, 0, 0], [0, 0, 0], [40, 0, 0]], float)
    values = stm32.margins(points, stm32.inverse(points))
    assert np.isfinite(values).all()
    assert (values.min(axis=-1) < 0).all()


def test_an_elbow_inside_is_beyond_its_margin(trossen):
    theta = np.radians([-57.3359375, 10.0, 10.0])
    for first in np.radians(np.linspace(-150, -60, 40)):
        theta[0] = first
        xyz = trossen.forward(theta)
        inside = trossen.jq(xyz, theta)[0] < 0
        if inside:
            assert margin(trossen, MarginKind.TYPE_1, 0, xyz, theta) < 0


def test_type_2_is_signed_and_zero_where_the_forearms_lie_flat(trossen):
    """The effector is drawn up through the elbows' plane, whatever the forearms say to it."""
    theta = np.zeros(3)
    elbow = trossen.elbows(theta)[0, 2]
    below, flat, above = (
        margin(trossen, MarginKind.TYPE_2, None, [0, 0, elbow + z], theta) for z in (-20, 0, 20)
    )
    reserve = TYPE_2_RESERVE * trossen.type_2_scale
    assert flat == pytest.approx(-reserve)
    assert below > flat > above
    assert (below - flat) / 20 == pytest.approx(1.0, abs=0.2)


def test_working_poses_are_inside(stm32):
    assert (stm32.margins([0, 0, -300], stm32.inverse([0, 0, -300])) > 10).all()


def test_poses_above_the_elbows_are_outside(stm32):
    point = np.array([0.0, 0.0, 300.0])
    theta = stm32.inverse(point)
    assert np.isfinite(theta).all()
    assert margin(stm32, MarginKind.TYPE_2, None, point) < 0


def test_order_of_arms_changes_no_margin(stm32):
    listed = RotaryDelta(
        base_radius=115,
        effector_radius=75,
        upper_arm=125,
        forearm=338,
        azimuths_deg=(0, 240, 120),
    )
    point = [30.0, 60.0, -330.0]
    ours = stm32.margins(point, stm32.inverse(point))
    theirs = listed.margins(point, listed.inverse(point))
    assert theirs[[0, 2, 1, 3, 4]] == pytest.approx(ours, abs=1e-12)


def test_lost_orientation_is_negative():
    """A pose of a small toy delta at which the couples have turned over."""
    robot = RotaryDelta(base_radius=32, effector_radius=24, upper_arm=40, forearm=88)
    rng = np.random.default_rng(1)
    points = rng.uniform([-90, -90, -120], [90, 90, -10], (20000, 3))
    theta = robot.inverse(points)
    points, theta = points[np.isfinite(theta[:, 0])], theta[np.isfinite(theta[:, 0])]
    turned = np.linalg.det(robot.couples(points, theta)) < 0
    assert turned.any()
    assert (margin(robot, MarginKind.PARALLELOGRAM, None, points, theta)[turned] < 0).all()


def test_stiffness_is_the_reciprocal_of_how_errors_grow():
    rng = np.random.default_rng(2)
    matrix = unit(rng.normal(size=(50, 3, 3)))
    grown = np.linalg.norm(np.linalg.inv(matrix), axis=(-2, -1))
    assert np.abs(stiffness(matrix)) == pytest.approx(1 / grown)
    assert np.sign(stiffness(matrix)) == pytest.approx(np.sign(np.linalg.det(matrix)))
    assert stiffness(np.ones((3, 3))) == 0.0
