"""The drawing robot: its test code's poses."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from deltaviz import load_robot
from source_tables.comparison import Row, table

INCH = 25.4
ORIGIN = 0.51  # in below our origin; its z points down, and its y against ours


def rows() -> Iterable[Row]:
    robot = load_robot("deltadraw").mechanism
    cases = {(0, 0, 11): (35.390478,) * 3, (3, 4, 10): (17.849216, 74.970084, 26.684261)}
    for (x, y, z), theirs in cases.items():
        ours = np.degrees(robot.inverse(np.array([x, -y, -(z + ORIGIN)]) * INCH))
        for arm, (a, b) in enumerate(zip(theirs, ours, strict=True)):
            yield Row(f"inverse({x}, {y}, {z}) in, θ{arm + 1}", a, b, 5e-7, "°")


def tables() -> str:
    return table(rows())
