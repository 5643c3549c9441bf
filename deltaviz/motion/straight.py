"""Whether a whole straight line is legal, so that a move can be refused before it begins."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from deltaviz.motion.boundary_compiled import first_illegal
from deltaviz.motion.followed import Followed
from deltaviz.motion.held_by import HeldBy
from deltaviz.robots.coordinates import in_space

SPACING = 0.5  # mm between samples
MOST = 4000  # samples of one line


def check_straight(robot: Followed, pose_from: ArrayLike, pose_to: ArrayLike) -> str | None:
    """Why the tool must not go straight from one pose (n,) to another (`Robot.pose`), or None.

    A robot that starts outside a limit may go where that limit is not violated further.
    """
    start = np.asarray(pose_from, dtype=float)
    end = np.asarray(pose_to, dtype=float)
    if not (np.isfinite(start).all() and np.isfinite(end).all()):
        return "The target must be finite numbers"
    length = float(np.linalg.norm(end - start))
    count = min(MOST, max(2, math.ceil(length / SPACING)))
    points = np.ascontiguousarray(start + (end - start) * np.linspace(0, 1, count)[:, None])
    margins = robot.kernel.margins(points, robot.kernel.inverse(points))
    bad = first_illegal(margins, np.minimum(margins[0], 0.0))
    if bad < 0:
        return None
    column = int(np.argmin(np.where(np.isnan(margins[bad]), -np.inf, margins[bad])))
    limit = HeldBy(robot).words(robot.margin_names[column])
    why = limit[0].lower() + limit[1:]
    tip = in_space(points[bad][: len(robot.axes)])
    place = ", ".join(f"{round(value, 1) + 0.0:.1f}" for value in tip)  # + 0.0: no "-0"
    if bad == count - 1:
        return f"The target ({place}) mm is not reachable: {why}"
    return f"The straight way leaves the reachable space at ({place}) mm: {why}"
