"""The last gate before the link: what passes here is finite, legal and brakeable.

The guard knows nothing of the follower and shares none of its checks: a knot is judged from the
knot before and the robot's own limits. What fails is refused with the reason; nothing is put in
its place.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from deltaviz.link.configuration import I32_MAX
from deltaviz.link.flight import POSITION_UNIT
from deltaviz.link.rules import SEGMENT_MAX_MS, SEGMENT_MIN_MS
from deltaviz.motion.knot import Knot
from deltaviz.robots import Robot

RATE_SLACK = 1.002  # of velocity and acceleration limits: rounding to the board's numbers
MARGIN_SLACK = 0.02  # units of margin, about mm
SAME_BRANCH = 1e-6  # rad
DURATION_SLACK = 1e-9  # s
FURTHEST = 0.99 * I32_MAX / POSITION_UNIT  # microsteps; the rest is for the brake
BRAKE_SHARES = (0.25, 0.5, 0.75, 1.0)  # of the brake's time


class Guard:
    """Judges the knots of one epoch, which starts at rest at `theta` (rad)."""

    def __init__(self, robot: Robot, theta: Sequence[float], *, homed: bool) -> None:
        limits = robot.limits.joint
        self._robot = robot
        self._homed = homed
        self._velocity = tuple(limits.velocity if homed else limits.unhomed_velocity)
        self._acceleration = tuple(limits.acceleration)
        self._scale = tuple(robot.drive.microsteps_per_rad)
        self._theta = tuple(theta)
        self._rate = tuple(0.0 for _ in theta)
        self._floor = np.fmin(self._margins((self._theta,))[0], 0.0) if homed else np.empty(0)

    def refusal(self, knot: Knot) -> str | None:
        """Why `knot` must not be sent, or None: then it is the one that the next starts from."""
        reason = self._malformed(knot) or self._too_far(knot) or self._too_fast(knot)
        if reason is None and self._homed:
            reason = self._illegal(knot)
        if reason is None:
            self._theta, self._rate = knot.theta, knot.velocity
        return reason

    def _malformed(self, knot: Knot) -> str | None:
        joints = len(self._theta)
        if len(knot.theta) != joints or len(knot.velocity) != joints:
            return f"a knot for {len(knot.theta)} joints, not {joints}"
        if not all(map(math.isfinite, (knot.duration, *knot.theta, *knot.velocity))):
            return "a knot that is not finite"
        shortest, longest = SEGMENT_MIN_MS / 1000, SEGMENT_MAX_MS / 1000
        if not shortest - DURATION_SLACK <= knot.duration <= longest + DURATION_SLACK:
            return f"a segment of {knot.duration * 1000:.3g} ms"
        return None

    def _too_far(self, knot: Knot) -> str | None:
        """An unhomed robot has no joint limits; what a knot can say is one. It may come back."""
        moved = zip(self._theta, knot.theta, self._scale, strict=True)
        for joint, (before, after, scale) in enumerate(moved):
            if abs(after) * scale > FURTHEST and abs(after) > abs(before):
                return f"joint {joint + 1} at {math.degrees(after):.0f}°, too far from its zero"
        return None

    def _too_fast(self, knot: Knot) -> str | None:
        for joint, (peak, hardest) in enumerate(self._peaks(knot)):
            if peak > self._velocity[joint] * RATE_SLACK:
                return (
                    f"joint {joint + 1} at {math.degrees(peak):.1f}°/s, "
                    f"above {math.degrees(self._velocity[joint]):.1f}°/s"
                )
            if hardest > self._acceleration[joint] * RATE_SLACK:
                return (
                    f"joint {joint + 1} accelerating at {math.degrees(hardest):.0f}°/s², "
                    f"above {math.degrees(self._acceleration[joint]):.0f}°/s²"
                )
        return None

    def _peaks(self, knot: Knot) -> Iterator[tuple[float, float]]:
        """Each joint's largest velocity and acceleration on the cubic to `knot`.

        The acceleration is linear in time, so it peaks at an end; the velocity at an end or
        where the acceleration is zero.
        """
        time = knot.duration
        for p0, v0, p1, v1 in zip(self._theta, self._rate, knot.theta, knot.velocity, strict=True):
            mean = (p1 - p0) / time
            a0 = (6 * mean - 4 * v0 - 2 * v1) / time
            a1 = (2 * v0 + 4 * v1 - 6 * mean) / time
            peak = max(abs(v0), abs(v1))
            if a0 * a1 < 0:
                share = a0 / (a0 - a1)
                peak = max(peak, abs(v0 + time * share * (a0 + 0.5 * (a1 - a0) * share)))
            yield peak, max(abs(a0), abs(a1))

    def _illegal(self, knot: Knot) -> str | None:
        """Legality at the middle, at the end, and along the brake from the end.

        Where the epoch began outside a limit, that limit must not get worse, nor worse again than
        it has become since: no number of knots creeps outwards by the slack of each.
        """
        poses = [self._middle(knot), knot.theta, *self._brake(knot)]
        margins = self._margins(poses)
        floor = self._floor - MARGIN_SLACK
        if np.isnan(margins).any():
            return "a pose in which the arms would change over or cannot meet"
        rows, columns = np.nonzero(margins < floor)
        if len(rows):
            what = "brake" if rows[0] > 1 else "segment"
            return f"a {what} that breaks {self._robot.margin_names[int(columns[0])]}"
        self._floor = np.maximum(self._floor, np.minimum(margins[1], 0.0))
        return None

    def _middle(self, knot: Knot) -> tuple[float, ...]:
        return tuple(
            0.5 * (p0 + p1) + knot.duration / 8 * (v0 - v1)
            for p0, v0, p1, v1 in zip(
                self._theta, self._rate, knot.theta, knot.velocity, strict=True
            )
        )

    def _brake(self, knot: Knot) -> Iterator[tuple[float, ...]]:
        """Where the board's brake from `knot` leads: all joints along the tangent, in one time."""
        time = max(abs(v) / a for v, a in zip(knot.velocity, self._acceleration, strict=True))
        if time == 0.0:
            return
        for share in BRAKE_SHARES:
            travel = time * (share - 0.5 * share * share)
            yield tuple(p + v * travel for p, v in zip(knot.theta, knot.velocity, strict=True))

    def _margins(self, poses: Sequence[tuple[float, ...]]) -> NDArray[np.float64]:
        """The margins (k, m) of each pose; NaN in rows on another branch or without a pose."""
        theta = np.array(poses, dtype=np.float64)
        kernel = self._robot.kernel
        xyz = kernel.forward(theta)
        margins = kernel.margins(xyz, theta)
        same = np.abs(kernel.inverse(xyz) - theta).max(axis=1) < SAME_BRANCH
        return np.where(same[:, None], margins, np.nan)
