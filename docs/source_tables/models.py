"""What simpler models of rods cost, and what a calibration can tell apart."""

from __future__ import annotations

import numpy as np

from deltaviz import load_robot
from deltaviz.mechanism import RotaryDelta
from deltaviz.mechanism.dynamics import RodModel, forward_motion, torques
from source_tables.comparison import Row, table

MOTIONS, POSES = 2000, 400
SPEED, ACCELERATION = 3.0, 40.0  # rad/s, rad/s²: the largest drawn
DEPENDENT = 1e-9  # of the largest singular value: what is smaller is rounding


def rods() -> str:
    robot = load_robot("zheng2023")
    assert robot.masses is not None
    rng = np.random.default_rng(0)
    theta = rng.uniform(robot.joints.min, robot.joints.max, (MOTIONS, 3))
    motion = forward_motion(
        robot.mechanism,  # type: ignore[arg-type]
        theta,
        rng.uniform(-SPEED, SPEED, (MOTIONS, 3)),
        rng.uniform(-ACCELERATION, ACCELERATION, (MOTIONS, 3)),
    )
    exact, *lumped = (
        torques(robot.mechanism, robot.masses, motion, rods=model)  # type: ignore[arg-type]
        for model in (RodModel.UNIFORM, RodModel.TWO_THIRDS, RodModel.HALVES)
    )
    off = [100 * np.sqrt(((tau - exact) ** 2).mean() / (exact**2).mean()) for tau in lumped]
    why = "depends on the masses and the motions, which here are the preset's and random"
    return table(
        [
            Row(
                "⅔ at the elbow, ⅓ at the effector: RMS of the torques off",
                7,
                off[0],
                0.5,
                " %",
                why,
            ),
            Row("½ and ½", 16, off[1], 0.5, " %", why),
        ]
    )


def calibration() -> str:
    robot = load_robot("stm32").mechanism
    assert isinstance(robot, RotaryDelta)
    own, radii, frame = _columns(robot)
    together = np.concatenate((own, radii), axis=1), np.concatenate((own, frame), axis=1)
    return table(
        [
            Row("parameters that can be told apart, of 24", 24, _rank(own), 0.5),
            Row("with each arm's R and r besides, of 30", 24, _rank(together[0]), 0.5),
            Row("with a free measuring frame besides, of 30", 24, _rank(together[1]), 0.5),
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
