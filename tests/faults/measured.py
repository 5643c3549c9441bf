"""What the tests judge and docs/reliability.md shows, each measured once a run."""

from __future__ import annotations

from functools import cache

from tests.faults.breaks import Outcome, break_at
from tests.faults.faulty_line import Fault
from tests.faults.wire_faults import RATES, Work, connects, work_with

SEED = 1
TRIES = 5


@cache
def work(fault: Fault) -> Work:
    return work_with(fault, seconds=RATES[fault.rate], seed=SEED)


@cache
def meetings(fault: Fault) -> tuple[str | None, ...]:
    """Of several tries: None, or what was told."""
    return tuple(connects(fault, seed=SEED + k) for k in range(TRIES))


@cache
def outcome(phase: str, how: str) -> Outcome:
    return break_at(phase, how, seed=SEED)
