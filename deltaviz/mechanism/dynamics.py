"""Motion, forces and torques of arms that carry an effector by forearms.

With elbow centres moved inward D_i(θ_i), S_i = P - D_i and ' for d/dθ:

    S·V = (S·D') θ̇        S·A = (S·D') θ̈ + (S·D'') θ̇² - |V - D' θ̇|²

A uniform rod of mass m, whose ends move with accelerations a1 (elbow) and a2 (effector), needs
there exactly the forces F1 = m [(a1-g)/3 + (a2-g)/6] and F2 = m [(a1-g)/6 + (a2-g)/3]. By virtual
work τ_i = I θ̈_i - m_u (L/2) (g along D'/L) + F1_i · D'_i + [Jᵀ (m_e (A-g) + Σ F2)]_i, where a
uniform upper arm has I = m_u L²/3 and the motor's inertia with it.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import ArrayLike

from deltaviz.mechanism.arrays import Array, rows
from deltaviz.mechanism.five_bar import FiveBar
from deltaviz.mechanism.masses import Masses
from deltaviz.mechanism.rotary_delta import RotaryDelta

GRAVITY = 9.81  # m/s², along -z
METRE = 1e-3  # of a mm

Armed = RotaryDelta | FiveBar


class RodModel(Enum):
    """How the forearms' mass moves. The lumped ones are published and simpler to think of: they
    put shares of it at the two ends."""

    UNIFORM = "uniform"
    TWO_THIRDS = "2/3 at the elbow, 1/3 at the effector"
    HALVES = "half at each end"


# Of F1 and F2: the weights of (a1 - g) and (a2 - g) in each, times the mass.
_WEIGHTS = {
    RodModel.UNIFORM: ((1 / 3, 1 / 6), (1 / 6, 1 / 3)),
    RodModel.TWO_THIRDS: ((2 / 3, 0.0), (0.0, 1 / 3)),
    RodModel.HALVES: ((1 / 2, 0.0), (0.0, 1 / 2)),
}


@dataclass(frozen=True)
class Motion:
    """Joints (..., n) in rad, rad/s, rad/s²; the effector (..., d) in mm, mm/s, mm/s²."""

    theta: Array
    theta_dot: Array
    theta_ddot: Array
    position: Array
    velocity: Array
    acceleration: Array


@np.errstate(all="ignore")
def forward_motion(
    mechanism: Armed, theta: ArrayLike, theta_dot: ArrayLike, theta_ddot: ArrayLike
) -> Motion:
    """The effector's motion of the joints'; NaN where `forward` is, and at type 2."""
    n = mechanism.joints
    angle = rows(theta, n, "theta")
    speed, change = rows(theta_dot, n, "theta_dot"), rows(theta_ddot, n, "theta_ddot")
    position, jacobian = mechanism.forward(angle), mechanism.jacobian(angle)
    velocity = (jacobian @ speed[..., None])[..., 0]
    first, second = _elbow_slopes(mechanism, angle)
    forearm = position[..., None, :] - mechanism.elbows(angle)
    along = (forearm * second).sum(axis=-1) * speed**2
    swing = ((velocity[..., None, :] - first * speed[..., None]) ** 2).sum(axis=-1)
    torqued = (forearm * first).sum(axis=-1)
    # J = Jx⁻¹ diag(S·D'), so Jx⁻¹ applied to anything is J applied to it over S·D'.
    driven = change + (along - swing) / torqued
    acceleration = (jacobian @ driven[..., None])[..., 0]
    return Motion(angle, speed, change, position, velocity, acceleration)


@np.errstate(all="ignore")
def inverse_motion(
    mechanism: Armed, position: ArrayLike, velocity: ArrayLike, acceleration: ArrayLike
) -> Motion:
    """The joints' motion of the effector's; NaN where out of reach, and at type 1."""
    d = len(mechanism.axes)
    place = rows(position, d, "position")
    speed, change = rows(velocity, d, "velocity"), rows(acceleration, d, "acceleration")
    angle = mechanism.inverse(place)
    first, second = _elbow_slopes(mechanism, angle)
    forearm = place[..., None, :] - mechanism.elbows(angle)
    torqued = (forearm * first).sum(axis=-1)
    theta_dot = (forearm * speed[..., None, :]).sum(axis=-1) / torqued
    swing = ((speed[..., None, :] - first * theta_dot[..., None]) ** 2).sum(axis=-1)
    along = (forearm * second).sum(axis=-1) * theta_dot**2
    theta_ddot = ((forearm * change[..., None, :]).sum(axis=-1) + swing - along) / torqued
    return Motion(angle, theta_dot, theta_ddot, place, speed, change)


@np.errstate(all="ignore")
def torques(
    mechanism: Armed,
    masses: Masses,
    motion: Motion,
    *,
    payload: float = 0.0,
    rods: RodModel = RodModel.UNIFORM,
) -> Array:
    """(..., n) N m at the arms' shafts, positive where they push an arm down, for a motion and a
    payload (kg) at the effector's centre."""
    gravity = np.zeros(motion.position.shape[-1])
    gravity[-1] = -GRAVITY
    first, second = (s * METRE for s in _elbow_slopes(mechanism, motion.theta))
    speed, change = motion.theta_dot[..., None], motion.theta_ddot[..., None]
    elbows = first * change + second * speed**2 - gravity
    effector = motion.acceleration * METRE - gravity
    (own, other), (across, far) = _WEIGHTS[rods]
    at_elbow = masses.forearm * (own * elbows + other * effector[..., None, :])
    at_effector = masses.forearm * (across * elbows + far * effector[..., None, :])
    force = (masses.effector + payload) * effector + at_effector.sum(axis=-2)
    jacobian = mechanism.jacobian(motion.theta) * METRE
    upper = np.array(mechanism.upper_arm) * METRE
    inertia = masses.motor_inertia + masses.upper_arm * upper**2 / 3
    weight = masses.upper_arm / 2 * (first @ gravity)
    held = (at_elbow * first).sum(axis=-1)
    carried = (np.swapaxes(jacobian, -1, -2) @ force[..., None])[..., 0]
    return inertia * motion.theta_ddot - weight + held + carried


def holding_torques(
    mechanism: Armed, masses: Masses, theta: ArrayLike, *, payload: float = 0.0
) -> Array:
    """(..., n) N m at rest. The same for every model of the rods that leaves their centre in the
    middle."""
    angle = rows(theta, mechanism.joints, "theta")
    still = np.zeros_like(angle)
    return torques(
        mechanism, masses, forward_motion(mechanism, angle, still, still), payload=payload
    )


def _elbow_slopes(mechanism: Armed, theta: Array) -> tuple[Array, Array]:
    """dD/dθ and d²D/dθ², (..., n, d) mm."""
    d = len(mechanism.axes)
    first, second = np.zeros((*theta.shape, d)), np.zeros((*theta.shape, d))
    for i, arm in enumerate(mechanism.arms):
        outward = (arm.cos, arm.sin)[: d - 1]
        cos, sin = np.cos(theta[..., i]), np.sin(theta[..., i])
        for axis, share in enumerate(outward):
            first[..., i, axis] = -arm.upper_arm * sin * share
            second[..., i, axis] = -arm.upper_arm * cos * share
        first[..., i, -1] = -arm.upper_arm * cos
        second[..., i, -1] = arm.upper_arm * sin
    return first, second
