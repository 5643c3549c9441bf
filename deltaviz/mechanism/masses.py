"""What a mechanism's parts weigh."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Masses:
    """kg, and kg m². `effector` with its tool, without payload; `upper_arm` and `forearm` (both
    rods of it) of one arm each, the same mass at every place along it; `motor_inertia` of one
    motor, turned to the arm's shaft: the rotor's own times the square of the gear."""

    effector: float
    upper_arm: float
    forearm: float
    motor_inertia: float
