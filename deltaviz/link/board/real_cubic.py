"""The motion of one coordinate between two knots as a cubic, in real numbers.

What runs is the same in integers: paths.
"""

from __future__ import annotations

from math import sqrt


class RealCubic:
    """In a length and seconds; the acceleration is linear in time."""

    __slots__ = ("a0", "a1", "p0", "p1", "seconds", "v0", "v1")

    def __init__(self, p0: float, p1: float, v0: float, v1: float, seconds: float) -> None:
        mean = 6 * (p1 - p0) / (seconds * seconds)
        self.p0, self.p1, self.v0, self.v1, self.seconds = p0, p1, v0, v1, seconds
        self.a0 = mean - (4 * v0 + 2 * v1) / seconds
        self.a1 = (2 * v0 + 4 * v1) / seconds - mean

    @property
    def top_acceleration(self) -> float:
        return max(abs(self.a0), abs(self.a1))

    @property
    def top_speed(self) -> float:
        top = max(abs(self.v0), abs(self.v1))
        if self.a0 * self.a1 < 0:
            top = max(
                top, abs(self.v0 + self.a0 * self.seconds * self.a0 / (self.a0 - self.a1) / 2)
            )
        return top

    def position(self, t: float) -> float:
        a0 = self.a0
        return self.p0 + t * (self.v0 + t * (a0 / 2 + t * (self.a1 - a0) / (6 * self.seconds)))

    def velocity(self, t: float) -> float:
        return self.v0 + t * (self.a0 + t * (self.a1 - self.a0) / (2 * self.seconds))

    def acceleration(self, t: float) -> float:
        return self.a0 + t * (self.a1 - self.a0) / self.seconds

    def stays_within(self, low: float, high: float) -> bool:
        third = self.seconds / 3
        hull = (self.p0, self.p0 + self.v0 * third, self.p1 - self.v1 * third, self.p1)
        if low <= min(hull) and max(hull) <= high:
            return True
        points = [self.p0, self.p1, *map(self.position, self._turning_points())]
        return low <= min(points) and max(points) <= high

    def _turning_points(self) -> list[float]:
        a0, v0 = self.a0, self.v0
        curve = (self.a1 - a0) / (2 * self.seconds)
        inside = a0 * a0 - 4 * curve * v0
        if inside < 0:
            return []
        # The two roots without cancellation; either divisor may vanish.
        q = -(a0 + (sqrt(inside) if a0 >= 0 else -sqrt(inside))) / 2
        roots = ([q / curve] if curve else []) + ([v0 / q] if q else [])
        return [root for root in roots if 0 < root < self.seconds]
