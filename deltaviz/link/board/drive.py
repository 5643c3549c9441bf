"""The upper tier: takes the steppers along a path, piece by piece of 1 ms."""

from __future__ import annotations

from collections.abc import Sequence

from deltaviz.link.board.brake import brake
from deltaviz.link.board.parameters import Parameters
from deltaviz.link.board.paths import Path
from deltaviz.link.board.plant import Plant
from deltaviz.link.board.stepper import Stepper, piece_ticks


class Drive:
    def __init__(self, parameters: Parameters, plant: Plant, *, ticks_per_ms: int) -> None:
        self._accelerations = parameters.accelerations
        self._ticks_per_ms = ticks_per_ms
        self._stepper = Stepper(parameters.joints)
        self._path: Path | None = None
        self._piece_end = 0  # in ticks of the path
        self.plant = plant
        self.switches = plant.switches  # as last looked at

    @property
    def moving(self) -> bool:
        return self._path is not None

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
        self.plant.rebase(self._stepper.counts)

    def follow(self, path: Path) -> None:
        self._path = path
        self._piece_end = 0
        self._load(path)

    def brake(self) -> None:
        """From the middle of the path: leaves it along its tangent."""
        if self._path is not None:
            tick = self._piece_end - self._stepper.remaining
            self.brake_from(self._path.velocities(tick))

    def brake_from(self, velocities: Sequence[int]) -> None:
        self.follow(
            brake(
                positions=self._stepper.positions,
                velocities=velocities,
                accelerations=self._accelerations,
                ticks_per_ms=self._ticks_per_ms,
            )
        )

    def cut(self) -> None:
        """The drivers are off: no further step."""
        self._path = None
        self._stepper.place(self._stepper.positions)
        self.plant.step(self._stepper.counts)

    def advance(self, ticks: int) -> int:
        """Follows the path for `ticks`, or until it ends or a switch changes; the ticks passed.

        The switches are looked at wherever a piece ends.
        """
        stepper, passed = self._stepper, 0
        while self._path is not None and passed < ticks:
            step = min(ticks - passed, stepper.remaining)
            stepper.advance(step)
            passed += step
            if stepper.remaining:
                break
            self.plant.step(stepper.counts)
            if self._piece_end < self._path.ticks:
                self._load(self._path)
            else:
                self._path = None
            switches = self.plant.switches
            if switches != self.switches:
                self.switches = switches
                break
        return passed

    def _load(self, path: Path) -> None:
        ticks = piece_ticks(path.ticks - self._piece_end, self._ticks_per_ms)
        self._piece_end += ticks
        self._stepper.load(path.positions(self._piece_end), ticks)
