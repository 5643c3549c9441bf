"""What the robot is doing for somebody."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from deltaviz.motion.goal import Goal


class Kind(StrEnum):
    JOG = "jog"
    DRAG = "drag"
    FOLLOW = "follow"
    STEP = "step"
    MOVE = "move"


@dataclass(frozen=True, slots=True)
class Activity:
    """`held` while a press or grab keeps it alive: then it does not end by itself."""

    kind: Kind
    client: str
    goal: Goal
    held: bool = False
