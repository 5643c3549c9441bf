"""The tutorial of 2009, and FireStep's tests, which are of the same family."""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Iterable
from pathlib import Path

import numpy as np

from deltaviz import load_robot
from deltaviz.mechanism import RotaryDelta
from source_tables import mistakes
from source_tables.comparison import Row, agreement, table

FIRESTEP_ZERO = 247.893  # mm below the base: where its coordinates begin


def rows() -> list[Row]:
    robot = load_robot("trossen").mechanism
    missed, _, _ = mistakes.rounded_tan30()
    return [
        Row("z of forward(0°, 0°, 0°)", -96.859015171, robot.forward([0, 0, 0])[2], 9, " mm"),
        Row(
            "of all angles in [−45°, 90°]³: an elbow inside",
            2.2, 100 * mistakes.share_inside(), 1, " %",
        ),
        Row(
            "what a rounded tan 30° misses, median", 5e-2, 1e3 * missed, 2, " µm",
            "depends on which poses are drawn: these are even in the angles",
        ),
    ]  # fmt: skip


def in_c() -> str:
    """Builds C code in the tutorial's style (benchmarks/tutorial.c), with the exact tan 30°."""
    sys.path.insert(0, str(Path(__file__).parents[2]))
    from benchmarks.kinematics import Tutorial

    robot = mistakes.tutorial()
    theta = mistakes.drawn()
    xyz = robot.forward(theta)
    clear = (robot.jq(xyz, theta) > 1e3).all(axis=-1)
    xyz, theta = np.ascontiguousarray(xyz[clear]), theta[clear]
    with tempfile.TemporaryDirectory() as folder:
        code = Tutorial(Path(folder))
        forward = np.abs(code.forward(np.degrees(theta)) - xyz).max()
        inverse = np.abs(code.inverse(xyz) - np.degrees(robot.inverse(xyz))).max()
    return agreement(
        [
            (f"forward of {len(xyz)} poses, in C and ours", forward, 1e-9, " mm"),
            ("inverse of them", inverse, 1e-9, "°"),
        ]
    )


def firestep_rows() -> Iterable[Row]:
    robot = RotaryDelta.from_sides(f=190.526, e=131.636, upper_arm=90, forearm=270)
    zero, one = robot.forward(np.radians([[0, 0, 0], [1, 1, 1]]))[:, 2]
    yield Row("z of forward(0°, 0°, 0°)", -247.893088, zero, 6, " mm")
    yield Row("forward(1°, 1°, 1°), below it", -1.57663, one - zero, 5, " mm")
    cases = {
        (0, 0, 65): (-64.651190,) * 3,
        (0, 0, -10): (6.232677,) * 3,
        (1, 2, 3): (-1.360184, -2.438102, -1.955057),
    }
    for point, theirs in cases.items():
        ours = np.degrees(robot.inverse(np.array(point) - [0, 0, FIRESTEP_ZERO]))
        for arm in range(3 if len(set(theirs)) > 1 else 1):
            which = f", θ{arm + 1}" if len(set(theirs)) > 1 else ", all three"
            yield Row(f"inverse{point}{which}", theirs[arm], ours[arm], 6, "°")


def tables() -> str:
    return f"{table(rows())}\n\n{in_c()}"


def firestep() -> str:
    return table(firestep_rows())
