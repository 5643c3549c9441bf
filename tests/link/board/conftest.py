"""Benches with boards of every make."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from deltaviz.link.messages import Configure
from tests.firmware.c_board import CBoard
from tests.link.board.bench import Bench, MakeBoard, PythonBoard, gantry, top_acceleration


@pytest.fixture(params=[1000, 2**32 - 4000], ids=["counter", "counter wraps"])
def tick(request: pytest.FixtureRequest) -> int:
    """The board's tick at power-up: in the open, and 20 ms before it wraps."""
    return int(request.param)


@pytest.fixture(params=[PythonBoard, CBoard], ids=["simulated", "firmware"])
def make_board(request: pytest.FixtureRequest) -> MakeBoard:
    return request.param


@pytest.fixture
def make_bench(tick: int, make_board: MakeBoard) -> Callable[..., Bench]:
    def make(configure: Configure | None = None, **options: Any) -> Bench:
        options = {"now": tick, "make_board": make_board} | options
        return Bench(configure or gantry(), **options)

    return make


@pytest.fixture
def bench(make_bench: Callable[..., Bench]) -> Bench:
    """Two joints, homed at the ready pose, at rest."""
    return make_bench()


@pytest.fixture
def make_configure() -> Callable[..., Configure]:
    return gantry


@pytest.fixture
def accelerations() -> Callable[..., float]:
    return top_acceleration
