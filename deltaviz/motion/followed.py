"""What the motion layer works on: a robot, its compiled kernel, and arrays of poses.

Nothing here knows how many joints the robot has, or of what kind it is.
"""

from __future__ import annotations

from typing import TypeAlias

from deltaviz.mechanism.arrays import Array
from deltaviz.mechanism.kernel import Kernel
from deltaviz.mechanism.margin import Margin
from deltaviz.robots.robot import Robot

__all__ = ["Array", "Followed", "Kernel", "Margin"]

Followed: TypeAlias = Robot
