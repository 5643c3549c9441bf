"""The program as a user starts it, and a real browser in front of it."""

from __future__ import annotations

import contextlib
import io
import json
import math
import re
import signal
import socket
import struct
import subprocess
import sys
import threading
import time
import urllib.error
import urllib.request
from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Browser, Page
from websockets.sync.client import connect

T = TypeVar("T")

EXPECTED = 8.0  # s; for what mostly takes less than one
TRIES = 12  # of a press that the page may break off by itself
LONG = 120_000  # ms; software rendering is slow
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
        """Whether a state fulfils the condition while one would still expect it to."""
        end = time.monotonic() + EXPECTED
        rested = 0
        while rested < 100 and time.monotonic() < end:
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


@pytest.fixture(scope="session", autouse=True)
def _compiled() -> None:
    """The kernels are compiled once a machine: no test is to wait for that."""
    program = (
        "from deltaviz import load_robot; from deltaviz.machine.drive import warm_up;"
        "warm_up(load_robot('stm32')); warm_up(load_robot('fivebar'))"
    )
    subprocess.run([sys.executable, "-c", program], check=True)


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


@pytest.fixture(scope="package")
def long_running() -> Iterator[Served]:
    """One server for all tests that leave it as healthy as they found it."""
    served = start_server()
    yield served
    served.end()


@pytest.fixture
def served_on(long_running: Served) -> Served:
    """The same server again, with the robot and the board as at first."""
    wait_for(
        lambda: long_running.post("/api/robot", {"robot": "stm32"}),
        lambda status: status == 200,
        "the robot of the start",
    )
    long_running.wait(lambda s: s["robot"] == "stm32" and s["mode"] == "idle", "the start")
    return long_running


class Watcher:
    """Another client, which sees every state that the server sends, as it comes."""

    def __init__(self, url: str) -> None:
        self._socket = connect(f"ws{url.removeprefix('http')}/ws", max_queue=None)
        self._seen: deque[tuple[float, list[float]]] = deque(maxlen=8)

    def now(self) -> float:
        return time.monotonic()

    def forget_until(self, board_time: float) -> None:
        """Read on to the first state after `board_time`: what came while nobody looked is past."""
        self._seen.clear()
        while self._next()[0] <= board_time:
            pass

    def until_cruising(self, speed: float) -> bool:
        """Three measures in a row within 5 % of the speed (mm/s); False if it rests before."""
        right, began = 0, False
        while right < 3:
            now = self._speed()
            if began and now == 0.0:
                return False
            began = began or now > 0.1 * speed
            right = right + 1 if abs(now - speed) < 0.05 * speed else 0
        return True

    def until_slower_than(self, speed: float) -> float:
        """When (s, monotonic) the robot was first seen slower than `speed`."""
        while self._speed() >= speed:
            pass
        return self.now()

    def _speed(self) -> float:
        """Of the reported tip, over the last 20 ms of board time at least."""
        end = self.now() + PATIENCE
        while self.now() < end:
            self._seen.append(self._next())
            for board_time, xyz in reversed(self._seen):
                if (passed := self._seen[-1][0] - board_time) >= 0.02:
                    return math.dist(xyz, self._seen[-1][1]) / passed
        raise AssertionError("the board's time stands still")

    def _next(self) -> tuple[float, list[float]]:
        """Board time (s) and pose of the next state."""
        while True:
            state = json.loads(self._socket.recv(timeout=PATIENCE))
            if state.get("type") == "state" and state["board_time_s"] is not None:
                return state["board_time_s"], state["xyz_mm"]

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
        self._presses = 0
        self._let_go = threading.Event()
        self._hand: threading.Thread | None = None

    def press(self, velocity: list[float]) -> None:
        """Hold a jog (mm/s), with its signs of life, until `let_go` or `fall_silent`."""
        self._presses += 1
        self._let_go.clear()
        press = f"press-{self._presses}"
        self._send(type="jog_start", id=press, frame="base", v_mm_s=velocity)
        self._hand = threading.Thread(target=self._beat, args=(press, velocity), daemon=True)
        self._hand.start()

    def _beat(self, press: str, velocity: list[float]) -> None:
        seq = 0
        while not self._let_go.wait(0.05):
            seq += 1
            now = 1e3 * time.monotonic()
            self._send(type="jog", id=press, seq=seq, t_ms=now, v_mm_s=velocity)

    def fall_silent(self) -> None:
        """No more signs of life; the socket stays open."""
        self._let_go.set()
        if self._hand is not None:
            self._hand.join()

    def let_go(self) -> None:
        self.fall_silent()
        self._send(type="jog_end", id=f"press-{self._presses}")

    def _send(self, **message: Any) -> None:
        self._socket.send(json.dumps(message))

    def reset(self) -> None:
        """As when the computer is switched off: no closing words."""
        self.fall_silent()
        raw = self._socket.socket
        raw.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        raw.close()

    def close(self) -> None:
        self._let_go.set()
        self._socket.close()


