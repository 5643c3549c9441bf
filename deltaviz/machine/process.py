"""The machine's process: the control loop around the controller, its pipes and its link.

Started by `MachineClient` with the descriptors of two sockets: stops, which are read before all
else, and talk (intents in; answers and snapshots out). End of file on either, or SIGTERM, brings
the robot to rest and ends the process.
"""

from __future__ import annotations

import contextlib
import gc
import os
import signal
import socket
import sys
import threading
import time
import traceback
from collections.abc import Callable, Generator
from concurrent.futures import Future
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from functools import partial
from importlib.metadata import version
from multiprocessing.connection import wait
from pathlib import Path
from typing import Any

from deltaviz.link.capture.writer import CaptureWriter
from deltaviz.link.configuration import check_configurable
from deltaviz.link.links import Links
from deltaviz.link.tap import untapped
from deltaviz.link.transport import Transport
from deltaviz.link.urls import open_link
from deltaviz.machine import intent as i
from deltaviz.machine.controller import Controller
from deltaviz.machine.drive import warm_up
from deltaviz.machine.frames import FrameReader, FrameWriter
from deltaviz.machine.known_robots import KnownRobots
from deltaviz.machine.link_keeper import LinkKeeper
from deltaviz.machine.loop_stats import Periods
from deltaviz.machine.opener import ThreadOpener
from deltaviz.machine.transitions import MOVING
from deltaviz.machine.wire import (
    BEGINS_MOTION,
    LOADING,
    STOPPED_SINCE,
    Answered,
    Driven,
    Failed,
    Halt,
    Posted,
    Setup,
    StatsRequest,
)
from deltaviz.robots import Robot
from deltaviz.robots.load import Loaded, load_with_text

MOVING_WAIT = 0.002  # s
IDLE_WAIT = 0.020
SNAPSHOT_PERIOD = 0.012  # s while something changes
SNAPSHOT_IDLE = 0.100
REST_WITHIN = 1.2  # s for coming to rest at the end; then the board's own lease has to do
NICE = -10


@dataclass(frozen=True, slots=True)
class Choice:
    """Another robot, while it is loaded."""

    posted: Posted
    intent: i.SelectRobot
    loading: Future[Loaded]


