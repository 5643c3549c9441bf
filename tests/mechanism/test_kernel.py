"""The compiled functions are the numpy functions, for the tool tip and with all limits."""

import importlib
from dataclasses import replace

import numpy as np
import pytest

from deltaviz.mechanism import FiveBar, RotaryDelta
from deltaviz.robots import Robot, load_robot, preset_names
from deltaviz.robots.robot import Zone


def uneven_robot() -> Robot:
    mechanism = RotaryDelta(
        base_radius=(115.0, 117.5, 112.5),
        effector_radius=(75.0, 74.0, 77.0),
        upper_arm=(125.0, 122.0, 127.5),
        forearm=(338.0, 335.0, 342.0),
        azimuths_deg=(245.0, 118.0, 3.0),
    )
    plain = load_robot("stm32")
    return replace(
        plain,
        mechanism=mechanism,
        tool_offset=(3.0, -4.0, -25.0),
        zone=Zone(z=(-440.0, -250.0), radius=220.0, x=(-150.0, 160.0), y=(-170.0, 180.0)),
    )


def uneven_five_bar() -> Robot:
    mechanism = FiveBar(
        base_half=(60.0, 0.0),
        platform_half=(20.0, 18.0),
        upper_arm=(100.0, 104.0),
        forearm=(200.0, 195.0),
    )
    plain = load_robot("fivebar")
    return replace(
        plain,
        mechanism=mechanism,
        tool_offset=(3.0, -25.0),
        zone=Zone(z=(-270.0, -150.0), x=None),
    )


UNEVEN = {"uneven": uneven_robot, "uneven five-bar": uneven_five_bar}


@pytest.fixture(scope="module", params=[*preset_names(), *UNEVEN])
def robot(request):
    return UNEVEN.get(request.param, lambda: load_robot(request.param))()


@pytest.fixture(scope="module")
def points(robot):
    """In, beside and out of reach."""
    size = robot.mechanism.upper_arm[0] + robot.mechanism.forearm[0]
    across = len(robot.axes) - 1
    low, high = [-size] * across + [-1.1 * size], [size] * across + [0.1 * size]
    return np.random.default_rng(7).uniform(low, high, (4000, across + 1))


@pytest.fixture(scope="module")
def poses(robot, points):
    """(xyz, theta) of assemblies below the elbows."""
    theta = robot.inverse(points)
    known = np.isfinite(theta).all(axis=-1)
    theta = theta[known]
    return np.ascontiguousarray(robot.forward(theta)), theta


def same(kernel: np.ndarray, numpy: np.ndarray, tolerance: float) -> None:
    np.testing.assert_array_equal(np.isnan(kernel), np.isnan(numpy))
    np.testing.assert_allclose(kernel, numpy, rtol=1e-10, atol=tolerance)


def test_inverse(robot, points):
    same(robot.kernel.inverse(points), robot.inverse(points), 1e-12)


def test_forward(robot):
    theta = np.random.default_rng(8).uniform(-1.5, 2.5, (4000, robot.joint_count))
    same(robot.kernel.forward(theta), robot.forward(theta), 1e-9)


def test_margins_inside_and_outside(robot, points):
    theta = robot.inverse(points)
    kernel = robot.kernel.margins(points, theta)
    assert kernel.shape == (len(points), len(robot.margin_names))
    assert np.isfinite(kernel).all()
    same(kernel, robot.margins(points, theta), 1e-9)


def test_velocities_are_the_jacobians(robot, poses):
    xyz, theta = poses
    well = np.abs(robot.mechanism.det_jx(xyz - robot.tool_offset, theta)) > 1e-2 * (
        robot.mechanism.forearm[0] ** len(robot.axes)
    )
    well &= robot.mechanism.jq(xyz - robot.tool_offset, theta).min(axis=-1) > 100.0
    xyz, theta = np.ascontiguousarray(xyz[well]), np.ascontiguousarray(theta[well])
    assert len(xyz) > 100
    turning = np.random.default_rng(9).normal(size=theta.shape)
    moving = robot.kernel.tip_velocity(xyz, theta, turning)
    expected = (robot.jacobian(theta) @ turning[..., None])[..., 0]
    np.testing.assert_allclose(moving, expected, rtol=1e-9, atol=1e-8)
    back = robot.kernel.joint_velocity(xyz, theta, moving)
    np.testing.assert_allclose(back, turning, rtol=1e-8, atol=1e-9)


def test_velocity_at_an_outstretched_arm_is_not_finite():
    robot = load_robot("stm32")
    xyz = np.array([[0.0, 0.0, -np.sqrt(463.0**2 - 40.0**2)]])
    theta = robot.kernel.inverse(xyz)
    speed = robot.kernel.joint_velocity(xyz, theta, np.array([[0.0, 0.0, -1.0]]))
    assert not (np.abs(speed) < 1e3).all()


def test_no_poses(robot):
    empty = np.empty((0, robot.joint_count))
    assert robot.kernel.inverse(empty).shape == empty.shape
    assert robot.kernel.margins(empty, empty).shape == (0, len(robot.margin_names))


def test_warm_up_compiles_everything(robot):
    robot.kernel.warm_up()
    planar = isinstance(robot.mechanism, FiveBar)
    files = ["five_bar_compiled"] if planar else ["rotary_delta_compiled"]
    files += [] if planar else ["rotary_delta_batch_compiled"]
    modules = [importlib.import_module(f"deltaviz.mechanism.{name}") for name in files]
    for name in ("inverse", "forward", "margins", "joint_velocity", "tip_velocity"):
        compiled = next(getattr(m, name) for m in modules if hasattr(m, name))
        assert len(compiled.signatures) == 1, "a later call would compile"
