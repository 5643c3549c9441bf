"""What comes of faults on the wire, by kind and rate, while a person works with the robot."""

from __future__ import annotations

from dataclasses import dataclass

from deltaviz.machine.mode import Mode
from tests.faults.breaks import judge
from tests.faults.faulty_line import Fault, Kind, Unit
from tests.faults.judge import Verdict
from tests.faults.operator import Day, Operator
from tests.faults.phases import quick_robot
from tests.faults.wire_bench import WireBench

RATES = {0.0001: 4.0, 0.001: 3.0, 0.01: 2.0, 0.05: 2.0}  # and seconds of work
FAULTS = [Fault(kind, unit, rate) for unit in Unit for kind in Kind for rate in RATES]
GREETED = 11.0  # s within which a link is up or was given up


@dataclass(frozen=True)
class Work:
    frames: int  # both ways
    injected: int
    day: Day
    verdicts: tuple[Verdict, ...]
    end: Mode

    @property
    def wrong(self) -> list[str]:
        return [text for verdict in self.verdicts for text in verdict.wrong]


def work_with(fault: Fault | None, *, seconds: float, seed: int) -> Work:
    """On a wire that is sound until the board is known. Raises AssertionError if the robot does
    not come to rest, or a motion has no end.
    """
    bench = WireBench(quick_robot(), seed=seed)
    bench.run_until(lambda: bench.mode is Mode.IDLE)
    lines = (bench.to_board, bench.to_host)
    before = sum(line.frames for line in lines)
    for line in lines:
        line.fault = fault
    day = Operator(bench).work(seconds)
    verdicts = tuple(judge()(executed) for executed in bench.executed)
    frames = sum(line.frames for line in lines) - before
    return Work(frames, bench.injected, day, verdicts, bench.mode)


def connects(fault: Fault, *, seed: int) -> str | None:
    """None if a board becomes known through such a wire; else what is told of it."""
    bench = WireBench(quick_robot(), seed=seed, fault=fault)
    end = bench.now + GREETED
    while not bench.snapshot.link.connected and bench.snapshot.link.problem is None:
        assert bench.now < end, "neither connected nor given up"
        bench.run(0.01)
    return bench.snapshot.link.problem
