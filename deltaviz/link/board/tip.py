"""Cartesian knots: their units, and what they are in joints."""

from __future__ import annotations

from deltaviz.link.board.kinematics import Vector
from deltaviz.link.board.parameters import Parameters
from deltaviz.link.board.queue import Knot

P_STEP = 1 / 256_000  # mm: the unit of a knot's position
V_STEP = 1 / 65_536  # mm/s: the unit of its velocity
_JOINT_P = 1024  # to a microstep


def tip_knot(parameters: Parameters, knot: Knot) -> Knot | None:
    """Where the tip is at a knot of the joints that rests; None: there is none."""
    kinematics = parameters.kinematics
    if kinematics is None:
        return None
    arms, per_rad = len(kinematics.arms), parameters.configure.microsteps_per_rad
    theta = [p / _JOINT_P / m for p, m in zip(knot.p[:arms], per_rad[:arms], strict=True)]
    tip = kinematics.tip(theta)
    if tip is None:
        return None
    p = tuple(round(x / P_STEP) for x in tip) + knot.p[arms:]
    return Knot(p, (0,) * len(p), cartesian=True)


def joint_knot(parameters: Parameters, knot: Knot) -> Knot | None:
    """Where the joints are at a knot of the tip that rests; None: out of reach."""
    angles = None if parameters.kinematics is None else parameters.kinematics.angles(tip_of(knot))
    if angles is None:
        return None
    per_rad = parameters.configure.microsteps_per_rad
    p = tuple(round(a * m * _JOINT_P) for a, m in zip(angles, per_rad, strict=False)) + knot.p[3:]
    return Knot(p, (0,) * len(p))


def tip_of(knot: Knot) -> Vector:
    """mm"""
    x, y, z = (p * P_STEP for p in knot.p[:3])
    return (x, y, z)
