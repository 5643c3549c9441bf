"""However many work on it, and wherever they are, the same lengths are found."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest
from distributed import LocalCluster

from deltaviz.robots import load_robot
from deltaviz.robots.design import Found, Ranges, Task, Wish, search
from deltaviz.robots.design.workers import NoScheduler, cluster, here
from deltaviz.robots.workspace.shapes import Cuboid

TASK = Task(load_robot("fivebar"), Wish(Cuboid((200.0,), 80.0, 0.0, (0.0,))))
RANGES = Ranges((0, 200), (20, 200), (60, 500), (-700, -80))


@pytest.fixture(scope="module")
def alone() -> Found:
    return search(TASK, RANGES, generations=4)


@pytest.fixture
def address() -> Iterator[str]:
    local: Any = LocalCluster(
        n_workers=2,
        threads_per_worker=1,
        processes=False,
        protocol="tcp",
        host="127.0.0.1",
        dashboard_address="",  # none
    )
    with local:
        yield local.scheduler_address


def test_processes(alone: Found) -> None:
    with here(2) as mapper:
        assert search(TASK, RANGES, generations=4, mapper=mapper) == alone


def test_one_process_is_this_one() -> None:
    with here(1) as mapper:
        assert mapper is map


def test_a_cluster(alone: Found, address: str) -> None:
    assert address.startswith("tcp://127.0.0.1:")
    with cluster(address) as mapper:
        assert search(TASK, RANGES, generations=4, mapper=mapper) == alone


@pytest.mark.parametrize("address", ["tcp://127.0.0.1:9", "nonsense://here"])
def test_no_scheduler(monkeypatch, address: str) -> None:
    monkeypatch.setattr("deltaviz.robots.design.workers.CONNECT_S", 0.5)
    with pytest.raises(NoScheduler, match=address), cluster(address):
        pass
