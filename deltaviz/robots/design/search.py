"""Differential evolution over the lengths, its candidates scored anywhere."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial
from typing import Any, cast

import numpy as np

from deltaviz.robots.design.candidate import Lengths, Ranges
from deltaviz.robots.design.score import UNREACHED, Task, score

POPULATION = 12  # candidates for each number that is free
SETTLED = 1e-4  # of the scores' mean: their spread at which the search is over

# Scores of many candidates, in their order: `map`, or one that spreads them over processes.
Mapper = Callable[[Callable[..., float], Iterable[Any]], Iterable[float]]


class NothingReaches(ValueError):
    """No lengths in the ranges reach the body; `best` come nearest, and miss by `missing` mm."""

    def __init__(self, best: Lengths, missing: float) -> None:
        super().__init__(
            f"no lengths within these limits reach it: the best miss by {missing:.1f} mm"
        )
        self.best = best
        self.missing = missing


@dataclass(frozen=True, slots=True)
class Found:
    lengths: Lengths
    score: float
    generations: int
    candidates: int


def search(
    task: Task,
    ranges: Ranges,
    *,
    seed: int = 0,
    generations: int = 80,
    mapper: Mapper = map,
    progress: Callable[[int, float], None] = lambda generation, best: None,
) -> Found:
    """The best lengths found; the same for the same seed, however many work on it.

    `progress` hears of every generation and its best score. Raises NothingReaches.
    """
    from scipy.optimize import differential_evolution

    done = 0

    def told(intermediate_result: Any) -> None:
        nonlocal done
        done += 1
        progress(done, float(intermediate_result.fun))

    result = differential_evolution(
        partial(score, task),
        ranges.bounds(),
        rng=np.random.default_rng(seed),
        maxiter=generations,
        popsize=POPULATION,
        tol=SETTLED,
        init="latinhypercube",
        updating="deferred",  # whole generations, which can be shared out
        polish=False,  # rounded lengths have no slope
        workers=cast(Any, mapper),  # which its stubs do not know
        callback=told,
    )
    lengths = task.lengths(result.x)
    if result.fun >= UNREACHED:
        raise NothingReaches(lengths, float(result.fun) - UNREACHED + task.reserve)
    return Found(lengths, float(result.fun), int(result.nit), int(result.nfev))