class Process:
    """One machine, until its parent is gone."""

    def __init__(
        self, *, stops: socket.socket, talk: socket.socket, reader: FrameReader, setup: Setup
    ) -> None:
        self._stop_socket, self._talk_socket = stops, talk
        self._stops = FrameReader(stops)
        self._talk_in = reader
        self._talk_out = FrameWriter(talk)
        self._links = Links(setup.link)
        self._read: str | None = None  # the text of a robot that the parent has to be told
        self._sources = setup.robots
        self._choice: Choice | None = None
        self._controller = Controller(
            self._take(load(self._sources[setup.robot])),
            robot_id=setup.robot,
            robots=dict.fromkeys(self._sources, self._chosen),
            link=self._links.given.id,
            robot_of=KnownRobots(setup.robots).name_of,
        )
        self._keeper = LinkKeeper(
            self._controller, open_link=self._open_link, opener=ThreadOpener()
        )
        self._stopped_after = 0
        self._ends: float | None = None  # when it ends at the latest
        self.told_to_end = False  # by a signal, which may come in the middle of anything
        self._capture: CaptureWriter | None = None
        self._changed = True
        self._pictured = float("-inf")
        self._shown: object = None
        self._periods = Periods()
        self._ticked: float | None = None

    def capture_to(self, path: Path, about: dict[str, str]) -> None:
        """Record what passes on the link. Raises CaptureError."""
        self._capture = CaptureWriter(path, about)

    def _end(self, reason: str) -> None:
        """Brake; once at rest, `run` returns."""
        if self._ends is None:
            now = time.monotonic()
            self._ends = now + REST_WITHIN
            self._controller.stop(reason, now)

    def run(self) -> None:
        try:
            while not self._over():
                self._turn()
                if not self._controller.hungry(time.monotonic()):
                    self._wait()
        finally:
            self._keeper.close()
            if self._capture is not None:
                self._capture.close()

    def tell_failure(self, problem: str) -> None:
        """The last words to the parent, after an error."""
        self._keeper.close()
        self._talk_out.send(Failed(problem))

    def _over(self) -> bool:
        if self._ends is None:
            return False
        return self._controller.at_rest or time.monotonic() >= self._ends

    def _turn(self) -> None:
        if self.told_to_end:
            self._end("The machine was told to end.")
        self._read_stops()
        self._keeper.receive(time.monotonic())  # first: intents may begin a motion on its news
        self._read_intents()
        self._choose()
        now = time.monotonic()
        moving = self._controller.mode in MOVING
        if moving and self._ticked is not None:
            self._periods.add(now - self._ticked)
        self._ticked = now if moving else None
        self._keeper.send(self._controller.tick(now))
        if self._ends is None and self._keeper.follow():
            self._changed = True
        self._show(now)

    def _read_stops(self) -> None:
        for halt in self._stops.read():
            self._halt(halt)
        if self._stops.closed:
            self._end("The program that ran the robot is gone.")

    def _halt(self, halt: Halt) -> None:
        now = time.monotonic()
        self._stopped_after = max(self._stopped_after, halt.after)
        if isinstance(halt.what, i.EStop):
            self._controller.estop(halt.what.reason, now)
        else:
            self._controller.stop(halt.what.reason, now)
        self._changed = True

    def _read_intents(self) -> None:
        for posted in self._talk_in.read():
            self._read_stops()  # one that came while these were taken goes first
            if not self._begins_choice(posted):
                self._reply(posted, self._answer(posted))
        if self._talk_in.closed:
            self._end("The program that ran the robot is gone.")

    def _reply(self, posted: Posted, answer: Any) -> None:
        self._talk_out.send(Answered(posted.number, answer))
        self._changed = True

    def _begins_choice(self, posted: Posted) -> bool:
        """Another robot is loaded beside the loop: compiling takes seconds, and a stop waits for
        nothing. Meanwhile nothing begins to move."""
        what = posted.what
        if not isinstance(what, i.SelectRobot) or self._choice is not None:
            return False
        source = self._sources.get(what.robot)
        if source is None or self._controller.objection(what) is not None:
            return False
        self._choice = Choice(posted, what, begin(partial(load, source)))
        return True

    def _choose(self) -> None:
        if self._choice is not None and self._choice.loading.done() and self._ends is None:
            answer = self._controller.handle(self._choice.intent, time.monotonic())
            posted, self._choice = self._choice.posted, None
            self._reply(posted, answer)

    def _chosen(self) -> Robot:
        """Raises RobotFileError."""
        assert self._choice is not None
        return self._take(self._choice.loading.result())

    def _take(self, loaded: Loaded) -> Robot:
        self._read = loaded.text
        return loaded.robot

    def _answer(self, posted: Posted) -> Any:
        what = posted.what
        if isinstance(what, StatsRequest):
            stats = self._periods.stats(
                underruns=self._controller.snapshot(time.monotonic()).underruns
            )
            self._periods.reset()
            return stats
        if isinstance(what, BEGINS_MOTION) and (
            posted.number <= self._stopped_after or self._ends is not None
        ):
            return STOPPED_SINCE
        if self._choice is not None and isinstance(what, (*BEGINS_MOTION, i.SelectRobot)):
            return LOADING
        return self._controller.handle(what, time.monotonic())

    def _open_link(self, link: str, robot: Robot) -> Transport:
        tap = untapped if self._capture is None else partial(self._capture.tap, link)
        return open_link(self._links.url(link), robot, tap)

    def _show(self, now: float) -> None:
        """Tell the parent what there is to see; if it is slow, only the newest."""
        self._talk_out.pump()
        moving = self._controller.mode in MOVING
        due = SNAPSHOT_PERIOD if moving or self._changed else SNAPSHOT_IDLE
        if now - self._pictured < due:
            return
        snapshot = self._controller.snapshot(now)
        if self._capture is not None:
            snapshot = replace(snapshot, capture=self._capture.status)
        shown = (snapshot.mode, snapshot.counts, snapshot.link.connected, snapshot.holder)
        self._changed = shown != self._shown  # show what follows a change soon, too
        self._shown = shown
        self._pictured = now
        if self._read is not None:
            self._talk_out.send(Driven(self._read))
            self._read = None
        self._talk_out.send_newest(snapshot)

    def _wait(self) -> None:
        sources: list[Any] = [self._stop_socket, self._talk_socket]
        if self._ends is not None:
            sources = []  # at their end these would be readable all the time
        transport = self._keeper.transport
        if transport is not None and transport.fileno() >= 0:
            sources.append(transport)
        timeout = MOVING_WAIT if self._controller.mode in MOVING else IDLE_WAIT
        if self._ends is not None:
            timeout = MOVING_WAIT
        if sources:
            wait(sources, timeout)
        else:
            time.sleep(timeout)


