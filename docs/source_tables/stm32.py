"""The STM32F407 library's scan and forward solution."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from deltaviz import load_robot
from deltaviz.mechanism import RotaryDelta
from deltaviz.mechanism.published import legs_of, newton
from deltaviz.robots.workspace import Limit
from source_tables.comparison import Row, agreement, table

CAP = 250.0  # mm from the axis: what the scan leaves out
HEIGHTS = {-460: 14.1, -440: 103.0, -400: 192.4, -360: 247.0, -100: 247.0}


def scan(robot: RotaryDelta) -> tuple[np.ndarray, np.ndarray]:
    """Its scan: (m, 3) mm and (m, 3) rad, the points of its grid that the links reach."""
    axis, height = np.arange(-250.0, 251.0, 20.0), np.arange(-460.0, -99.0, 20.0)
    points = np.stack(np.meshgrid(axis, axis, height, indexing="ij"), axis=-1).reshape(-1, 3)
    points = points[np.hypot(points[:, 0], points[:, 1]) <= CAP]
    theta = robot.inverse(points)
    reached = np.isfinite(theta).all(axis=-1)
    return points[reached], theta[reached]


def rows() -> Iterable[Row]:
    robot = _robot()
    xyz, theta = scan(robot)
    inside = ((theta >= np.radians(-45)) & (theta <= np.radians(90))).all(axis=-1)
    radius = np.hypot(xyz[:, 0], xyz[:, 1])
    yield Row("points of the grid within reach", 5928, len(xyz), 0)
    yield Row("of them with joints from −45° to 90°", 3786, int(inside.sum()), 0)
    for z, theirs in HEIGHTS.items():
        ours = radius[xyz[:, 2] == z].max()
        yield Row(f"largest radius of the grid at z = {z}", theirs, ours, 1, " mm")
    yield Row("least angle in the scan", -150, np.degrees(theta.min()), 0, "°")
    yield Row("greatest angle", 119, np.degrees(theta.max()), 0, "°")
    low, high = _centre(robot)
    yield Row("lowest place on the axis", -461.3, low, 1, " mm")
    yield Row("highest place on the axis", -209.2, high, 1, " mm")


def reach() -> str:
    """At each height: the scan's largest radius, and where reach ends by the boundary."""
    xyz, _ = scan(_robot())
    radius = np.hypot(xyz[:, 0], xyz[:, 1])
    heights = sorted({*HEIGHTS, -300, -200, -120}, reverse=True)
    robot = load_robot("stm32")
    links = robot.workspace(Limit.REACH).reach(heights)
    limited = robot.workspace().reach(heights)
    lines = [
        "| z | the scan's radius | farthest | all around | nearest | farthest, all limits "
        "| all around, all limits |",
        "| ---: | ---: | ---: | ---: | ---: | ---: | ---: |",
    ]
    for z, all_, own in zip(heights, links, limited, strict=True):
        of_scan = radius[xyz[:, 2] == z].max()
        cells = (of_scan, all_.farthest, all_.all_around, all_.nearest, own.farthest)
        shown = [_mm(cell) for cell in (*cells, own.all_around)]
        lines.append(f"| {z} | ".replace("-", "−") + " | ".join(shown) + " |")
    return "\n".join(lines)


def _mm(value: float | None) -> str:
    return "none" if value is None else f"{value:.0f}"


def tables() -> str:
    robot = _robot()
    xyz, theta = scan(robot)
    apart = np.abs(newton(legs_of(robot), theta) - robot.forward(theta)).max()
    newtons = ("Newton's method and the closed form, over the scan", apart, 1e-9, " mm")
    back = ("forward(inverse(p)) and p, over the scan", np.abs(robot.forward(theta) - xyz).max())
    return f"{table(rows())}\n\n{agreement([newtons, (*back, 1e-9, ' mm')])}"


def _centre(robot: RotaryDelta) -> tuple[float, float]:
    """Lowest and highest reached z on the axis, to 1e-6 mm."""
    ends = []
    for outside, inside in ((-600.0, -300.0), (-100.0, -300.0)):
        while abs(outside - inside) > 1e-6:
            middle = (outside + inside) / 2
            reached = bool(np.isfinite(robot.inverse([0, 0, middle])).all())
            outside, inside = (outside, middle) if reached else (middle, inside)
        ends.append(inside)
    return ends[0], ends[1]


def _robot() -> RotaryDelta:
    robot = load_robot("stm32").mechanism
    assert isinstance(robot, RotaryDelta)
    return robot
