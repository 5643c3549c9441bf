"""The numbers that a design chooses, and the robot that they make."""

from __future__ import annotations

from dataclasses import astuple, dataclass, fields, replace

from deltaviz.mechanism import FiveBar, RotaryDelta
from deltaviz.robots.robot import Robot, Zone

ANYWHERE = 1e6  # mm: a zone that ends nowhere


@dataclass(frozen=True, slots=True)
class Lengths:
    """mm. `base`: base radius, of a five-bar half the base. `floor`: z on which the body stands."""

    base: float
    upper_arm: float
    forearm: float
    floor: float

    def rounded(self, grain: float) -> Lengths:
        """To whole multiples of `grain` mm."""
        return Lengths(*(round(round(value / grain) * grain, 6) for value in astuple(self)))


@dataclass(frozen=True, slots=True)
class Ranges:
    """From, to of each of the lengths, mm."""

    base: tuple[float, float]
    upper_arm: tuple[float, float]
    forearm: tuple[float, float]
    floor: tuple[float, float]

    def __post_init__(self) -> None:
        for field in fields(self):
            low, high = getattr(self, field.name)
            if not low <= high:
                name = field.name.replace("_", " ")
                raise ValueError(f"{name}: from {low:g} to {high:g} mm there is nothing")

    def bounds(self) -> list[tuple[float, float]]:
        return list(astuple(self))


def made(template: Robot, lengths: Lengths) -> Robot:
    """The template with other lengths, free to go wherever its arms and joints allow.

    Raises GeometryError, and TypeError for a mechanism that has no such lengths.
    """
    old = template.mechanism
    if isinstance(old, RotaryDelta):
        mechanism = RotaryDelta(
            base_radius=lengths.base,
            effector_radius=old.effector_radius,
            upper_arm=lengths.upper_arm,
            forearm=lengths.forearm,
            azimuths_deg=old.azimuths_deg,
        )
    elif isinstance(old, FiveBar):
        mechanism = FiveBar(
            base_half=lengths.base,
            platform_half=old.platform_half,
            upper_arm=lengths.upper_arm,
            forearm=lengths.forearm,
        )
    else:
        raise TypeError(f"{template.name}: a {type(old).__name__} cannot be designed")
    free = Zone(z=(-ANYWHERE, ANYWHERE))
    return replace(template, mechanism=mechanism, zone=free)
