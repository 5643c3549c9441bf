"""How thick a robot's parts are: what must not touch."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Bodies:
    """Of a rotary delta, mm. Base and effector are three arms from their centre to the joints;
    a forearm is two rods, `rod_spacing` apart between their centre lines."""

    base_thickness: float
    upper_arm_diameter: float
    rod_diameter: float
    rod_spacing: float
    effector_thickness: float
