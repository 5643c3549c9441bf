"""Another robot takes seconds to compile: meanwhile the loop goes on, and stops are heard."""

from __future__ import annotations

import socket
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from dataclasses import dataclass
from typing import Any

import pytest

from deltaviz.machine import intent as i
from deltaviz.machine import process as module
from deltaviz.machine.frames import FrameReader, FrameWriter
from deltaviz.machine.mode import Mode
from deltaviz.machine.process import Process
from deltaviz.machine.wire import LOADING, Answered, Halt, Posted, Setup
from deltaviz.robots.load import Loaded, load_with_text

ME = "me"
PATIENCE = 60.0  # s; only how long a hopeless test waits


@dataclass
class Bench:
    """A machine's process in this one, turned by hand, and a load that ends when it is told to."""

    process: Process
    stops: FrameWriter
    talk: FrameWriter
    answers: FrameReader
    compiled: threading.Event
    loading: list[Future[Loaded]]
    posted: int = 0

    def post(self, *intents: i.Intent) -> list[int]:
        """Their numbers."""
        first = self.posted + 1
        for intent in intents:
            self.posted += 1
            self.talk.send(Posted(self.posted, intent))
        return list(range(first, self.posted + 1))

    def turn(self) -> dict[int, Any]:
        """What was answered in it."""
        self.process._turn()
        return {m.number: m.answer for m in self.answers.read() if isinstance(m, Answered)}

    def turn_until(self, holds: Callable[[], bool]) -> None:
        deadline = time.monotonic() + PATIENCE
        while not holds():
            assert time.monotonic() < deadline
            self.turn()

    @property
    def mode(self) -> Mode:
        return self.process._controller.mode


@pytest.fixture
def bench(monkeypatch: pytest.MonkeyPatch) -> Iterator[Bench]:
    compiled = threading.Event()
    loading: list[Future[Loaded]] = []
    begin = module.begin

    def load(source: str) -> Loaded:
        if source != "stm32":
            assert compiled.wait(PATIENCE)
        return load_with_text(source)

    def noted(work: Callable[[], Loaded]) -> Future[Loaded]:
        loading.append(begin(work))
        return loading[-1]

    monkeypatch.setattr(module, "load", load)
    monkeypatch.setattr(module, "begin", noted)
    (stops, far_stops), (talk, far_talk) = socket.socketpair(), socket.socketpair()
    setup = Setup("stm32", {"stm32": "stm32", "fivebar": "fivebar"}, "sim://?homed=0")
    process = Process(stops=far_stops, talk=far_talk, reader=FrameReader(far_talk), setup=setup)
    yield Bench(
        process, FrameWriter(stops), FrameWriter(talk), FrameReader(talk), compiled, loading
    )
    compiled.set()
    process._keeper.close()
    for end in (stops, far_stops, talk, far_talk):
        end.close()


def test_an_estop_is_heard_while_another_robot_is_loaded(bench: Bench) -> None:
    bench.turn_until(lambda: bench.mode is Mode.DISABLED)
    (chosen,) = bench.post(i.SelectRobot(ME, "fivebar"))
    assert bench.turn() == {}
    bench.stops.send(Halt(bench.posted, i.EStop(ME, "E-stop was pressed")))
    bench.turn()
    assert bench.mode is Mode.ESTOP
    assert not bench.loading[0].done()
    bench.compiled.set()
    bench.loading[0].result(PATIENCE)
    assert bench.turn() == {chosen: i.Accepted()}
    assert bench.process._controller.robot.name == "fivebar"


def test_nothing_begins_to_move_and_no_third_robot_is_chosen_meanwhile(bench: Bench) -> None:
    bench.turn_until(lambda: bench.mode is Mode.DISABLED)
    (chosen,) = bench.post(i.SelectRobot(ME, "fivebar"))
    enabled, third = bench.post(i.Enable(ME), i.SelectRobot(ME, "stm32"))
    assert bench.turn() == {enabled: LOADING, third: LOADING}
    assert bench.mode is Mode.DISABLED
    bench.compiled.set()
    bench.loading[0].result(PATIENCE)
    assert bench.turn() == {chosen: i.Accepted()}
    assert len(bench.loading) == 1


def test_what_may_not_be_chosen_is_not_loaded(bench: Bench) -> None:
    bench.turn_until(lambda: bench.mode is Mode.DISABLED)
    bench.post(i.RequestControl("another"))
    bench.turn()
    refused, unknown = bench.post(i.SelectRobot(ME, "fivebar"), i.SelectRobot("another", "none"))
    answers = bench.turn()
    assert isinstance(answers[refused], i.Refused)
    assert isinstance(answers[unknown], i.Refused)
    assert "There is no robot 'none'" in answers[unknown].detail
    assert bench.loading == []
