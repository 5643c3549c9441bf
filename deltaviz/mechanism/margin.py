"""Names of the margins: how far a pose is from each thing that could forbid it."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum


class MarginKind(Enum):
    TYPE_1 = "type 1 singularity"  # an arm straight or folded: the edge of reach
    TYPE_2 = "type 2 singularity"  # the forearms can no longer hold the effector's position
    PARALLELOGRAM = "parallelogram singularity"  # they can no longer hold its orientation
    BALL_JOINT = "ball joint"
    JOINT_MIN = "lower joint limit"
    JOINT_MAX = "upper joint limit"
    COLLISION = "collision of the robot's own parts"  # of the workspace's analysis alone
    Z_MIN = "lower end of the workspace"
    Z_MAX = "upper end of the workspace"
    RADIUS = "radius of the workspace"
    X_MIN = "lower X end of the workspace"
    X_MAX = "upper X end of the workspace"
    Y_MIN = "lower Y end of the workspace"
    Y_MAX = "upper Y end of the workspace"
    TOOL_MIN = "lower limit of the tool's turn"
    TOOL_MAX = "upper limit of the tool's turn"


@dataclass(frozen=True, slots=True)
class Margin:
    """What one column of `margins` tells. `arm` is the joint, 0-based, or None where no single one
    is meant.

    The numbers are signed, at least 0 where legal, smooth near 0, and fall by about 1 per mm
    of travel there.
    """

    kind: MarginKind
    arm: int | None = None

    def __str__(self) -> str:
        if self.arm is None or self.kind in (MarginKind.TOOL_MIN, MarginKind.TOOL_MAX):
            return self.kind.value
        return f"arm {self.arm + 1} {self.kind.value}"
