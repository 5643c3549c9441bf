"""Where to go for a target: straight there, or along the edge to the nearest legal place."""

from __future__ import annotations

import numpy as np

from deltaviz.motion.boundary import Boundary
from deltaviz.motion.followed import Array
from deltaviz.motion.space import Space

LEADS = (4.0, 8.0, 12.0, 24.0)  # mm; steps along the boundary, ahead of the robot
LEAD_RESERVE = 2.0  # units of margin, about mm, that they keep to limits
STEPS = 4  # of descent in one tick
CLOSER = 0.05  # mm; what one tick's steps must gain to move the goal
BETTER = 0.2  # mm; what a new start must gain to move the goal
ARRIVED = 0.01  # mm


class Seeker:
    """Follows one target in one space. `inside` is a place well within the legal region."""

    def __init__(self, space: Space, inside: Array) -> None:
        self._space = space
        self._boundary = Boundary(space)
        self._inside = inside
        self._target: Array | None = None
        self._floor = inside
        self._starts: list[Array] = []  # where lines from the inside aim
        self._descending: Array | None = None
        self._detour = False
        self.goal = inside  # the target, or the nearest legal place known
        self.exact = True  # whether the goal is the target

    def retarget(self, target: Array, q: Array, *, slide: bool) -> None:
        """A new target, for a robot at q. Without `slide` nothing else will do."""
        known = self.goal if self._target is not None else None
        self._target = target
        self._floor = self._boundary.floor(q)
        self._starts, self._descending, self._detour = [], None, False
        self.exact = not slide or self._boundary.is_legal(target)
        if self.exact:
            self.goal = target
            return
        line = self._boundary.last_legal(q, target, self._floor)
        first = line
        if known is not None and self._distance(known) < self._distance(line):
            first = known
        self.goal = self._boundary.nearest(first, target, self._floor, STEPS)
        self._descending = self.goal
        self._starts = [target, *self._around(target)]

    def forget(self) -> None:
        """As if there had been no target."""
        self._target, self._starts, self._descending = None, [], None

    def improve(self) -> bool:
        """A few more steps towards the nearest place; whether the goal moved."""
        if self._target is None or self.exact or not (self._starts or self._descending is not None):
            return False
        if self._descending is None:
            aim = self._starts.pop(0)
            self._descending = self._boundary.last_legal(self._inside, aim, self._floor)
        before = self._descending
        self._descending = self._boundary.nearest(before, self._target, self._floor, STEPS)
        moved = float(np.linalg.norm(self._descending - before)) > 0.01 * self._space.unit
        gained = self._distance(self.goal) - self._distance(self._descending)
        follows = bool(np.array_equal(before, self.goal))
        better = gained > (CLOSER if follows else BETTER) * self._space.unit
        if better:
            self.goal = self._descending
        if not moved:
            self._descending = None
        return better

    @property
    def searching(self) -> bool:
        return bool(self._starts) or self._descending is not None

    def places(self, q: Array, *, slide: bool) -> list[tuple[Array, bool]]:
        """Places to make for from q, the best first; whether each is where it all ends."""
        floor = self._boundary.floor(q, 0.0)
        if not slide or self._boundary.clear(q, self.goal, floor):
            self._detour = False
            return [(self.goal, True)]
        if self._detour and self._boundary.clear(q, self._inside, floor):
            return [(self._inside, False)]
        goal = self._inside if self._detour else self.goal
        return [(lead, False) for lead in self._leads(q, goal, floor)]

    def stuck(self) -> None:
        """At rest and no nearer: the next way leads through the inside."""
        self._detour = not self._detour

    def is_at(self, q: Array) -> bool:
        return float(np.linalg.norm(self.goal - q)) <= ARRIVED * self._space.unit

    def _leads(self, q: Array, goal: Array, floor: Array) -> list[Array]:
        """Places along the boundary that can be seen from q, the furthest first.

        They keep further off than the goal does, so as to see round a bend.
        """
        least = np.minimum(LEAD_RESERVE, np.maximum(self._boundary.floor(q, np.inf), 0.0) + 0.5)
        seen: list[Array] = []
        at = q
        for length in LEADS:
            on = self._boundary.step(at, goal, least, length)
            if np.array_equal(on, at):
                break
            at = on
            if self._boundary.clear(q, at, floor):
                seen.append(at)
        return seen[::-1] if seen else [at]

    def _around(self, target: Array) -> list[Array]:
        """Places beside the target: lines from the inside to them meet the edge elsewhere."""
        ahead = target - self._inside
        length = float(np.linalg.norm(ahead))
        aims: list[Array] = []
        for side in np.eye(self._space.axes):
            across = side - ahead * (float(ahead @ side) / max(length * length, 1e-12))
            for sign in (0.7, -0.7):
                aims.append(target + across * (sign * length))
        return aims

    def _distance(self, place: Array) -> float:
        assert self._target is not None
        return float(np.linalg.norm(place - self._target))
