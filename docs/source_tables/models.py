"""What simpler models of rods cost, and what a calibration can tell apart."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from deltaviz import load_robot
from deltaviz.mechanism import RotaryDelta
from deltaviz.mechanism.dynamics import RodModel
from deltaviz.robots.lumped_rods import missed
from deltaviz.robots.torques import crossing
from deltaviz.robots.workspace.report import zone_way
from source_tables.comparison import Row, table

PRESETS = ("deltadraw", "fivebar", "stm32", "trossen", "zheng2023")
LUMPED = (RodModel.TWO_THIRDS, RodModel.HALVES)
QUICKER = 4
POSES = 400
DEPENDENT = 1e-9  # of the largest singular value: what is smaller is rounding


def rods() -> str:
    """For each preset, of the way through its zone: what two thirds at the elbow, and halves,
    miss."""
    lines = [
        "| | the way takes | as its limits allow | in a quarter of the time | the weight alone "
        "| the acceleration alone |",
        "| --- | ---: | ---: | ---: | ---: | ---: |",
    ]
    for name in PRESETS:
        robot = load_robot(name)
        start, end = zone_way(robot)
        duration = crossing(robot, start, end).duration
        usual, quick = (
            [missed(robot, start, end, rods=rods, duration=duration / by) for rods in LUMPED]
            for by in (1, QUICKER)
        )
        cells = (
            _both(m.share for m in usual),
            _both(m.share for m in quick),
            _both(m.weight for m in usual),
            _both(m.acceleration for m in usual),
        )
        lines.append(f"| {name} | {duration:.2f} s | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def _both(shares: Iterable[float]) -> str:
    return " / ".join(f"{100 * share:.1f}" for share in shares) + " %"


def calibration() -> str:
    robot = load_robot("stm32").mechanism
    assert isinstance(robot, RotaryDelta)
    own, radii, frame = _columns(robot)
    together = np.concatenate((own, radii), axis=1), np.concatenate((own, frame), axis=1)
    return table(
        [
            Row("parameters that can be told apart, of 24", 24, _rank(own), 0),
            Row("with each arm's R and r besides, of 30", 24, _rank(together[0]), 0),
            Row("with a free measuring frame besides, of 30", 24, _rank(together[1]), 0),
        ]
    )


def _columns(robot: RotaryDelta) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(3 poses, k) each: how P moves with the arms' own parameters (shoulder, L, l, θ0, two tilts),
    with R and r, and with the frame that it is measured in.

    From S_i · dP = S_i · dD_i + l dl, arm by arm.
    """
    theta = np.random.default_rng(0).uniform(-0.6, 1.4, (POSES, 3))
    elbows, place = robot.elbows(theta), robot.forward(theta)
    forearms = place[:, None] - elbows
    own: list[np.ndarray] = []
    radii: list[np.ndarray] = []
    for i, arm in enumerate(robot.arms):
        out, up = np.array([arm.cos, arm.sin, 0.0]), np.array([0.0, 0.0, 1.0])
        cos, sin = np.cos(theta[:, i, None]), np.sin(theta[:, i, None])
        along = out * cos - up * sin
        turned = arm.upper_arm * (-out * sin - up * cos)
        tilts = (np.cross(axis, arm.upper_arm * along) for axis in (out, up))
        moved = (*np.eye(3), along, turned, *tilts)
        sides = [(forearms[:, i] * change).sum(axis=-1) for change in moved]
        sides.append(np.full(POSES, arm.forearm))
        own += [_place_moves(forearms, i, side) for side in sides]
        outward = (forearms[:, i] * out).sum(axis=-1)
        radii += [_place_moves(forearms, i, sign * outward) for sign in (1, -1)]
    frame = [np.broadcast_to(axis, place.shape) for axis in np.eye(3)]
    frame += [np.cross(axis, place) for axis in np.eye(3)]
    return (
        np.stack(own, axis=-1),
        np.stack(radii, axis=-1),
        np.stack([f.ravel() for f in frame], axis=-1),
    )


def _place_moves(forearms: np.ndarray, arm: int, side: np.ndarray) -> np.ndarray:
    """Solved for dP, where one arm's right side is `side` and the others' are 0."""
    right = np.zeros((len(side), 3, 1))
    right[:, arm, 0] = side
    return np.linalg.solve(forearms, right)[..., 0].ravel()


def _rank(columns: np.ndarray) -> int:
    sigma = np.linalg.svd(columns / np.linalg.norm(columns, axis=0), compute_uv=False)
    return int((sigma > DEPENDENT * sigma[0]).sum())
