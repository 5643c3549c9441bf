"""Zheng and Chen's machine: its extents, its cylinder, and ours."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from deltaviz import load_robot
from deltaviz.mechanism import RotaryDelta
from deltaviz.robots.workspace import Belt, Cylinder, Limit, Workspace
from source_tables.comparison import Row, table

BELT = 800.0  # mm wide
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
    return "\n\n".join(table(rows) for rows in (extent_rows(), cylinder_rows(), largest_rows()))


def extent_rows() -> Iterable[Row]:
    """What its figures 4 to 8 plot: all that the links and joints from -47° to 88° reach."""
    box = _reached(-47, 88).extents
    (x0, y0, z0), (x1, y1, z1) = box.low.tolist(), box.high.tolist()
    arms = "arms 120° apart cannot reach equally far to both sides in x"
    yield Row("x from", -680, x0, 0.5, " mm", arms)
    yield Row("x to", 680, x1, 0.5, " mm", arms)
    yield Row("y from", -680, y0, 0.5, " mm")
    yield Row("y to", 680, y1, 0.5, " mm")
    yield Row("z from", -1230, z0, 5, " mm")
    yield Row("z to", -410, z1, 5, " mm")


def largest_rows() -> Iterable[Row]:
    within = _reached(-45, 90)
    found = within.largest_cylinder(height=260)
    assert found is not None
    assert isinstance(found.shape, Cylinder)
    yield Row(
        "the widest cylinder 260 mm high, joints from −45° to 90°", 1010, found.shape.diameter, 5,
        " mm", f"proved: none above {found.most:.0f} mm",
    )  # fmt: skip
    yield Row("where it stands: z", -906, found.shape.floor, 0.5, " mm")
    theirs = _reached(-51.06, 85.94).serve(Belt(BELT, 160, -780))
    chord = 2 * math.sqrt(560**2 - (BELT / 2) ** 2)
    yield Row(
        f"a conveyor {BELT:g} mm wide through their cylinder: stretch that is served", chord,
        theirs.length, 0.5, " mm", "theirs is the cylinder's chord; a belt need not be round",
    )  # fmt: skip


def _reached(low_deg: float, high_deg: float) -> Workspace:
    robot = load_robot("zheng2023")
    joints = replace(
        robot.joints, min=(math.radians(low_deg),) * 3, max=(math.radians(high_deg),) * 3
    )
    return replace(robot, joints=joints).workspace(Limit.REACH | Limit.JOINTS)


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
