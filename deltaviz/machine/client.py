"""The machine as the surfaces' process sees it: a port to a process of its own."""

from __future__ import annotations

import atexit
import contextlib
import os
import select
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Generator
from concurrent.futures import Future
from dataclasses import replace
from pathlib import Path
from typing import Any, Self

from deltaviz.link.capture.writer import check_capture
from deltaviz.link.configuration import check_configurable
from deltaviz.link.links import Link, Links
from deltaviz.link.urls import check_link
from deltaviz.machine import intent as i
from deltaviz.machine.frames import FrameReader, FrameWriter
from deltaviz.machine.loop_stats import LoopStats
from deltaviz.machine.mode import Mode
from deltaviz.machine.snapshot import LinkPhase, LinkStatus, Snapshot
from deltaviz.machine.wire import (
    Answered,
    Driven,
    Failed,
    FromProcess,
    Halt,
    Posted,
    Setup,
    StatsRequest,
)
from deltaviz.robots import Robot, preset_names
from deltaviz.robots.load import Loaded, load_with_text, parse_robot

ENDED = "The machine's process has ended. Start deltaviz again."


class MachineClient:
    """Starts and ends the machine's process, and implements MachinePort."""

    def __init__(self, process: subprocess.Popen[bytes], *, stops: socket.socket,
                 talk: socket.socket, setup: Setup, loaded: Loaded) -> None:  # fmt: skip
        self._process = process
        self._stop_socket, self._talk_socket = stops, talk
        self._loaded = loaded
        self._links = Links(setup.link)
        self._lock = threading.Lock()
        self._stops = FrameWriter(stops)
        self._talk_out = FrameWriter(talk)
        self._talk_in = FrameReader(talk)
        self._number = 0
        self._waiting: dict[int, Future[i.Answer] | Future[LoopStats]] = {}
        self._problem: str | None = None
        self._closing = False
        self._snapshot = _starting(setup.robot, loaded.robot, link=self._links.given.id)
        self._first = threading.Event()
        self._wake, self._woken = socket.socketpair()
        self._wake.setblocking(False)
        self._woken.setblocking(False)
        self._talk_out.send(setup)
        self._reader = threading.Thread(target=self._read, name="machine", daemon=True)
        self._reader.start()
        atexit.register(self.close)

    @classmethod
    def start(
        cls, *, robot: str = "stm32", link: str = "sim://", capture: Path | None = None
    ) -> Self:
        """Start the process; `ready` waits until it has connected.

        `robot` is a preset's name or a robot file's path; `capture` is written. Raises
        RobotFileError, LinkError and CaptureError before anything is started.
        """
        check_link(link)
        if capture is not None:
            check_capture(capture)
        loaded = load_with_text(robot)
        check_configurable(loaded.robot)
        robots = {name: name for name in preset_names()}
        robot_id = robot if robot in robots else loaded.robot.name
        robots[robot_id] = robot if robot in robots else str(Path(robot).resolve())
        setup = Setup(robot_id, robots, link, None if capture is None else str(capture.resolve()))
        stops, their_stops = socket.socketpair()
        talk, their_talk = socket.socketpair()
        with their_stops, their_talk:
            process = _spawn(their_stops, their_talk)
        return cls(process, stops=stops, talk=talk, setup=setup, loaded=loaded)

    # MachinePort.

    @property
    def snapshot(self) -> Snapshot:
        return self._snapshot

    @property
    def robot(self) -> Robot:
        return self._loaded.robot

    @property
    def loaded(self) -> Loaded:
        return self._loaded

    def links(self) -> tuple[Link, ...]:
        return self._links.list()

    def post(self, intent: i.Intent) -> Future[i.Answer]:
        future: Future[i.Answer] = _answered_for_certain()
        self._post(intent, future)
        return future

    def stop(self, client: str, reason: str) -> None:
        self._halt(i.Stop(client, reason))

    def estop(self, client: str, reason: str) -> None:
        self._halt(i.EStop(client, reason))

    # Its life.

    @property
    def pid(self) -> int:
        return self._process.pid

    def ready(self, timeout: float) -> bool:
        """Wait for the first connection; whether the board is connected."""
        self._first.wait(timeout)
        return self._snapshot.link.connected

    def stats(self) -> Future[LoopStats]:
        """The control loop's periods since the last call."""
        future: Future[LoopStats] = _answered_for_certain()
        self._post(StatsRequest(), future)
        return future

    def close(self, timeout: float = 2.0) -> None:
        """Bring the robot to rest, close its link, end its process. Again: no effect."""
        with self._lock:
            if self._closing:
                return
            self._closing = True
        atexit.unregister(self.close)
        for sock in (self._stop_socket, self._talk_socket):
            with contextlib.suppress(OSError):
                sock.shutdown(socket.SHUT_WR)  # its end of file brakes; it may still answer
        deadline = time.monotonic() + timeout
        for end in (lambda: None, self._process.terminate, self._process.kill):
            end()
            try:
                self._process.wait(max(0.1, deadline - time.monotonic()))
                break
            except subprocess.TimeoutExpired:
                continue
        self._reader.join(1.0)
        for sock in (self._stop_socket, self._talk_socket, self._wake, self._woken):
            sock.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    # Threads: any may post; one reads.

    def _post(
        self, what: i.Intent | StatsRequest, future: Future[i.Answer] | Future[LoopStats]
    ) -> None:
        with self._lock:
            if self._problem is None and not self._closing:
                self._number += 1
                self._waiting[self._number] = future
                self._talk_out.send(Posted(self._number, what))
                self._wake_reader()
                return
        _refuse(future, self._problem or ENDED)

    def _halt(self, what: i.Stop | i.EStop) -> None:
        with self._lock:
            if not self._closing:
                self._stops.send(Halt(self._number, what))
                self._wake_reader()

    def _wake_reader(self) -> None:
        """Let the reader send what the sockets did not take at once."""
        if self._stops.pending or self._talk_out.pending:
            with contextlib.suppress(BlockingIOError):
                self._wake.send(b"!")

    def _read(self) -> None:
        while not self._talk_in.closed:
            with self._lock:
                self._stops.pump()
                self._talk_out.pump()
                full = [
                    sock
                    for sock, writer in (
                        (self._stop_socket, self._stops),
                        (self._talk_socket, self._talk_out),
                    )
                    if writer.pending
                ]
            select.select([self._talk_socket, self._woken], full, [])
            with contextlib.suppress(BlockingIOError):
                self._woken.recv(4096)
            for value in self._talk_in.read():
                self._take(value)
        self._fail(self._problem or ENDED)

    def _take(self, value: FromProcess) -> None:
        match value:
            case Answered():
                with self._lock:
                    future = self._waiting.pop(value.number, None)
                if future is not None:
                    future.set_result(value.answer)  # type: ignore[arg-type]
            case Failed():
                self._problem = f"The machine's process has failed ({value.problem}). " + (
                    "Start deltaviz again."
                )
            case Driven():
                if value.text != self._loaded.text:
                    self._loaded = Loaded(parse_robot(value.text), value.text)
            case Snapshot():
                self._snapshot = value
                if value.link.connected or value.link.problem is not None:
                    self._first.set()

    def _fail(self, problem: str) -> None:
        """The process is gone: say so, and answer whoever still waits."""
        with self._lock:
            self._problem = problem
            waiting = list(self._waiting.values())
            self._waiting.clear()
        self._snapshot = replace(
            _starting(self._snapshot.robot, self._loaded.robot, link=self._snapshot.link.id),
            link=LinkStatus(self._snapshot.link.id, LinkPhase.CLOSED, problem=problem),
            stop_reason=self._snapshot.stop_reason,
            override=self._snapshot.override,
            next_step="Start deltaviz again.",
        )
        self._first.set()
        for future in waiting:
            _refuse(future, problem)


