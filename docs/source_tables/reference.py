"""All mechanisms against poses solved at 50 digits, and what a design promises in closed form."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from deltaviz import load_robot
from deltaviz.mechanism import FiveBar, RotaryDelta
from source_tables.comparison import Row, agreement, table

REFERENCE = Path(__file__).parents[2] / "tests" / "data" / "reference"
RATIOS = {"trossen": 0.909, "zheng2023": 0.633, "stm32": 0.488}


def tables() -> str:
    return agreement([*_deltas(), *_five_bars()])


def _deltas() -> Iterator[tuple[str, float, float, str]]:
    for path in sorted(REFERENCE.glob("*.json")):
        data = json.loads(path.read_text())
        robot = RotaryDelta(**data["geometry"])
        xyz, theta = _columns(data["ik"], "xyz")
        reached, given = _columns(data["fk"], "xyz")
        yield f"{path.stem}: inverse", np.abs(robot.inverse(xyz) - theta).max(), 1.5e-13, " rad"
        yield f"{path.stem}: forward", np.abs(robot.forward(given) - reached).max(), 8e-13, " mm"


def _five_bars() -> Iterator[tuple[str, float, float, str]]:
    for path in sorted((REFERENCE / "five_bar").glob("*.json")):
        data = json.loads(path.read_text())
        robot = FiveBar(**data["geometry"])
        xz, theta = _columns(data["ik"], "xy")
        theirs = np.radians([case["doc_thetaL_R_deg"] for case in data["ik"]])
        name = path.stem.removeprefix("fivebar_")
        yield f"five-bar, {name}: inverse", np.abs(robot.inverse(xz) - theta).max(), 1e-12, " rad"
        yield f"five-bar, {name}: forward", np.abs(robot.forward(theta) - xz).max(), 1e-11, " mm"
        apart = np.abs(np.pi - robot.inverse(xz) - theirs).max()
        yield f"five-bar, {name}: its θL, θR are 180° − ours", apart, 1e-12, " rad"


def _columns(cases: list[dict[str, list[float]]], place: str) -> tuple[np.ndarray, np.ndarray]:
    places = np.array([case[place] for case in cases])
    return places, np.radians([case["theta_deg"] for case in cases])


def certificates() -> str:
    """(s + L)/l, and the best conditioning on the axis: closed form, and singular values."""
    rows: list[Row] = []
    for name, ratio in RATIOS.items():
        robot = load_robot(name).mechanism
        assert isinstance(robot, RotaryDelta)
        s = robot.base_radius[0] - robot.effector_radius[0]
        ours = (s + robot.upper_arm[0]) / robot.forearm[0]
        rows.append(Row(f"{name}: (s + L)/l", ratio, ours, 3))
        formula = max(1.0, np.sqrt(2) / np.tan(np.arcsin(ours)))
        rows.append(Row(f"{name}: best conditioning on the axis", formula, _best_on_axis(robot), 3))
    return table(rows)


def _best_on_axis(robot: RotaryDelta) -> float:
    angle = np.radians(np.arange(-89.0, 90.0, 0.01))
    theta = np.stack((angle,) * 3, axis=-1)
    theta = theta[np.isfinite(robot.forward(theta)).all(axis=-1)]
    sigma = np.linalg.svd(robot.jacobian(theta), compute_uv=False)
    return float((sigma[:, 0] / sigma[:, -1]).min())