FLOOD = """
import sys
from websockets.sync.client import connect
message = '{"type": "jog", "id": "flood", "seq": 1, "t_ms": 0, "v_mm_s": [300, 0, 0]}'
socket = connect(sys.argv[1], max_queue=None)
while True:
    socket.send(message)
"""


@pytest.fixture
def flood(served: Served) -> Iterator[None]:
    """A client that says well-formed things as fast as its socket takes them."""
    url = f"ws{served.url.removeprefix('http')}/ws"
    with subprocess.Popen([sys.executable, "-c", FLOOD, url], stderr=subprocess.DEVNULL) as client:
        yield
        assert client.poll() is None, "the flood ended before the test"
        client.kill()


@pytest.fixture
def page_socket(served: Served) -> Iterator[Callable[[], PageSocket]]:
    served.wait(lambda s: s["mode"] == "idle", "the start")
    speakers: list[PageSocket] = []

    def speak() -> PageSocket:
        speakers.append(PageSocket(served.url))
        return speakers[-1]

    yield speak
    for speaker in speakers:
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


@pytest.fixture
def console(page: Page, served: Any) -> Page:
    """The page, with the robot drawn and viser's panel filled."""
    page.goto(served.url)
    page.locator("#mode", has_text="Idle").wait_for(timeout=LONG)
    page.frame_locator("#scene").get_by_role("slider", name="θ1").wait_for(timeout=LONG)
    return page


def effector_on_page(page: Page) -> tuple[float, float] | None:
    """The middle of the blue effector, as a person would find it: by looking."""
    box = page.locator("#scene").bounding_box()
    assert box is not None
    left = 300  # right of viser's panel
    picture = page.screenshot(
        clip={
            "x": box["x"] + left,
            "y": box["y"],
            "width": box["width"] - left,
            "height": box["height"],
        }
    )
    red, green, blue = np.moveaxis(np.asarray(Image.open(io.BytesIO(picture)).convert("RGB")), 2, 0)
    red, green, blue = (c.astype(int) for c in (red, green, blue))
    strong = (blue - red > 90) & (blue > 110) & (green > red)
    if strong.sum() < 200:
        return None
    y, x = np.nonzero(strong)
    return box["x"] + left + float(np.median(x)), box["y"] + float(np.median(y))


@pytest.fixture
def drag(console: Page, served: Any, wait_for: Callable[..., Any]) -> Callable[..., None]:
    """Press on the effector and move it by pixels, until the robot does what is wanted.

    A page that cannot keep up with drawing may break its own drag off, and rightly; then the
    effector is grabbed afresh, as a person would.
    """

    def drag_until(
        dx: float, dy: float, condition: Callable[[dict[str, Any]], bool], *, let_go: bool = False
    ) -> None:
        for _ in range(TRIES):
            x, y = wait_for(lambda: effector_on_page(console), bool, "an effector on the screen")
            console.mouse.move(x, y)
            console.mouse.down()
            console.mouse.move(x + dx / 8, y + dy / 8)
            if served.soon(lambda s: s["mode"] == "jogging"):
                console.mouse.move(x + dx, y + dy, steps=4)
                if let_go:
                    console.mouse.up()
                if served.soon(condition):
                    return
            console.mouse.up()
            served.wait(lambda s: s["mode"] == "idle", "rest before the next grab")
        raise AssertionError(f"the drag does not do what is wanted: {served.state()}")

    return drag_until
