"""The state at the end of one segment: what the follower makes and the link sends."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Knot:
    """One segment's end. The segment is the cubic from the knot before to this one.

    `duration` is in seconds of board time, `theta` in rad, `velocity` in rad/s; both have
    one entry per joint.
    """

    duration: float
    theta: tuple[float, ...]
    velocity: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class CartesianKnot:
    """One segment's end, of the tool tip: the board turns the segment into joints itself.

    `duration` is in seconds of board time, `xyz` in mm, `velocity` in mm/s.
    """

    duration: float
    xyz: tuple[float, float, float]
    velocity: tuple[float, float, float]
