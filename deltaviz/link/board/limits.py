"""A robot's limits as its board judges by them: in microsteps, seconds and mm, slack included."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import hypot, inf

from deltaviz.link.board.kinematics import Vector
from deltaviz.link.board.parameters import Parameters
from deltaviz.link.board.queue import Knot
from deltaviz.link.board.tip import tip_of
from deltaviz.link.messages import Refusal

RELATIVE_SLACK = 1e-3  # of speeds and accelerations
TIP_SLACK = 0.1  # mm
P_STEP = 2.0**-10  # microsteps: the unit of a knot's position
V_STEP = 1000 / 65536  # microsteps per second: the unit of a knot's velocity
A_STEP = 1e6 / 2**24  # microsteps per second²: the unit of a configured acceleration


@dataclass(frozen=True, slots=True)
class Objection:
    reason: Refusal
    joint: int | None = None


@dataclass(frozen=True, slots=True)
class Leeway:
    """How far out an epoch may lead that began outside its limits: no further than it `began`
    (units of a knot's positions), the tip no further `outside` (mm; 0 inside its workspace) than
    it has come in since. It is kept for the whole epoch, so that no number of segments can creep
    outwards by the slack of each.
    """

    began: tuple[int, ...]
    outside: float


class Limits:
    """`low` and `high` have one microstep of slack, the others none yet."""

    def __init__(self, parameters: Parameters) -> None:
        configure = parameters.configure
        self.kinematics = parameters.kinematics
        self.per_rad = configure.microsteps_per_rad
        self.low = [limit * P_STEP - 1 for limit in configure.joint_min]
        self.high = [limit * P_STEP + 1 for limit in configure.joint_max]
        self.velocity = [limit * V_STEP for limit in configure.velocity]
        self.unhomed = [
            min(unhomed * V_STEP, limit)
            for unhomed, limit in zip(configure.unhomed_velocity, self.velocity, strict=True)
        ]
        self.acceleration = [limit * A_STEP for limit in configure.acceleration]
        self._ranges = (configure.workspace_x, configure.workspace_y, configure.workspace_z)
        self._radius = configure.workspace_radius

    def brake_ends(self, positions: Sequence[float], speeds: Sequence[float]) -> list[float]:
        """Where the brake ends that begins so, by joints (microsteps, s)."""
        time = max(abs(v) / a for v, a in zip(speeds, self.acceleration, strict=False))
        return [p + v * time / 2 for p, v in zip(positions, speeds, strict=True)]

    def leeway_at(self, knot: Knot, *, homed: bool) -> Leeway:
        """Of an epoch that begins at rest at `knot`. Until it is homed, no tip is known."""
        knows_tip = homed and self.kinematics is not None
        return Leeway(knot.p, self._knot_outside(knot) if knows_tip else 0.0)

    def come_to(self, knot: Knot, leeway: Leeway) -> Leeway:
        """A segment leads to `knot`."""
        if leeway.outside == 0.0:
            return leeway
        return replace(leeway, outside=min(leeway.outside, self._knot_outside(knot)))

    def _knot_outside(self, knot: Knot) -> float:
        if knot.cartesian:
            return self.outside(tip_of(knot))
        return self.outside_at([p * P_STEP for p in knot.p])

    def outside(self, tip: Vector) -> float:
        """How far the tool tip is outside its workspace (mm)."""
        outside = max(0.0, hypot(tip[0], tip[1]) - self._radius)
        for value, (low, high) in zip(tip, self._ranges, strict=True):
            outside = max(outside, low - value, value - high)
        return outside

    def outside_at(self, microsteps: Sequence[float]) -> float:
        """The same, where the arms are; infinite where there is no tip."""
        assert self.kinematics is not None
        arms = len(self.kinematics.arms)
        theta = [p / m for p, m in zip(microsteps[:arms], self.per_rad[:arms], strict=True)]
        tip = self.kinematics.tip(theta)
        return inf if tip is None else self.outside(tip)
