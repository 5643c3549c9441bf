"""Where a robot's tool tip may be, worked out again from its numbers by elementary triangles.

Shares nothing with deltaviz but the robot's own numbers.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np


@dataclass(frozen=True)
class Arm:
    """Of one arm at tool tips (n, d): (n,) each, NaN where it does not reach.

    `elbow` (n, 3) is moved inward by the effector's radius; `lean` is how far the forearm stands
    out of the arm's plane.
    """

    theta: np.ndarray
    lean: np.ndarray
    elbow: np.ndarray


def in_space(robot: Any, points: np.ndarray) -> np.ndarray:
    """The effector's centre in three coordinates."""
    centre = np.atleast_2d(points) - np.array(robot.tool_offset)
    if centre.shape[1] == 3:
        return centre
    return np.stack((centre[:, 0], 0 * centre[:, 0], centre[:, 1]), axis=-1)


def arms(robot: Any, points: np.ndarray) -> list[Arm]:
    mechanism, centre, out = robot.mechanism, in_space(robot, points), []
    planar = len(robot.tool_offset) == 2
    azimuths = (180.0, 0.0) if planar else mechanism.azimuths_deg
    base = mechanism.base_half if planar else mechanism.base_radius
    effector = mechanism.platform_half if planar else mechanism.effector_radius
    for i, azimuth in enumerate(np.radians(azimuths)):
        outward = np.array((np.cos(azimuth), np.sin(azimuth), 0.0))
        sideways = np.array((-np.sin(azimuth), np.cos(azimuth), 0.0))
        upper, fore = mechanism.upper_arm[i], mechanism.forearm[i]
        along = centre @ outward - (base[i] - effector[i])
        aside, z = centre @ sideways, centre[:, 2]
        with np.errstate(invalid="ignore"):
            shadow = np.sqrt(fore**2 - aside**2)  # of the forearm in the arm's plane
            distance = np.hypot(along, z)
            opening = np.arccos((upper**2 + distance**2 - shadow**2) / (2 * upper * distance))
            lean = np.arcsin(aside / fore)
        theta = np.arctan2(-z, along) - opening
        elbow = (base[i] - effector[i] + upper * np.cos(theta))[:, None] * outward
        elbow = elbow - np.stack((0 * theta, 0 * theta, upper * np.sin(theta)), axis=-1)
        out.append(Arm(theta, lean, elbow))
    return out


def reached(robot: Any, points: np.ndarray, *, joints: bool = True, lean: bool = True) -> Any:
    """(n,) whether the arms reach points below their elbows, within the joints' limits and with
    ball joints leaning no farther than they may."""
    found, centre = arms(robot, points), in_space(robot, points)
    legal = np.all([np.isfinite(arm.theta) for arm in found], axis=0)
    forearms = np.stack([centre - arm.elbow for arm in found], axis=1)
    if len(found) == 3:
        legal &= np.linalg.det(np.where(legal[:, None, None], forearms, 0.0)) < 0
    else:
        left, right = forearms[:, 0], forearms[:, 1]
        legal &= left[:, 0] * right[:, 2] - left[:, 2] * right[:, 0] < 0
    for i, arm in enumerate(found):
        low, high = robot.joints.min[i], robot.joints.max[i]
        turned = (arm.theta - low) % (2 * np.pi)
        if joints:
            legal &= turned <= high - low
        if lean and robot.joints.ball_joint_max is not None:
            legal &= np.abs(arm.lean) <= robot.joints.ball_joint_max
    return legal


def crossing(inside: np.ndarray, outside: np.ndarray, legal: Any) -> np.ndarray:
    """Points (n, d) between inner and outer ones where `legal` changes, by halving."""
    inner, outer = inside.copy(), outside.copy()
    for _ in range(45):
        middle = (inner + outer) / 2
        good = legal(middle)[:, None]
        inner, outer = np.where(good, middle, inner), np.where(good, outer, middle)
    return inner
