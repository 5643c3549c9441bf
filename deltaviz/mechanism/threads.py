"""Many rows shared out to several threads, for compiled loops that let others run meanwhile."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise

LEAST_SHARE = 10_000  # poses a thread gets, below which starting one costs more than it saves


def in_threads(
    run: Callable[[slice], object], rows: int, threads: int, *, least: int = LEAST_SHARE
) -> None:
    """`run` over slices that together are `range(rows)`; it must only write to its own slice."""
    shares = max(1, min(threads, rows // least))
    edges = [rows * share // shares for share in range(shares + 1)]
    slices = [slice(start, end) for start, end in pairwise(edges)]
    if shares == 1:
        run(slices[0])
        return
    with ThreadPoolExecutor(shares) as pool:
        list(pool.map(run, slices))