def _answered_for_certain() -> Future[Any]:
    """A future that cannot be cancelled: whoever no longer waits must not trip the reader."""
    future: Future[Any] = Future()
    future.set_running_or_notify_cancel()
    return future


def _refuse(future: Future[i.Answer] | Future[LoopStats], problem: str) -> None:
    future.set_result(i.Refused(i.RefusalKind.MODE, problem))  # type: ignore[arg-type]


def _spawn(stops: socket.socket, talk: socket.socket) -> subprocess.Popen[bytes]:
    descriptors = (stops.fileno(), talk.fileno())
    here = str(Path(__file__).resolve().parents[2])
    inherited = os.environ.get("PYTHONPATH")
    path = f"{here}{os.pathsep}{inherited}" if inherited else here
    with _interrupts_held():
        return subprocess.Popen(
            [sys.executable, "-P", "-m", "deltaviz.machine.process", *map(str, descriptors)],
            pass_fds=descriptors,
            stdin=subprocess.DEVNULL,
            env=os.environ | {"PYTHONPATH": path},
        )


@contextlib.contextmanager
def _interrupts_held() -> Generator[None]:
    """A Ctrl-C while the process starts is not for it: it inherits the mask."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _starting(robot_id: str, robot: Robot, *, link: str) -> Snapshot:
    """What is known before the process says anything: nothing."""
    return Snapshot(
        at=time.monotonic(),
        robot=robot_id,
        mode=Mode.OFFLINE,
        homed=False,
        theta=None,
        xyz=None,
        theta_speed=None,
        xyz_speed=None,
        command_theta=None,
        command_xyz=None,
        target_theta=None,
        target_xyz=None,
        margins=tuple(0.0 for _ in range(robot.joint_count)),
        held_by=(),
        link=LinkStatus(link, LinkPhase.OPENING),
        holder=None,
        stop_reason=None,
        fault=None,
        override=1.0,
        next_step="Starting; the first start takes longer. Wait until the robot is shown.",
        board_time=None,
        underruns=0,
        counts=None,
    )
