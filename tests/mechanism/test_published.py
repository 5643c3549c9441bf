"""Numbers that others published for their own robots."""

import numpy as np
import pytest

from deltaviz.mechanism import RotaryDelta

INCH = 25.4


def test_trossen_tutorial(trossen):
    assert trossen.forward([0, 0, 0]) == pytest.approx([0, 0, -96.859015171], abs=1e-9)


@pytest.mark.parametrize(
    ("point", "angles_deg"),
    [
        ((0, 0, 11), (35.390478, 35.390478, 35.390478)),
        ((3, 4, 10), (17.849216, 74.970084, 26.684261)),
    ],
)
def test_deltadraw(point, angles_deg):
    """Inches. Its z points down from 0.51 below our origin and its y against ours: our frame,
    turned by half a turn about x."""
    robot = RotaryDelta(
        base_radius=2.11125 * INCH,
        effector_radius=1.0 * INCH,
        upper_arm=2.489 * INCH,
        forearm=10.546875 * INCH,
    )
    x, y, z = point
    theta = robot.inverse(np.array([x, -y, -(z + 0.51)]) * INCH)
    assert np.degrees(theta) == pytest.approx(angles_deg, abs=1e-6)


class TestFireStep:
    """Its tests give XYZ from a rounded zero: 247.893 below the base."""

    robot = RotaryDelta.from_sides(f=190.526, e=131.636, upper_arm=90, forearm=270)

    def test_forward(self):
        zero, one = self.robot.forward(np.radians([[0, 0, 0], [1, 1, 1]]))
        assert zero[2] == pytest.approx(-247.893088, abs=1e-6)
        assert one[2] - zero[2] == pytest.approx(-1.57663, abs=1e-5)

    @pytest.mark.parametrize(
        ("point", "angles_deg"),
        [
            ((0, 0, 65), (-64.651190, -64.651190, -64.651190)),
            ((0, 0, -10), (6.232677, 6.232677, 6.232677)),
            ((1, 2, 3), (-1.360184, -2.438102, -1.955057)),
        ],
    )
    def test_inverse(self, point, angles_deg):
        theta = self.robot.inverse(np.array(point) - [0, 0, 247.893])
        assert np.degrees(theta) == pytest.approx(angles_deg, abs=1e-6)


@pytest.fixture(scope="module")
def scan(stm32):
    axis, height = np.arange(-250.0, 251.0, 20.0), np.arange(-460.0, -99.0, 20.0)
    points = np.stack(np.meshgrid(axis, axis, height), axis=-1).reshape(-1, 3)
    points = points[np.hypot(points[:, 0], points[:, 1]) <= 250]
    theta = stm32.inverse(points)
    reached = np.isfinite(theta).all(axis=-1)
    return points[reached], theta[reached]


class TestStm32Scan:
    """The scan of the STM32F407 library: x, y = -250:20:250, z = -460:20:-100, r <= 250."""

    def test_reachable_points(self, scan):
        assert len(scan[0]) == 5928

    def test_within_the_joint_limits(self, scan):
        inside = (scan[1] >= np.radians(-45)) & (scan[1] <= np.radians(90))
        assert inside.all(axis=-1).sum() == 3786

    def test_angles_found(self, scan):
        extremes = np.degrees([scan[1].min(), scan[1].max()])
        assert extremes == pytest.approx([-150, 119], abs=0.5)

    @pytest.mark.parametrize(
        ("z", "radius"), [(-460, 14.1), (-440, 103.0), (-400, 192.4), (-360, 247.0), (-100, 247.0)]
    )
    def test_largest_radius(self, scan, z, radius):
        at_height = scan[0][scan[0][:, 2] == z]
        assert np.hypot(at_height[:, 0], at_height[:, 1]).max() == pytest.approx(radius, abs=0.05)

    def test_forward_leads_back(self, scan, stm32):
        assert np.abs(stm32.forward(scan[1]) - scan[0]).max() < 1e-9

    def test_height_of_the_centre(self, stm32):
        reached = [[0, 0, -461.25], [0, 0, -209.25]]
        missed = [[0, 0, -461.35], [0, 0, -209.15]]
        assert np.isfinite(stm32.inverse(reached)).all()
        assert np.isnan(stm32.inverse(missed)).all()
