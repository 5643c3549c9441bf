"""The reported side of a snapshot: what the board's counts say about pose, speed and limits."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from deltaviz.link.session import Session
from deltaviz.robots import Robot

WINDOW = 0.050  # s of board time over which a speed is taken; counts are coarse
OPEN = 20.0  # units of margin (about mm) from which a joint is in the open


def finite(values: Sequence[float]) -> tuple[float, ...] | None:
    """The values, or None if one is not known."""
    numbers = tuple(float(value) for value in values)
    return numbers if all(map(math.isfinite, numbers)) else None


def tip(robot: Robot, theta: Sequence[float]) -> tuple[float, ...] | None:
    """The tool tip (mm) at `theta` (rad), or None where there is none."""
    pose = robot.kernel.forward(np.array([theta], dtype=np.float64))[0]
    return finite(pose[: len(robot.axes)].tolist())


def joint_margins(
    robot: Robot, theta: Sequence[float], xyz: Sequence[float] | None
) -> tuple[float, ...]:
    """How far each joint is from its nearest limit: 1 in the open, 0 at it."""
    nearest = [OPEN] * robot.joint_count
    if xyz is None:
        return tuple(0.0 for _ in nearest)
    pose = robot.pose(xyz, theta[-1])[None, :]
    angles = np.array([theta], dtype=np.float64)
    margins = robot.kernel.margins(pose, angles)[0].tolist()
    for limit, margin in zip(robot.margin_names, margins, strict=True):
        if limit.arm is not None:
            nearest[limit.arm] = min(nearest[limit.arm], margin)
    return tuple(max(0.0, value / OPEN) for value in nearest)


@dataclass(frozen=True, slots=True)
class Reported:
    """The robot by the board's counts; None where unknown."""

    theta: tuple[float, ...] | None
    xyz: tuple[float, ...] | None
    theta_speed: tuple[float, ...] | None
    xyz_speed: tuple[float, ...] | None
    margins: tuple[float, ...]


def reported(robot: Robot, session: Session | None, speeds: Speedometer) -> Reported:
    theta = session.theta if session is not None and session.homed else None
    if theta is None:
        return Reported(None, None, None, None, tuple(0.0 for _ in robot.homing.ready))
    xyz = tip(robot, theta)
    return Reported(
        theta=theta,
        xyz=xyz,
        theta_speed=speeds.joints(),
        xyz_speed=None if xyz is None else speeds.tip(xyz),
        margins=joint_margins(robot, theta, xyz),
    )


class Speedometer:
    """Joint and tip speed from reported poses."""

    def __init__(self, robot: Robot) -> None:
        self._robot = robot
        self._seen: deque[tuple[float, tuple[float, ...]]] = deque()

    def report(self, board_time: float, theta: tuple[float, ...]) -> None:
        seen = self._seen
        if seen and board_time <= seen[-1][0]:
            return
        seen.append((board_time, theta))
        while len(seen) > 2 and seen[1][0] <= board_time - WINDOW:
            seen.popleft()

    def joints(self) -> tuple[float, ...] | None:
        """rad/s, or None before two reports."""
        if len(self._seen) < 2:
            return None
        (t0, first), (t1, last) = self._seen[0], self._seen[-1]
        return tuple((b - a) / (t1 - t0) for a, b in zip(first, last, strict=True))

    def tip(self, xyz: Sequence[float]) -> tuple[float, ...] | None:
        """mm/s at the tip position `xyz`."""
        rates = self.joints()
        if rates is None:
            return None
        robot, theta = self._robot, self._seen[-1][1]
        velocity = robot.kernel.tip_velocity(
            robot.pose(xyz, theta[-1])[None, :],
            np.array([theta], dtype=np.float64),
            np.array([rates], dtype=np.float64),
        )
        return finite(velocity[0][: len(robot.axes)].tolist())
