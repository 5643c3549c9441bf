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


@dataclass(frozen=True, slots=True)
class PlanarBodies:
    """Of a five-bar whose parts all lie in one plane, mm. Base and platform are bars between
    their joints; one without width is no more than a joint."""

    base_thickness: float
    upper_arm_width: float
    forearm_width: float
    platform_thickness: float
