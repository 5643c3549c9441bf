"""Whether a robot may be at a point, and if not, which arm, which limit, and by how much."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from deltaviz.mechanism.arrays import Array, rows
from deltaviz.mechanism.margin import Margin, MarginKind

if TYPE_CHECKING:
    from deltaviz.robots.robot import Robot


@dataclass(frozen=True, slots=True)
class Reason:
    """One limit that a point breaks. `excess` is by how much, in `unit`: "mm", "deg", or "" for
    a singularity, where it is the margin's own (about mm). `str` is a sentence."""

    limit: Margin
    excess: float
    unit: str
    text: str

    @property
    def arm(self) -> int | None:
        return self.limit.arm

    def __str__(self) -> str:
        return self.text


@dataclass(frozen=True, slots=True)
class Reach:
    """`theta` (rad) where the geometry reaches, legal or not; else None. `str` says why."""

    legal: bool
    reasons: tuple[Reason, ...]
    theta: tuple[float, ...] | None

    def __str__(self) -> str:
        if self.legal:
            return "Within reach and all limits."
        return " ".join(str(reason) for reason in self.reasons)


def reach(robot: Robot, xyz: ArrayLike) -> Reach:
    """Raises ValueError unless `xyz` is one finite point."""
    tip = rows(xyz, len(robot.tool_offset), "xyz")
    if tip.ndim != 1:
        raise ValueError(f"xyz has shape {tip.shape}; reach takes one point")
    if not np.isfinite(tip).all():
        raise ValueError(f"xyz = {tip.tolist()}: must be finite")
    theta = robot.inverse(tip)
    solved = bool(np.isfinite(theta).all())
    reasons = [] if solved else _out_of_reach(robot, tip)
    margins = robot.margins(tip, theta).tolist()
    for limit, margin in zip(robot.margin_names, margins, strict=True):
        if margin < 0 and (solved or limit.kind in _OF_POSITION):
            reasons.append(_reason(robot, limit, -margin, tip, theta))
    return Reach(
        legal=not reasons,
        reasons=tuple(reasons),
        theta=tuple(theta.tolist()) if solved else None,
    )


def _out_of_reach(robot: Robot, tip: Array) -> list[Reason]:
    far, near = robot.mechanism.misses(tip - np.asarray(robot.tool_offset))
    reasons: list[Reason] = []
    for arm, (too_far, too_near) in enumerate(zip(far.tolist(), near.tolist(), strict=True)):
        excess = max(too_far, too_near)
        if excess > 0:
            where = "too far away from" if too_far > too_near else "too close to"
            text = f"Arm {arm + 1} cannot reach it: {_length(excess)} {where} its motor."
            reasons.append(Reason(Margin(MarginKind.TYPE_1, arm), excess, "mm", text))
    return reasons


def _reason(robot: Robot, limit: Margin, excess: float, tip: Array, theta: Array) -> Reason:
    kind = limit.kind
    if kind in (MarginKind.JOINT_MIN, MarginKind.JOINT_MAX):
        return _joint(robot, limit, theta)
    if kind is MarginKind.BALL_JOINT:
        return _ball_joint(robot, limit, tip)
    if kind in _OF_POSITION:
        return _workspace(robot, limit, tip)
    return Reason(limit, excess, "", _singularity(robot, limit, tip))


def _joint(robot: Robot, limit: Margin, theta: Array) -> Reason:
    arm = limit.arm or 0
    angle = math.degrees(theta[arm])
    if limit.kind is MarginKind.JOINT_MIN:
        bound, side = math.degrees(robot.joints.min[arm]), "lower"
    else:
        bound, side = math.degrees(robot.joints.max[arm]), "upper"
    excess = abs(angle - bound)
    text = (
        f"Arm {arm + 1} would stand at {angle:.2f}°, "
        f"{_angle(excess)} beyond its {side} limit of {bound:g}°."
    )
    return Reason(limit, excess, "deg", text)


def _ball_joint(robot: Robot, limit: Margin, tip: Array) -> Reason:
    arm = limit.arm or 0
    sideways = robot.mechanism.sideways(tip - np.asarray(robot.tool_offset))[arm]
    sine = min(1.0, abs(float(sideways)) / robot.mechanism.forearm[arm])
    angle = math.degrees(math.asin(sine))
    bound = math.degrees(robot.joints.ball_joint_max or math.pi / 2)
    text = (
        f"The ball joints of arm {arm + 1} would stand at {angle:.2f}°, "
        f"{_angle(angle - bound)} beyond their limit of {bound:g}°."
    )
    return Reason(limit, angle - bound, "deg", text)


def _workspace(robot: Robot, limit: Margin, tip: Array) -> Reason:
    space = robot.zone
    if limit.kind is MarginKind.RADIUS and space.radius is not None:
        excess = float(np.linalg.norm(tip[:-1])) - space.radius
        text = f"It is {_length(excess)} outside the workspace's radius of {space.radius:g} mm."
        return Reason(limit, excess, "mm", text)
    name = limit.kind.name[0]  # of the axis
    box = {"X": space.x, "Y": space.y, "Z": space.z}[name]
    value = float(tip[robot.axes.index(name)])
    low, high = box or (-math.inf, math.inf)
    excess = float(max(low - value, value - high))
    side = "below" if value < low else "above"
    text = (
        f"{name} {value:.6g} mm is {_length(excess)} {side} the workspace ({low:g} to {high:g} mm)."
    )
    return Reason(limit, excess, "mm", text)


def _singularity(robot: Robot, limit: Margin, tip: Array) -> str:
    if limit.kind is MarginKind.TYPE_2:
        return "The forearms would be too flat, or too parallel, to hold the effector."
    if limit.kind is MarginKind.PARALLELOGRAM:
        return "The parallelograms would no longer hold the effector level."
    far, near = robot.mechanism.misses(tip - np.asarray(robot.tool_offset))
    arm = limit.arm or 0
    shape, left = ("straight", -far[arm]) if far[arm] > near[arm] else ("folded", -near[arm])
    return f"Arm {arm + 1} would be nearly {shape}, {_length(left)} from the edge of its reach."


def _length(value: float) -> str:
    return f"{value:.2f} mm" if value >= 0.01 else f"{value:.2g} mm"


def _angle(value: float) -> str:
    return f"{value:.2f}°" if value >= 0.01 else f"{value:.2g}°"


_OF_POSITION = {
    MarginKind.BALL_JOINT,
    MarginKind.Z_MIN,
    MarginKind.Z_MAX,
    MarginKind.RADIUS,
    MarginKind.X_MIN,
    MarginKind.X_MAX,
    MarginKind.Y_MIN,
    MarginKind.Y_MAX,
}
