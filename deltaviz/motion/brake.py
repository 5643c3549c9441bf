"""The one brake: all joints along their tangent, to rest in one common time.

The board brakes in T = max |v_i|/a_i. What is planned and checked here is slightly longer (so
that rounding to the board's numbers stays within the acceleration limit, and no segment is
shorter than the board takes): the board's own brake runs on the same line and ends sooner.
"""

from __future__ import annotations

import math

import numpy as np

from deltaviz.motion.check import BETWEEN, brake_points
from deltaviz.motion.check_compiled import SAME_BRANCH, first_bad_brake
from deltaviz.motion.dynamics import brake_time
from deltaviz.motion.followed import Array, Followed
from deltaviz.motion.plan import Plan
from deltaviz.motion.space import JointSpace

WHOLE_TICKS = 25e-6  # s: at 40 kHz as at 200 kHz, so that segments are as long as planned


def brake_plan(space: JointSpace, theta: Array, rate: Array, period: float) -> Plan:
    """The brake from one state as equal segments of about `period` (s)."""
    time = brake_time(rate, space.acceleration)
    count = max(1, round(time / period))
    time = count * math.floor(time / count / WHOLE_TICKS) * WHOLE_TICKS
    at = np.linspace(0.0, 1.0, count + 1)[:, None]
    along = theta + rate * (time * (at - 0.5 * at * at))
    velocity = rate * (1.0 - at)
    acceleration = np.repeat(-rate[None, :] / time, count + 1, axis=0)
    acceleration[-1] = 0.0
    return Plan(
        space=space,
        theta=along,
        rate=velocity,
        pose=space.kernel.forward(np.ascontiguousarray(along)),
        q=along,
        v=velocity,
        a=acceleration,
        segment=time / count,
        braking=True,
    )


def brake_legal(robot: Followed, theta: Array, rate: Array) -> str | None:
    """Why the brake from this state would break a limit, or None. theta, rate (n,) rad, rad/s."""
    kernel = robot.kernel
    start = np.ascontiguousarray(theta, dtype=float)[None, :]
    limits = np.asarray(robot.limits.joint.acceleration, dtype=float)
    points = brake_points(start, np.ascontiguousarray(rate, dtype=float)[None, :], limits)
    every = np.concatenate((start, points))
    xyz = kernel.forward(every)
    back = kernel.inverse(xyz)
    if not np.all(np.abs(back - every) < SAME_BRANCH):
        return "the brake would leave the arms' working branch"
    column = first_bad_brake(kernel.margins(xyz, every), BETWEEN)
    return None if column < 0 else f"the brake would break {robot.margin_names[column]}"
