"""Torques, against Euler and Lagrange at 50 digits and against energy."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from deltaviz.mechanism import FiveBar, RotaryDelta
from deltaviz.mechanism.dynamics import (
    GRAVITY,
    RodModel,
    forward_motion,
    holding_torques,
    inverse_motion,
    torques,
)
from deltaviz.mechanism.masses import Masses

FOLDER = Path(__file__).parents[1] / "data" / "reference" / "dynamics"


def reference(name: str) -> tuple[RotaryDelta, Masses, list[np.ndarray]]:
    """The mechanism, its masses, and θ, θ̇, θ̈, τ (10, 3) each."""
    data = json.loads((FOLDER / f"{name}.json").read_text())
    lengths, kg, cases = data["geometry"], data["masses"], data["cases"]
    mechanism = RotaryDelta(
        base_radius=lengths["base_radius"],
        effector_radius=lengths["platform_radius"],
        upper_arm=lengths["upper_arm"],
        forearm=lengths["forearm"],
    )
    assert kg["g"] == GRAVITY
    masses = Masses(
        effector=kg["platform_and_payload"],
        upper_arm=kg["upper_arm"],
        forearm=kg["forearm_pair"],
        motor_inertia=kg["motor_inertia"],
    )
    columns = [np.array([case[key] for case in cases]) for key in COLUMNS]
    return mechanism, masses, [np.radians(columns[0]), *columns[1:]]


COLUMNS = ("theta_deg", "theta_dot", "theta_ddot", "tau")
NAMES = ["zheng_chen", "irb360_like"]


@pytest.mark.parametrize("name", NAMES)
def test_torques_of_a_uniform_rod(name: str) -> None:
    mechanism, masses, (theta, speed, change, tau) = reference(name)
    motion = forward_motion(mechanism, theta, speed, change)
    assert np.abs(torques(mechanism, masses, motion) - tau).max() < 1e-11 * np.abs(tau).max()


@pytest.mark.parametrize(
    ("rods", "off"), [(RodModel.TWO_THIRDS, 0.052), (RodModel.HALVES, 0.120)], ids=lambda v: str(v)
)
def test_lumped_rods_are_off(rods: RodModel, off: float) -> None:
    """By which share of the torques of quick motions, at up to 80 rad/s²."""
    shares = []
    for name in NAMES:
        mechanism, masses, (theta, speed, change, tau) = reference(name)
        lumped = torques(
            mechanism, masses, forward_motion(mechanism, theta, speed, change), rods=rods
        )
        shares.append(np.linalg.norm(lumped - tau, axis=1) / np.linalg.norm(tau, axis=1))
    assert np.sqrt(np.mean(np.square(shares))) == pytest.approx(off, rel=0.02)


def test_a_payload_is_more_effector() -> None:
    mechanism, masses, (theta, speed, change, _) = reference("zheng_chen")
    motion = forward_motion(mechanism, theta, speed, change)
    heavy = Masses(masses.effector + 2.5, masses.upper_arm, masses.forearm, masses.motor_inertia)
    np.testing.assert_allclose(
        torques(mechanism, masses, motion, payload=2.5), torques(mechanism, heavy, motion)
    )


@pytest.mark.parametrize("name", NAMES)
def test_motion_there_and_back(name: str) -> None:
    mechanism, _, (theta, speed, change, _) = reference(name)
    motion = forward_motion(mechanism, theta, speed, change)
    back = inverse_motion(mechanism, motion.position, motion.velocity, motion.acceleration)
    # Where an angle of the reference has its elbow inside, the inverse gives another.
    same = (np.abs(back.theta - theta) < 1e-9).all(axis=1)
    assert same.sum() >= 5
    np.testing.assert_allclose(back.theta_dot[same], speed[same], rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(back.theta_ddot[same], change[same], rtol=1e-8, atol=1e-7)


def test_velocity_and_acceleration_are_those_of_positions() -> None:
    mechanism, _, (theta, speed, change, _) = reference("zheng_chen")
    motion = forward_motion(mechanism, theta, speed, change)
    h = 1e-4
    before, after = (mechanism.forward(theta + speed * t + change * t * t / 2) for t in (-h, h))
    np.testing.assert_allclose((after - before) / (2 * h), motion.velocity, rtol=1e-4, atol=0.05)
    second = (after - 2 * motion.position + before) / h**2
    scale = np.abs(motion.acceleration).max()
    assert np.abs(second - motion.acceleration).max() < 1e-3 * scale


PLANAR = FiveBar(base_half=80, platform_half=20, upper_arm=100, forearm=200)
LIGHT = Masses(effector=0.15, upper_arm=0.06, forearm=0.05, motor_inertia=2.3e-5)


def energy(theta: np.ndarray, theta_dot: np.ndarray) -> float:
    """J of the five-bar, by adding up short pieces of its links."""
    still = np.zeros(2)
    motion = forward_motion(PLANAR, theta, theta_dot, still)
    tip, speed = motion.position / 1000, motion.velocity / 1000
    total = 0.5 * LIGHT.effector * speed @ speed + LIGHT.effector * GRAVITY * tip[1]
    shares = (np.arange(2000) + 0.5) / 2000
    for i, side in enumerate((-1.0, 1.0)):
        cos, sin = np.cos(theta[i]), np.sin(theta[i])
        motor, platform = np.array((side * 0.08, 0.0)), np.array((side * 0.02, 0.0))
        elbow = motor + 0.1 * np.array((side * cos, -sin))
        moving = 0.1 * np.array((-side * sin, -cos)) * theta_dot[i]
        ends = (motor, 0 * moving, elbow, moving), (elbow, moving, tip + platform, speed)
        for (start, v0, end, v1), kg in zip(ends, (LIGHT.upper_arm, LIGHT.forearm), strict=True):
            v = v0 + (v1 - v0) * shares[:, None]
            z = start[1] + (end[1] - start[1]) * shares
            total += kg * np.mean(0.5 * (v * v).sum(axis=1) + GRAVITY * z)
        total += 0.5 * LIGHT.motor_inertia * theta_dot[i] ** 2
    return float(total)


def test_the_five_bars_power_is_its_energys_change() -> None:
    random = np.random.default_rng(13)
    for _ in range(5):
        theta, speed = random.uniform(-0.3, 0.9, 2), random.uniform(-5, 5, 2)
        change = random.uniform(-50, 50, 2)
        motion = forward_motion(PLANAR, theta, speed, change)
        power = float(torques(PLANAR, LIGHT, motion) @ speed)
        h = 1e-5
        after, before = (
            energy(theta + speed * t + change * t * t / 2, speed + change * t) for t in (h, -h)
        )
        assert power == pytest.approx((after - before) / (2 * h), rel=1e-4, abs=1e-4)


def test_holding_is_no_motion_and_carries_the_weight() -> None:
    """Virtual work: the torque is how much the weight rises for a small turn."""
    mechanism, masses, (theta, *_) = reference("zheng_chen")
    held = holding_torques(mechanism, masses, theta, payload=1.0)
    more = holding_torques(mechanism, masses, theta, payload=2.0)
    h = 1e-6
    for i in range(3):
        turn = np.zeros(3)
        turn[i] = h
        rise = (mechanism.forward(theta + turn) - mechanism.forward(theta - turn))[:, 2] / (2 * h)
        np.testing.assert_allclose((more - held)[:, i], GRAVITY * rise / 1000, rtol=1e-5, atol=1e-6)
