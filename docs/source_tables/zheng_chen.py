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
WIDE, BOTTOM, TOP = 1120.0, -780.0, -620.0  # mm: its cylinder
X_DRAWN, Y_DRAWN, Z_DRAWN = (-680, 680), (-680, 680), (-1230, -410)  # mm, in its figures
VIEWS = {
    "in space": (0, 1, 2),
    "XOZ, from the front": (0, 2),
    "YOZ, from the side": (1, 2),
    "XOY, from above": (0, 1),
}
ROBOT = RotaryDelta(base_radius=260, effector_radius=50, upper_arm=360, forearm=900)


def cylinder_rows() -> Iterable[Row]:
    low, high, swing = _over_cylinder(WIDE, BOTTOM, TOP)
    yield Row(
        "its cylinder, 1120 wide, z −780 to −620: height", 260, TOP - BOTTOM, 0, " mm",
        "theirs is a slip: −620 less −780 is 160",
    )  # fmt: skip
    yield Row("least angle over it", -51.06, low, 2, "°")
    yield Row("greatest angle over it", 85.94, high, 2, "°")
    yield Row("forearms' swing sideways", 38.5, swing, 1, "°")
    low, high, _ = _over_cylinder(1010, -906, -646)
    yield Row("1010 wide, z −906 to −646: least angle", -44.9, low, 1, "°")
    yield Row("greatest angle", 89.93, high, 2, "°")


def tables() -> str:
    return "\n\n".join(table(rows) for rows in (extent_rows(), cylinder_rows(), largest_rows()))


def extent_rows() -> Iterable[Row]:
    """What its figures 4 to 8 plot: all that the links and joints from -47° to 88° reach."""
    box = published().extents
    (x0, y0, z0), (x1, y1, z1) = box.low.tolist(), box.high.tolist()
    arms = "arms 120° apart cannot reach equally far to both sides in x"
    read = "theirs is told to 10 mm"
    yield Row("x from", X_DRAWN[0], x0, 0, " mm", arms)
    yield Row("x to", X_DRAWN[1], x1, 0, " mm", arms)
    yield Row("y from", Y_DRAWN[0], y0, 0, " mm", read)
    yield Row("y to", Y_DRAWN[1], y1, 0, " mm", read)
    yield Row("z from", Z_DRAWN[0], z0, 0, " mm", read)
    yield Row("z to", Z_DRAWN[1], z1, 0, " mm", read)


def views() -> str:
    """The picture's panels, each with the extents of the same view in the paper and ours."""
    box = published().extents
    drawn = (X_DRAWN, Y_DRAWN, Z_DRAWN)
    lines = ["| panel | in the paper | ours |", "| --- | --- | --- |"]
    for title, axes in VIEWS.items():
        theirs = ", ".join(_range(axis, *drawn[axis]) for axis in axes)
        ours = ", ".join(_range(axis, box.low[axis], box.high[axis]) for axis in axes)
        lines.append(f"| {title} | {theirs} mm | {ours} mm |")
    return "\n".join(lines)


def _range(axis: int, low: float, high: float) -> str:
    return f"{'xyz'[axis]} {low:.0f} to {high:.0f}".replace("-", "−")


def largest_rows() -> Iterable[Row]:
    within = _workspace(-45, 90)
    found = within.largest_cylinder(height=260)
    assert found is not None
    assert isinstance(found.shape, Cylinder)
    yield Row(
        "the widest cylinder 260 mm high, joints from −45° to 90°", 1010, found.shape.diameter, 0,
        " mm", f"theirs is told to 10 mm; proved: none above {found.most:.0f} mm",
    )  # fmt: skip
    yield Row("where it stands: z", -906, found.shape.floor, 0, " mm")
    theirs = _workspace(-51.06, 85.94).serve(Belt(BELT, 160, -780))
    chord = 2 * math.sqrt((WIDE / 2) ** 2 - (BELT / 2) ** 2)
    yield Row(
        f"a conveyor {BELT:g} mm wide through their cylinder: its chord, which we computed from "
        "their diameter; the stretch that is served", chord,
        theirs.length, 0, " mm", "a belt need not be round, so more of it is served than the chord",
    )  # fmt: skip


def published() -> Workspace:
    """Of the machine with the joints that the paper's figures are drawn with. Its zone is the
    paper's cylinder, which needs other joints."""
    return _workspace(-47, 88)


def _workspace(low_deg: float, high_deg: float) -> Workspace:
    robot = load_robot("zheng2023")
    joints = replace(
        robot.joints, min=(math.radians(low_deg),) * 3, max=(math.radians(high_deg),) * 3
    )
    zone = replace(robot.zone, z=(BOTTOM, TOP), radius=WIDE / 2)
    name = f"{robot.name} with joints {low_deg:g}° to {high_deg:g}°"
    return replace(robot, name=name, joints=joints, zone=zone).workspace(Limit.REACH | Limit.JOINTS)


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
