"""A board that knows its robot: the parts that depend on it, and what it makes of segments."""

from __future__ import annotations

from collections.abc import Sequence

from deltaviz.link.board.checks import Checks
from deltaviz.link.board.drive import Drive
from deltaviz.link.board.limits import Leeway, Limits, Objection
from deltaviz.link.board.parameters import Parameters
from deltaviz.link.board.paths import Cubic, Path
from deltaviz.link.board.plant import Plant
from deltaviz.link.board.queue import Entry, Knot, knot_of
from deltaviz.link.board.tip import joint_knot, tip_knot
from deltaviz.link.board.tip_checks import TipChecks
from deltaviz.link.board.tip_path import TipPath
from deltaviz.link.messages import CartesianSegment, Segment


class ConfiguredBoard:
    def __init__(
        self, parameters: Parameters, *, theta: Sequence[float], hash_: int, tick_hz: int
    ) -> None:
        """`theta` is the hidden pose of the arms (rad)."""
        self.parameters = parameters
        self.hash = hash_
        self._tick_hz = tick_hz
        self.limits = Limits(parameters)
        self._checks = Checks(self.limits, tick_hz=tick_hz)
        has_arms = parameters.kinematics is not None
        self._tip_checks = TipChecks(self.limits, tick_hz=tick_hz) if has_arms else None
        plant = Plant(parameters, theta=theta)
        self.drive = Drive(parameters, plant, ticks_per_ms=tick_hz // 1000)

    def origin(
        self, segment: Segment | CartesianSegment, knot: Knot, *, homed: bool
    ) -> Knot | None:
        """`knot` as a segment of this kind speaks of it; None: this kind is not possible there."""
        cartesian = isinstance(segment, CartesianSegment)
        if cartesian and not homed:
            return None
        if cartesian == knot.cartesian:
            return knot
        if not knot.rests:
            return None
        change = tip_knot if cartesian else joint_knot
        return change(self.parameters, knot)

    def objection(
        self, segment: Segment | CartesianSegment, origin: Knot, leeway: Leeway, *, homed: bool
    ) -> Objection | None:
        if isinstance(segment, CartesianSegment):
            assert self._tip_checks is not None
            end = knot_of(segment, origin)
            return self._tip_checks.objection(origin, end, segment.duration, leeway=leeway)
        return self._checks.objection(
            p0=origin.p,
            v0=origin.v,
            p1=segment.p,
            v1=segment.v,
            ticks=segment.duration,
            homed=homed,
            outside=leeway.outside,
        )

    def path(self, entry: Entry) -> Path:
        origin, knot = entry.origin, entry.knot
        if knot.cartesian:
            return TipPath(
                self.parameters, origin, knot, ticks=entry.duration, tick_hz=self._tick_hz
            )
        return Cubic(
            start=origin.p,
            end=knot.p,
            v_start=origin.v,
            v_end=knot.v,
            ticks=entry.duration,
            ticks_per_ms=self._tick_hz // 1000,
        )
