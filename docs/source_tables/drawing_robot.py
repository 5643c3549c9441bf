"""The drawing robot: its test code's poses, and the sheet that it draws on."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from deltaviz import load_robot
from deltaviz.mechanism import RotaryDelta
from source_tables.comparison import Row, table

INCH = 25.4
LETTER = 8.5 * INCH, 11 * INCH
ORIGIN = 0.51  # in below our origin; its z points down, and its y against ours


def rows() -> Iterable[Row]:
    robot = load_robot("deltadraw").mechanism
    cases = {(0, 0, 11): (35.390478,) * 3, (3, 4, 10): (17.849216, 74.970084, 26.684261)}
    for (x, y, z), theirs in cases.items():
        ours = np.degrees(robot.inverse(np.array([x, -y, -(z + ORIGIN)]) * INCH))
        for arm, (a, b) in enumerate(zip(theirs, ours, strict=True)):
            halfway = abs(abs(b - a) - 5e-7) < 1e-7
            why = f"{b:.7f}° is half way between two last digits" if halfway else ""
            yield Row(f"inverse({x}, {y}, {z}) in, θ{arm + 1}", a, b, 6, "°", why)


def tables() -> str:
    return table(rows())


def paper() -> str:
    """The sheet at the height at which most of it is reached, with its own upper arm and longer
    ones."""
    lines = [
        "| upper arm | sheet at z | of it reached | mm per servo step: worst | median | "
        "the pen's way in z over its middle |",
        "| ---: | ---: | ---: | ---: | ---: | ---: |",
    ]
    lines += [_on_paper(factor) for factor in (0.75, 1.0, 1.5, 2.0)]
    return "\n".join(lines)


def _on_paper(factor: float) -> str:
    robot = load_robot("deltadraw")
    old = robot.mechanism
    assert isinstance(old, RotaryDelta)
    robot = replace(
        robot,
        mechanism=RotaryDelta(
            base_radius=old.base_radius,
            effector_radius=old.effector_radius,
            upper_arm=factor * old.upper_arm[0],
            forearm=old.forearm,
        ),
    )
    workspace = robot.workspace()
    sheet = np.stack(np.meshgrid(*(_side(length) for length in LETTER)), axis=-1)
    heights = np.arange(-400.0, -120.0, 2.0)
    share = [(workspace.margins.least(_lifted(sheet, z)) >= 0).mean() for z in heights]
    most = float(np.max(share))
    z = float(np.median(heights[np.array(share) == most]))
    points = _lifted(sheet, z)
    points = points[workspace.margins.least(points) >= 0]
    step = workspace.quality(points).resolution
    column = np.arange(-500.0, -50.0, 0.5)
    middle = column[workspace.margins.least(_lifted(np.zeros((len(column), 2)), column)) >= 0]
    return (
        f"| {factor * old.upper_arm[0]:.1f} mm | −{-z:.0f} mm | {most:.0%} | {step.max():.3f} | "
        f"{np.median(step):.3f} | {middle.max() - middle.min():.0f} mm |"
    )


def _side(length: float) -> np.ndarray:
    return np.linspace(-length / 2, length / 2, round(length / 4))


def _lifted(across: np.ndarray, z: float | np.ndarray) -> np.ndarray:
    return np.concatenate(
        (across, np.broadcast_to(z, across.shape[:-1])[..., None]), axis=-1, dtype=np.float64
    )
