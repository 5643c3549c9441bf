"""What may end a workspace."""

from __future__ import annotations

from enum import Flag, auto


class Limit(Flag):
    """Kinds of limit; a workspace is the set of points that keep those asked for.

    `REACH` always counts: the arms' lengths, and the assembly that the robot works in (below its
    elbows, before the forearms lie flat). `SINGULARITIES` are the reserves that the controller
    keeps from both kinds of singularity. `ZONE` is what the robot file allows the tool tip.
    """

    REACH = auto()
    JOINTS = auto()
    BALL_JOINTS = auto()
    SINGULARITIES = auto()
    COLLISIONS = auto()
    ZONE = auto()

    MACHINE = REACH | JOINTS | BALL_JOINTS | SINGULARITIES | COLLISIONS
    ALL = MACHINE | ZONE
