"""Why a workspace is empty."""

from __future__ import annotations

from deltaviz.robots.robot import Robot
from deltaviz.robots.workspace.boundary import march
from deltaviz.robots.workspace.cells import hull
from deltaviz.robots.workspace.field import Grid, sample
from deltaviz.robots.workspace.limits import Limit
from deltaviz.robots.workspace.margins import Margins

CELLS = 60

_REASONS = {
    Limit.REACH: "The arms reach no point in common: the forearms are too short to meet, or the "
    "base too wide for them.",
    Limit.JOINTS: "Within the joint limits the forearms cannot meet.",
    Limit.BALL_JOINTS: "Wherever the forearms meet, a ball joint would be beyond its limit.",
    Limit.SINGULARITIES: "Wherever the forearms meet, the robot is too near a singularity.",
    Limit.COLLISIONS: "Wherever the forearms meet, parts of the robot would touch each other.",
    Limit.ZONE: "No point of the zone that the robot file allows is within reach.",
}


def why_empty(robot: Robot, limits: Limit) -> str | None:
    """The first of the limits, in the order in which they are listed, that leaves nothing; None
    if something is left."""
    counted = Limit.REACH
    for limit, reason in _REASONS.items():
        if limit is not Limit.REACH and limit not in limits:
            continue
        counted |= limit
        if is_empty(Margins.of(robot, counted)):
            return reason
    return None


def is_empty(margins: Margins) -> bool:
    """Proved, or nothing found at the nodes of a grid."""
    box = hull(margins)
    if box is None:
        return True
    field = sample(margins, Grid.around(box, float(box.size.max()) / CELLS))
    return not len(march(margins, field).faces)
