"""How regular the control loop is, measured where it runs."""

from __future__ import annotations

from dataclasses import dataclass

BUCKET = 0.0001  # s
BUCKETS = 2000  # up to 200 ms; what is longer shows in `worst`


@dataclass(frozen=True, slots=True)
class LoopStats:
    """Periods of the loop while the robot moves, in seconds."""

    count: int
    p50: float
    p99: float
    worst: float
    underruns: int


class Periods:
    """A histogram: constant in memory, cheap to add to."""

    def __init__(self) -> None:
        self.reset()

    def reset(self) -> None:
        self._counts = [0] * (BUCKETS + 1)
        self._total = 0
        self._worst = 0.0

    def add(self, period: float) -> None:
        self._counts[min(BUCKETS, int(period / BUCKET))] += 1
        self._total += 1
        self._worst = max(self._worst, period)

    def stats(self, *, underruns: int) -> LoopStats:
        return LoopStats(
            count=self._total,
            p50=self._percentile(0.50),
            p99=self._percentile(0.99),
            worst=self._worst,
            underruns=underruns,
        )

    def _percentile(self, share: float) -> float:
        """The upper edge of the bucket below which `share` of the periods lie."""
        seen = 0
        for bucket, count in enumerate(self._counts):
            seen += count
            if self._total and seen >= share * self._total:
                return min(self._worst, (bucket + 1) * BUCKET)
        return 0.0