def load(source: str) -> Loaded:
    """The robot, with all compiled that the loop will call. Compiling takes its turn."""
    loaded = load_with_text(source)
    check_configurable(loaded.robot)
    with _in_turn():
        warm_up(loaded.robot)
    return loaded


def begin(work: Callable[[], Loaded]) -> Future[Loaded]:
    """In a thread that keeps nothing from ending."""
    future: Future[Loaded] = Future()

    def run() -> None:
        try:
            future.set_result(work())
        except BaseException as error:
            future.set_exception(error)

    threading.Thread(target=run, name="loader", daemon=True).start()
    return future


def main() -> int:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is the parent's to act on
    stops, talk = (socket.socket(fileno=int(argument)) for argument in sys.argv[1:3])
    reader = FrameReader(talk)
    setup = _read_setup(talk, reader)
    process = None
    try:
        process = Process(stops=stops, talk=talk, reader=reader, setup=setup)
        signal.signal(signal.SIGTERM, partial(_tell_to_end, process))
        gc.collect()
        gc.freeze()
        _come_first()
        if setup.capture is not None:
            process.capture_to(Path(setup.capture), _about(setup))
        process.run()
    except Exception as error:
        traceback.print_exc()
        if process is not None:
            process.tell_failure(f"{type(error).__name__}: {error}")
        return 1
    return 0


def _about(setup: Setup) -> dict[str, str]:
    return {
        "program": f"deltaviz {version('deltaviz')}",
        "started": datetime.now(UTC).isoformat(timespec="milliseconds"),
        "robot": setup.robot,
    }


def _come_first() -> None:
    """Run before what is merely busy, where that is allowed; after all compiling is done."""
    with contextlib.suppress(OSError, AttributeError):  # not everywhere, nor to everyone
        os.setpriority(os.PRIO_PROCESS, 0, NICE)
    with contextlib.suppress(OSError, AttributeError):
        os.sched_setscheduler(0, os.SCHED_RR, os.sched_param(1))


@contextlib.contextmanager
def _in_turn() -> Generator[None]:
    """Like any other process for a while: what takes seconds must not come first."""
    if not hasattr(os, "sched_getscheduler") or os.sched_getscheduler(0) != os.SCHED_RR:
        yield
        return
    os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))
    try:
        yield
    finally:
        _come_first()


def _tell_to_end(process: Process, *_: object) -> None:
    process.told_to_end = True


def _read_setup(talk: socket.socket, reader: FrameReader) -> Setup:
    while True:
        wait([talk], 1.0)
        setup = reader.read_one()
        if setup is not None:
            return setup
        if reader.closed:
            raise SystemExit(0)  # the parent was gone before it began


if __name__ == "__main__":
    sys.exit(main())
