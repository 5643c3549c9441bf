"""Where to go for a target: straight there, or along the edge to the nearest legal place."""

from __future__ import annotations

import numpy as np

from deltaviz.motion.boundary import Boundary
from deltaviz.motion.followed import Array
from deltaviz.motion.space import Space

LEAD = 50.0  # mm; how far ahead of the robot the goal on the boundary runs
STEPS = 4  # of descent in one tick
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
        self._starts: list[Array] = []
        self._descending: Array | None = None
        self._lead: Array | None = None
        self._detour = False
        self.goal = inside  # the target, or the nearest legal place known
        self.exact = True  # whether the goal is the target

    def retarget(self, target: Array, q: Array, *, slide: bool) -> None:
        """A new target, for a robot at q. Without `slide` nothing else will do."""
        known = self.goal if self._target is not None else None
        self._target = target
        self._floor = self._boundary.floor(q)
        self._starts, self._descending, self._lead, self._detour = [], None, None, False
        self.exact = not slide or self._boundary.is_legal(target)
        if self.exact:
            self.goal = target
            return
        line = self._boundary.last_legal(q, target, self._floor)
        first = line
        if known is not None and self._distance(known) < self._distance(line):
            first = known
        self.goal = self._boundary.nearest(first, target, self._floor, STEPS)
        inner = self._boundary.last_legal(self._inside, target, self._floor)
        self._starts = [self.goal, inner, line, *self._around(target)]

    def forget(self) -> None:
        """As if there had been no target."""
        self._target, self._starts, self._descending = None, [], None

    def improve(self) -> bool:
        """A few more steps towards the nearest place; whether the goal moved."""
        if self._target is None or self.exact or not (self._starts or self._descending is not None):
            return False
        if self._descending is None:
            self._descending = self._starts.pop(0)
        before = self._descending
        self._descending = self._boundary.nearest(before, self._target, self._floor, STEPS)
        moved = float(np.linalg.norm(self._descending - before)) > 0.01 * self._space.unit
        gained = self._distance(self.goal) - self._distance(self._descending)
        follows = bool(np.array_equal(before, self.goal))
        better = gained > (0.0 if follows else BETTER * self._space.unit)
        if better:
            self.goal = self._descending
            self._lead = None
        if not moved:
            self._descending = None
        return better

    @property
    def searching(self) -> bool:
        return bool(self._starts) or self._descending is not None

    def places(self, q: Array, *, slide: bool) -> list[tuple[Array, bool]]:
        """Places to make for from q, the best first; whether each is where it all ends."""
        if not slide or self._boundary.clear(q, self.goal, self._boundary.floor(q, 0.0)):
            self._detour = False
            return [(self.goal, True)]
        if self._detour:
            return [(self._inside, False)]
        lead = self._lead_from(q)
        return [(lead, False), (0.5 * (lead + q), False)]

    def stuck(self) -> None:
        """At rest and no nearer: the next way leads through the inside."""
        self._detour = not self._detour

    def is_at(self, q: Array) -> bool:
        return float(np.linalg.norm(self.goal - q)) <= ARRIVED * self._space.unit

    def _lead_from(self, q: Array) -> Array:
        unit = self._space.unit
        floor = np.minimum(self._floor, self._boundary.floor(q))
        lead = self._lead
        if lead is None or np.linalg.norm(lead - q) > 1.5 * LEAD * unit:
            lead = self._boundary.last_legal(q, self.goal, floor)
        for _ in range(STEPS):
            if np.linalg.norm(lead - q) > LEAD * unit:
                break
            lead = self._boundary.step(lead, self.goal, floor)
        self._lead = lead
        return lead

    def _around(self, target: Array) -> list[Array]:
        """Starts to both sides of the straight line from the inside."""
        ahead = target - self._inside
        length = float(np.linalg.norm(ahead))
        starts: list[Array] = []
        for side in np.eye(self._space.axes):
            across = side - ahead * (float(ahead @ side) / max(length * length, 1e-12))
            for sign in (0.7, -0.7):
                aim = target + across * (sign * length)
                starts.append(self._boundary.last_legal(self._inside, aim, self._floor))
        return starts

    def _distance(self, place: Array) -> float:
        assert self._target is not None
        return float(np.linalg.norm(place - self._target))
