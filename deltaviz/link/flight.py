"""What the host has sent of a motion and the board has not yet run: one epoch's segments.

Knots become integers here, each from its absolute position, so rounding never adds up: a knot is
at most half of 2^-10 microsteps off, the tenth and the millionth alike.
"""

from __future__ import annotations

from collections.abc import Sequence

from deltaviz.link.messages import Arm, BoardState, CartesianSegment, Segment, Telemetry
from deltaviz.link.rules import since
from deltaviz.link.unseen import Unseen
from deltaviz.motion.knot import CartesianKnot, Knot

POSITION_UNIT = 1024  # per microstep
VELOCITY_UNIT = 65536 / 1000  # per microstep per second
TIP_POSITION_UNIT = 256_000  # per mm
TIP_VELOCITY_UNIT = 65_536  # per mm/s


class Flight:
    """One epoch, from its arming on. Angles are counts / `microsteps_per_rad`."""

    def __init__(
        self,
        *,
        epoch: int,
        telemetry: Telemetry,
        tick_hz: int,
        microsteps_per_rad: Sequence[float],
    ) -> None:
        self.epoch = epoch
        self._tick_hz = tick_hz
        self._scale = tuple(microsteps_per_rad)
        self._counts = telemetry.counts
        self._started = telemetry.now
        self._index = 0
        self._t_end = telemetry.now
        self._resting = True
        self.unseen = Unseen(tick_hz=tick_hz)

    @property
    def resting(self) -> bool:
        """Whether the last knot sent is at rest: then the queue may run dry."""
        return self._resting

    def arm(self) -> Arm:
        return Arm(epoch=self.epoch, t_start=self._started, counts=self._counts)

    def segment(
        self, knot: Knot | CartesianKnot, telemetry: Telemetry
    ) -> Segment | CartesianSegment:
        """`knot` on the wire. From rest it starts at the board's present tick, that is, at once."""
        duration = round(knot.duration * self._tick_hz)
        start = self._t_end
        if self._resting and since(telemetry.now, start) > 0:
            start = telemetry.now
        t_end = (start + duration) & 0xFFFF_FFFF
        when = (self.epoch, self._index, t_end, duration, telemetry.now)
        if isinstance(knot, Knot):
            segment = Segment(*when, *self._joints(knot))
        else:
            segment = CartesianSegment(*when, *_tip(knot))
        self.unseen.add(segment, telemetry)
        self._index = (self._index + 1) & 0xFFFF
        self._t_end = segment.t_end
        self._resting = not any(segment.v)
        return segment

    def _joints(self, knot: Knot) -> tuple[tuple[int, ...], tuple[int, ...]]:
        theta = zip(knot.theta, self._scale, strict=True)
        velocity = zip(knot.velocity, self._scale, strict=True)
        return (
            tuple(round(angle * scale * POSITION_UNIT) for angle, scale in theta),
            tuple(round(rate * scale * VELOCITY_UNIT) for rate, scale in velocity),
        )

    def acknowledge(self, telemetry: Telemetry) -> None:
        """Forget what `telemetry` says has been taken into the queue."""
        if self._is_armed(telemetry):
            self.unseen.acknowledge(telemetry)

    def never_began(self, telemetry: Telemetry) -> bool:
        """What was sent has been under way for so long that it must not begin any more."""
        ended = self._is_armed(telemetry) and telemetry.state is not BoardState.ARMED
        return not ended and self.unseen.too_late(telemetry)

    def ahead(self, telemetry: Telemetry, *, elapsed: float) -> float:
        """Seconds of motion that the board still has, `elapsed` s after `telemetry` came."""
        queued = since(telemetry.t_queue_end, telemetry.now) if self._is_armed(telemetry) else 0
        ticks = max(0, queued) + self.unseen.ticks
        return max(0.0, ticks / self._tick_hz - elapsed)

    @property
    def unacknowledged(self) -> float:
        """Seconds of motion that were sent and of which no telemetry has told."""
        return self.unseen.ticks / self._tick_hz

    def free(self, telemetry: Telemetry) -> int:
        """Places in the board's queue that nothing sent will take."""
        return telemetry.free - len(self.unseen)

    def all_taken(self, telemetry: Telemetry) -> bool:
        """Whether the board has all that was sent, and has run it."""
        if self.unseen or not self._is_armed(telemetry):
            return not self.unseen and self._index == 0
        return since(telemetry.t_queue_end, telemetry.now) <= 0

    def _is_armed(self, telemetry: Telemetry) -> bool:
        return telemetry.epoch == self.epoch


def _tip(knot: CartesianKnot) -> tuple[tuple[int, int, int], tuple[int, int, int]]:
    (x, y, z), (vx, vy, vz) = knot.xyz, knot.velocity
    p, v = TIP_POSITION_UNIT, TIP_VELOCITY_UNIT
    return (round(x * p), round(y * p), round(z * p)), (round(vx * v), round(vy * v), round(vz * v))
