"""The program as a user starts it, and a real browser in front of it."""

from __future__ import annotations

import contextlib
import json
import math
import re
import signal
import socket
import struct
import subprocess
import sys
import time
import urllib.error
import urllib.request
from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, TypeVar

import pytest
from playwright.sync_api import Browser, Page
from websockets.sync.client import connect

T = TypeVar("T")

TRIES = 12  # of a press that the page may break off by itself
PATIENCE = 60.0  # s; a condition that has not come true by then never will


@dataclass
class Served:
    """A running `deltaviz serve`, reached as any program would reach it."""

    process: subprocess.Popen[str]
    url: str

    def get(self, path: str) -> Any:
        with urllib.request.urlopen(f"{self.url}{path}", timeout=PATIENCE) as reply:
            return json.load(reply)

    def post(self, path: str, body: dict[str, Any] | None = None) -> int:
        """The HTTP status of a POST."""
        request = urllib.request.Request(
            f"{self.url}{path}",
            data=json.dumps(body or {}).encode(),
            headers={"content-type": "application/json"},
            method="POST",
        )
        try:
            with urllib.request.urlopen(request, timeout=PATIENCE) as reply:
                return reply.status
        except urllib.error.HTTPError as error:
            return error.code

    def state(self) -> dict[str, Any]:
        return self.get("/api/state")

    def wait(self, condition: Callable[[dict[str, Any]], bool], what: str) -> dict[str, Any]:
        """The first state that fulfils the condition."""
        return wait_for(self.state, condition, what)

    def soon(self, condition: Callable[[dict[str, Any]], bool]) -> bool:
        """Whether a state fulfils the condition before the robot has rested for a while again."""
        rested = 0
        while rested < 100:
            state = self.state()
            if condition(state):
                return True
            rested = rested + 1 if state["mode"] == "idle" else 0
            time.sleep(0.01)
        return False

    def end(self) -> None:
        self.process.send_signal(signal.SIGTERM)
        try:
            self.process.wait(timeout=20)
        except subprocess.TimeoutExpired:
            self.process.kill()
            raise


def wait_for(look: Callable[[], T], condition: Callable[[T], bool], what: str) -> T:
    """Look until what is seen fulfils the condition; polling is not synchronising by sleep."""
    end = time.monotonic() + PATIENCE
    while True:
        seen = look()
        if condition(seen):
            return seen
        if time.monotonic() > end:
            raise AssertionError(f"{what}: not within {PATIENCE:g} s; last seen: {seen}")
        time.sleep(0.01)


