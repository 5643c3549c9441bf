"""Links are opened beside the control loop, and what is given up meanwhile is closed again."""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import Future

import pytest

from deltaviz.link.messages import BoardMessage, HostMessage
from deltaviz.link.report import LinkReport
from deltaviz.link.transport import LinkError, Transport
from deltaviz.machine import intent as i
from deltaviz.machine.controller import Controller
from deltaviz.machine.link_keeper import LinkKeeper
from deltaviz.machine.opener import ThreadOpener, abandon
from deltaviz.machine.snapshot import LinkPhase
from deltaviz.robots import Robot

PATIENCE = 20.0  # s
ME = "me"


class FakeTransport:
    """Silent; `problem` ends it."""

    def __init__(self, name: str = "") -> None:
        self.name = name
        self.problem: str | None = None
        self.was_closed = threading.Event()
        self.sent: list[HostMessage] = []
        self.report = LinkReport()

    @property
    def closed(self) -> bool:
        return self.was_closed.is_set() or self.problem is not None

    def send(self, message: HostMessage) -> None:
        self.sent.append(message)

    def receive(self) -> list[BoardMessage]:
        return []

    def fileno(self) -> int:
        return -1

    def close(self) -> None:
        self.was_closed.set()


def test_it_opens_in_a_thread_of_its_own() -> None:
    transport, ready = FakeTransport(), threading.Event()

    def open_() -> Transport:
        assert ready.wait(PATIENCE)
        return transport

    future = ThreadOpener()(open_)
    assert not future.done()
    ready.set()
    assert future.result(PATIENCE) is transport


@pytest.mark.parametrize(
    ("error", "says"),
    [
        (LinkError("In use."), r"^In use\.$"),
        (ValueError("odd"), "cannot be opened .*ValueError: odd"),
    ],
)
def test_why_it_cannot_is_told_as_a_link_error(error: Exception, says: str) -> None:
    def open_() -> Transport:
        raise error

    with pytest.raises(LinkError, match=says):
        ThreadOpener()(open_).result(PATIENCE)


def test_one_after_the_other_so_that_a_port_given_up_is_free_for_the_next() -> None:
    opener, first, go = ThreadOpener(), FakeTransport(), threading.Event()

    def slow() -> Transport:
        assert go.wait(PATIENCE)
        return first

    given_up = opener(slow)
    seen: list[bool] = []

    def next_() -> Transport:
        seen.append(first.was_closed.is_set())
        return FakeTransport()

    following = opener(next_)
    abandon(given_up)
    go.set()
    following.result(PATIENCE)
    assert seen == [True]


class Bench:
    """A controller and its keeper; links open when the test says so."""

    def __init__(self, robot: Robot) -> None:
        self.now = 10.0
        self.openings: list[tuple[str, Future[Transport]]] = []
        self.controller = Controller(
            robot, link="a", robots={"stm32": lambda: robot}, robot_id="stm32"
        )
        self._asked: list[str] = []
        self.keeper = LinkKeeper(self.controller, open_link=self._open, opener=self._opener)
        self.turn()

    def _open(self, link: str, _robot: Robot) -> Transport:
        self._asked.append(link)
        return FakeTransport(link)

    def _opener(self, open_: Callable[[], Transport]) -> Future[Transport]:
        open_()
        future: Future[Transport] = Future()
        future.set_running_or_notify_cancel()
        self.openings.append((self._asked[-1], future))
        return future

    def turn(self) -> None:
        self.now += 0.002
        self.keeper.receive(self.now)
        self.keeper.send(self.controller.tick(self.now))
        self.keeper.follow()

    def do(self, intent: i.Intent) -> None:
        assert self.controller.handle(intent, self.now) == i.Accepted()
        self.turn()

    @property
    def link(self):
        return self.controller.snapshot(self.now).link


@pytest.fixture
def bench(stm32: Robot) -> Bench:
    return Bench(stm32)


def test_while_it_opens_the_loop_goes_on_and_says_so(bench: Bench) -> None:
    for _ in range(100):
        bench.turn()
    assert bench.link.phase is LinkPhase.OPENING
    assert bench.controller.snapshot(bench.now).next_step == "Opening a."
    transport = FakeTransport()
    bench.openings[0][1].set_result(transport)
    bench.turn()
    assert bench.link.phase is LinkPhase.GREETING
    assert transport.sent, "it is greeted"


def test_what_is_given_up_while_it_opens_is_closed_when_it_is_open(bench: Bench) -> None:
    bench.do(i.Disconnect(ME))
    assert bench.link.phase is LinkPhase.CLOSED
    late = FakeTransport()
    bench.openings[0][1].set_result(late)
    bench.turn()
    assert late.was_closed.is_set()
    assert late.sent == []
    assert bench.link.phase is LinkPhase.CLOSED


def test_another_choice_while_it_opens(bench: Bench) -> None:
    bench.do(i.Connect(ME, "b"))
    (first, second) = bench.openings
    assert (first[0], second[0]) == ("a", "b")
    chosen, late = FakeTransport(), FakeTransport()
    second[1].set_result(chosen)
    bench.turn()
    first[1].set_result(late)
    bench.turn()
    assert late.was_closed.is_set()
    assert not chosen.was_closed.is_set()
    assert chosen.sent


def test_a_failure_to_open_is_told_and_can_be_tried_again(bench: Bench) -> None:
    bench.openings[0][1].set_exception(LinkError("It is in use."))
    bench.turn()
    assert bench.link.phase is LinkPhase.CLOSED
    assert bench.link.problem == "It is in use."
    bench.do(i.Connect(ME, "a"))
    assert bench.link.phase is LinkPhase.OPENING
    assert bench.link.problem is None


def test_a_link_that_ends_is_closed_and_its_last_word_is_a_stop(bench: Bench) -> None:
    transport = FakeTransport()
    bench.openings[0][1].set_result(transport)
    bench.turn()
    transport.problem = "It broke."
    bench.turn()
    assert transport.was_closed.is_set()
    assert bench.link.problem == "It broke."
    assert bench.keeper.transport is None
