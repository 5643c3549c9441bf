"""Distances between parts, each a line with a radius, by elementary geometry."""

from __future__ import annotations

import numpy as np

Line = tuple[str, int, np.ndarray, np.ndarray, float]  # name, arm, both ends, radius


def from_line(point: np.ndarray, a: np.ndarray, b: np.ndarray) -> float:
    share = np.clip((point - a) @ (b - a) / ((b - a) @ (b - a)), 0, 1)
    return float(np.linalg.norm(a + share * (b - a) - point))


def gap(one: Line, other: Line) -> float:
    """Two lines are nearest where they cross, seen along both, or at one of the four ends."""
    (_, _, a, b, first), (_, _, c, d, second) = one, other
    found = [from_line(a, c, d), from_line(b, c, d), from_line(c, a, b), from_line(d, a, b)]
    across = np.cross(b - a, d - c)
    if np.linalg.norm(across) > 1e-9:
        s, t, _ = np.linalg.solve(np.stack((b - a, c - d, across), axis=-1), c - a)
        if 0 <= s <= 1 and 0 <= t <= 1:
            found.append(float(abs((c - a) @ across) / np.linalg.norm(across)))
    return min(found) - first - second
