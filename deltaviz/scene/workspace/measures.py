"""The qualities that sections are coloured by, and the colours."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from deltaviz.scene.rows import ColourKey
from deltaviz.scene.units import Array

PLAIN = "One colour"


@dataclass(frozen=True)
class Measure:
    """A field of `Quality`, as a person calls it."""

    name: str
    field: str
    unit: str


MEASURES = tuple(
    Measure(*of)
    for of in (
        ("Conditioning", "condition", ""),
        ("Resolution", "resolution", "mm per microstep"),
        ("Stiffness", "stiffness", "N/mm per N m/rad"),
        ("Slowest speed", "slowest", "mm/s per rad/s"),
        ("Fastest speed", "fastest", "mm/s per rad/s"),
        ("Least force", "least_force", "N per N m"),
        ("Most force", "most_force", "N per N m"),
        ("Near type 1", "type_1", "0 at the singularity"),
        ("Near type 2", "type_2", "0 at the singularity"),
        ("Joint margin", "joint_margin_deg", "°"),
        ("Ball joint", "ball_joint_deg", "°"),
    )
)
NAMES = (PLAIN, *(measure.name for measure in MEASURES))

PLAIN_COLOUR = (64, 156, 236)
# Even steps in lightness, told apart by every eye: dark blue, teal, green, yellow.
_STOPS = np.array(
    ((68, 40, 120), (58, 82, 152), (36, 132, 152), (40, 178, 120), (150, 214, 62), (252, 231, 62))
)


def measure_named(name: str) -> Measure | None:
    """None for one colour."""
    return next((measure for measure in MEASURES if measure.name == name), None)


def coloured(share: Array) -> NDArray[np.uint8]:
    """(..., 3) for shares from 0 to 1 of the scale; beyond them, its ends."""
    places = np.linspace(0.0, 1.0, len(_STOPS))
    bands = [np.interp(share, places, band) for band in _STOPS.T]
    return np.stack(bands, axis=-1).astype(np.uint8)


def colour_key(measure: Measure, ends: tuple[float, float]) -> ColourKey:
    low, high = (f"{end:.3g}" for end in ends)
    unit = f", {measure.unit}" if measure.unit else ""
    stops = tuple((r, g, b) for r, g, b in _STOPS.tolist())
    return ColourKey(f"{measure.name}{unit}", low, high, stops)
