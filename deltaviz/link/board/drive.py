"""The upper tier: where the joints are to be, from boundary to boundary, along one path at a time.

Ticks are the board's. What is planned is final: a path that is left is left where the plan ends.
"""

from __future__ import annotations

from collections.abc import Sequence

from deltaviz.link.board.brake import brake
from deltaviz.link.board.parameters import Parameters
from deltaviz.link.board.paths import Path
from deltaviz.link.board.plant import Plant
from deltaviz.link.board.stepper import Stepper
from deltaviz.link.rules import since


class Drive:
    """`path` is what is followed where the plan ends; None: nothing moves there."""

    def __init__(self, parameters: Parameters, plant: Plant, *, ticks_per_ms: int) -> None:
        self._accelerations = parameters.accelerations
        self._ticks_per_ms = ticks_per_ms
        self._inwards = parameters.configure.homing_direction
        self._stepper = Stepper(parameters.joints, ticks_per_ms)
        self._start = 0  # of the path
        self.end = 0  # of the path
        self.path: Path | None = None
        self.planned: Sequence[int] = [0] * parameters.joints  # where the plan ends, Q32
        self.plant = plant

    @property
    def moving(self) -> bool:
        return self.path is not None or not self._stepper.stands

    @property
    def positions(self) -> list[int]:
        """In Q32."""
        return self._stepper.positions

    @property
    def counts(self) -> tuple[int, ...]:
        return self._stepper.counts

    def place(self, positions: Sequence[int]) -> None:
        """At rest: says what the position is. The arms do not move."""
        self._stepper.place(positions)
        self.planned = positions
        self.plant.rebase(self._stepper.counts)

    def cut(self) -> None:
        """The drivers are off: no further step."""
        positions = self._stepper.positions
        self.plant.step(self._stepper.counts)
        self.path = None
        self._stepper.place(positions)
        self.planned = positions

    def follow(self, path: Path, start: int) -> None:
        """From tick `start` on: not before where the plan ends now."""
        self.path = path
        self._start = start
        self.end = (start + path.ticks) & 0xFFFF_FFFF

    def brake(self, tick: int) -> None:
        """Leaves the path along its tangent, at `tick`: where the plan ends, or the path does. One
        that has not begun by then is left where it begins.
        """
        if self.path is None:
            return
        at = max(0, since(tick, self._start))
        positions, velocities = self.path.positions(at), self.path.velocities(at)
        if positions is None or velocities is None:
            self.path = None
            return
        path = brake(
            positions=positions,
            velocities=velocities,
            accelerations=self._accelerations,
            ticks_per_ms=self._ticks_per_ms,
        )
        self.follow(path, (self._start + at) & 0xFFFF_FFFF)

    def rest(self) -> None:
        """The path has ended, and it ended at rest."""
        assert self.path is not None
        self.planned = self.path.positions(self.path.ticks) or self.planned
        self.path = None

    def leads_into(self, switches: Sequence[bool]) -> bool:
        """Where a piece begins: a joint whose switch is pressed goes on towards its mechanical
        end."""
        here, direction = self._stepper.positions, self._inwards
        return any(
            pressed and (there - now) * direction > 0
            for pressed, now, there in zip(switches, here, self.planned, strict=True)
        )

    def advance(self, ticks: int) -> None:
        self._stepper.advance(ticks)

    def begin_piece(self) -> None:
        if not self._stepper.stands:
            self._stepper.begin_piece()
            self.plant.step(self._stepper.counts)

    def plan(self, tick: int) -> bool:
        """Until `tick`, one piece beyond the plan. False: the path leads nowhere there."""
        if self.path is not None:
            positions = self.path.positions(since(tick, self._start))
            if positions is None:
                return False
            self.planned = positions
        self._stepper.plan(self.planned)
        return True