def start_server(*arguments: str) -> Served:
    """`deltaviz serve` on a port the system chooses."""
    process = subprocess.Popen(
        [sys.executable, "-m", "deltaviz", "serve", "--port", "0", "--no-browser", *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        start_new_session=True,
    )
    assert process.stdout is not None
    lines: list[str] = []
    for line in process.stdout:
        lines.append(line)
        if found := re.search(r"http://[\d.:]+", line):
            return Served(process, found[0])
    raise AssertionError(f"the server did not start: {''.join(lines)}")


@pytest.fixture
def serve() -> Iterator[Callable[..., Served]]:
    """Start servers that end with the test."""
    running: list[Served] = []

    def start(*arguments: str) -> Served:
        running.append(start_server(*arguments))
        return running[-1]

    yield start
    for served in running:
        if served.process.poll() is None:
            served.end()


@pytest.fixture
def served(serve: Callable[..., Served]) -> Served:
    return serve()


class Watcher:
    """Another client, which sees every state that the server sends, as it comes."""

    def __init__(self, url: str) -> None:
        self._socket = connect(f"ws{url.removeprefix('http')}/ws", max_queue=None)
        self._seen: deque[tuple[float, list[float]]] = deque(maxlen=8)

    def now(self) -> float:
        return time.monotonic()

    def until_cruising(self) -> float:
        """The speed (mm/s) once it no longer grows: three equal measures of a moving robot."""
        speeds: deque[float] = deque(maxlen=3)
        while True:
            speeds.append(self._speed())
            if len(speeds) == 3 and min(speeds) > 50 and max(speeds) < 1.05 * min(speeds):
                return min(speeds)

    def until_slower_than(self, speed: float) -> float:
        """When (s, monotonic) the robot was first seen slower than `speed`."""
        while self._speed() >= speed:
            pass
        return self.now()

    def _speed(self) -> float:
        """Of the reported tip, over the last 20 ms of board time at least."""
        end = self.now() + PATIENCE
        while self.now() < end:
            state = json.loads(self._socket.recv(timeout=PATIENCE))
            if state.get("type") != "state" or state["board_time_s"] is None:
                continue
            self._seen.append((state["board_time_s"], state["xyz_mm"]))
            for board_time, xyz in reversed(self._seen):
                if (passed := self._seen[-1][0] - board_time) >= 0.02:
                    return math.dist(xyz, self._seen[-1][1]) / passed
        raise AssertionError("the board's time stands still")

    def close(self) -> None:
        self._socket.close()


@pytest.fixture
def watch(served: Served) -> Iterator[Callable[[], Watcher]]:
    watchers: list[Watcher] = []

    def start() -> Watcher:
        watchers.append(Watcher(served.url))
        return watchers[-1]

    yield start
    for watcher in watchers:
        watcher.close()


class PageSocket:
    """What a page says on its socket while it jogs, without a page."""

    def __init__(self, url: str) -> None:
        self._socket = connect(f"ws{url.removeprefix('http')}/ws", max_queue=None)

    def jog_until(self, condition: Callable[[dict[str, Any]], bool]) -> None:
        """Hold a jog towards +X until a state fulfils the condition; then say no more."""
        self._send(type="jog_start", id="press", frame="base", v_mm_s=[100, 0, 0])
        end = time.monotonic() + PATIENCE
        seq = 0
        while time.monotonic() < end:
            seq += 1
            now = time.monotonic()
            self._send(type="jog", id="press", seq=seq, t_ms=1e3 * now, v_mm_s=[100, 0, 0])
            while time.monotonic() < now + 0.05:
                message = json.loads(self._socket.recv(timeout=PATIENCE))
                if message["type"] == "state" and condition(message):
                    return
        raise AssertionError("the jog did not begin")

    def _send(self, **message: Any) -> None:
        self._socket.send(json.dumps(message))

    def reset(self) -> None:
        """As when the computer is switched off: no closing words."""
        raw = self._socket.socket
        raw.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        raw.close()

    def close(self) -> None:
        self._socket.close()


@pytest.fixture
def page_socket(served: Served) -> Iterator[PageSocket]:
    served.wait(lambda s: s["mode"] == "idle", "the start")
    speaker = PageSocket(served.url)
    yield speaker
    with contextlib.suppress(OSError):
        speaker.close()


@pytest.fixture
def hold(served: Served) -> Callable[..., None]:
    """Hold a key until the robot does what is wanted.

    A page that cannot keep up with drawing may break its own jog off, and rightly; then the key
    is pressed afresh, as a person would.
    """

    def hold_key(page: Page, key: str, condition: Callable[[dict[str, Any]], bool]) -> None:
        for _ in range(TRIES):
            page.keyboard.down(key)
            if served.soon(condition):
                return
            page.keyboard.up(key)
            served.wait(lambda s: s["mode"] == "idle", "rest before the next press")
        raise AssertionError(f"{key} does not jog as wanted: {served.state()}")

    return hold_key


@pytest.fixture(name="wait_for")
def wait_for_fixture() -> Callable[..., Any]:
    return wait_for


@pytest.fixture
def page(browser: Browser) -> Iterator[Page]:
    context = browser.new_context(viewport={"width": 1280, "height": 800})
    yield context.new_page()
    context.close()
