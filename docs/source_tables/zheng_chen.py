"""Zheng and Chen's machine: its cylinder, and ours."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from deltaviz.mechanism import RotaryDelta
from source_tables.comparison import Row, table

ROBOT = RotaryDelta(base_radius=260, effector_radius=50, upper_arm=360, forearm=900)


def cylinder_rows() -> Iterable[Row]:
    low, high, swing = _over_cylinder(1120, -780, -620)
    yield Row(
        "its cylinder, 1120 wide, z −780 to −620: height", 260, -620 - -780, 0.5, " mm",
        "theirs is a slip: −620 less −780 is 160",
    )  # fmt: skip
    yield Row("least angle over it", -51.06, low, 0.005, "°")
    yield Row("greatest angle over it", 85.94, high, 0.005, "°")
    yield Row("forearms' swing sideways", 38.5, swing, 0.05, "°")
    low, high, _ = _over_cylinder(1010, -906, -646)
    yield Row("1010 wide, z −906 to −646: least angle", -44.9, low, 0.05, "°")
    yield Row("greatest angle", 89.93, high, 0.005, "°")


def tables() -> str:
    return table(cylinder_rows())


def _over_cylinder(diameter: float, bottom: float, top: float) -> tuple[float, float, float]:
    """(least, greatest angle, greatest lean of a forearm) in degrees, on its whole surface."""
    turn = np.radians(np.arange(0, 360, 0.25))
    rim = diameter / 2 * np.stack((np.cos(turn), np.sin(turn)), axis=-1)
    rings = [(rim, z) for z in np.linspace(bottom, top, 41)]
    rings += [(rim * share, z) for share in np.linspace(0, 1, 41) for z in (bottom, top)]
    points = np.concatenate([np.column_stack((ring, np.full(len(ring), z))) for ring, z in rings])
    theta = np.degrees(ROBOT.inverse(points))
    lean = np.degrees(np.arcsin(np.abs(ROBOT.sideways(points)).max() / ROBOT.forearm[0]))
    return float(theta.min()), float(theta.max()), float(lean)
