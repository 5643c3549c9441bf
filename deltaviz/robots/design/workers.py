"""Who scores the candidates: this process, some processes here, or a Dask cluster."""

from __future__ import annotations

import contextlib
import math
import multiprocessing
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from typing import Any

from deltaviz.robots.design.search import Mapper

CONNECT_S = 10.0  # for a scheduler to answer


class NoScheduler(RuntimeError):
    """No Dask cluster can be had at an address, or Dask itself is missing; says which."""


@contextlib.contextmanager
def here(processes: int) -> Iterator[Mapper]:
    """On this computer. Processes are spawned: threads and locks of this one stay here."""
    if processes <= 1:
        yield map
        return
    spawned = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(processes, mp_context=spawned) as pool:

        def run(function: Callable[..., float], values: Iterable[Any]) -> list[float]:
            rows = list(values)
            return list(pool.map(function, rows, chunksize=math.ceil(len(rows) / processes)))

        yield run


@contextlib.contextmanager
def cluster(address: str) -> Iterator[Mapper]:
    """On the workers of a Dask scheduler, which must have deltaviz, too. Raises NoScheduler."""
    try:
        from distributed import Client
        from distributed.comm.addressing import resolve_address
    except ImportError as error:
        raise NoScheduler(
            "--scheduler needs Dask: install it with `pip install 'deltaviz[dask]'`"
        ) from error
    try:
        resolve_address(address)  # a client of one that cannot be is no more to be closed
        client: Any = Client(address, timeout=CONNECT_S, set_as_default=False)
    except (OSError, ValueError, TimeoutError) as error:
        raise NoScheduler(f"no Dask scheduler answers at {address}: {error}") from error
    with client:
        if not client.nthreads():
            raise NoScheduler(f"the scheduler at {address} has no workers")

        def run(function: Callable[..., float], values: Iterable[Any]) -> list[float]:
            rows = list(values)
            size = math.ceil(len(rows) / sum(client.nthreads().values()))
            chunks = [rows[i : i + size] for i in range(0, len(rows), size)]
            futures = client.map(partial(_each, function), chunks, pure=False)
            return [value for chunk in client.gather(futures) for value in chunk]

        yield run


def _each(function: Callable[..., float], rows: list[Any]) -> list[float]:
    return [function(row) for row in rows]
