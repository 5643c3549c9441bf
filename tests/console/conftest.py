"""The console in a real Chromium, before a small server that the tests play the machine with."""

from __future__ import annotations

import asyncio
import json
import threading
import time
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any

import pytest
import uvicorn
from playwright.sync_api import Browser, BrowserContext, Page
from playwright.sync_api import Error as PlaywrightError
from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import HTMLResponse, JSONResponse, Response
from starlette.routing import Mount, Route, WebSocketRoute
from starlette.staticfiles import StaticFiles
from starlette.websockets import WebSocket, WebSocketDisconnect

from tests.console.answers import PORTS, READY, ROBOT, SHAPES, VIEW

STATIC = Path(__file__).parents[2] / "static"
CSP = (
    "default-src 'self'; script-src 'self'; style-src 'self'; img-src 'self' data:;"
    " connect-src 'self'; frame-src 'self'; frame-ancestors 'none'; base-uri 'none';"
    " form-action 'none'"
)
SCENE = """<!doctype html><title>scene</title>
<style>html,body{height:100%;margin:0}#slider{position:absolute;left:8px;top:40px}</style>
<canvas id="canvas" tabindex="0" style="width:100%;height:100%;background:#ccd"></canvas>
<input id="box" style="position:absolute;left:8px;top:8px;width:60px">
<div id="slider" role="slider" tabindex="0">slider</div>
<script>
window.heard = [];
for (const type of ["keydown", "keyup"])
  window.addEventListener(type, (e) => window.heard.push(type + " " + e.code));
</script>"""

# A page that gets no time for longer than the lease has rightly let go of everything.
NAP_MS = 120
WATCH_FOR_NAPS = """(() => {
  let last = performance.now();
  window.longestNap = 0;
  setInterval(() => {
    const now = performance.now();
    window.longestNap = Math.max(window.longestNap, now - last - 20);
    last = now;
  }, 20);
})()"""


class PageSlept(Exception):
    """The test says nothing: its page was not given the time to do what was asked of it."""


class Machine:
    """The server's side of the page: sends the state given, keeps what the page says."""

    loop: asyncio.AbstractEventLoop

    def __init__(self) -> None:
        self.lock = threading.Lock()
        self.reset()
        routes = [
            WebSocketRoute("/ws", self._socket),
            Route("/scene/", self._scene),
            Route("/api/{path:path}", self._api, methods=["GET", "POST"]),
            Mount("/", StaticFiles(directory=STATIC, html=True)),
        ]
        self.app = Starlette(routes=routes)
        self.sockets: set[WebSocket] = set()

    def reset(self) -> None:
        with self.lock:
            self.state = json.loads(json.dumps(READY))
            self.robot = json.loads(json.dumps(ROBOT))
            self.ports = list(PORTS)
            self.view: list[dict[str, Any]] | None = json.loads(json.dumps(VIEW))
            self.heard: list[dict[str, Any]] = []
            self.posts: list[tuple[str, Any]] = []
            self.refusals: dict[str, tuple[int, str]] = {}
            self.accepts = True  # sockets
            self.obeys = True  # jogs when told to
            self.silent = False

    def become(self, shape: str) -> None:
        """Another robot, before a page is opened: a key of SHAPES."""
        state, robot = json.loads(json.dumps(SHAPES[shape]))
        limits = self.robot["limits"]["joint"]
        joints = robot["joints"]
        for name, values in limits.items():
            limits[name] = (values * 2)[:joints]
        if shape == "tool":
            limits["velocity_deg_s"][-1] = 600
        self.robot.update(robot)
        self.set(**state)

    def set(self, **fields: Any) -> None:
        with self.lock:
            self.state.update(fields)

    def set_link(self, **fields: Any) -> None:
        """Unless it is ready nothing is known of a board."""
        with self.lock:
            link = self.state["link"]
            link.update(fields)
            if link["phase"] != "ready":
                link.update(connected=False, age_ms=None, board=None, round_trip_ms=None)
                link.update(queued=0, queue_places=0)
                self.state.update(mode="offline", homed=False)

    def messages(self, *types: str) -> list[dict[str, Any]]:
        with self.lock:
            return [m for m in self.heard if not types or m["type"] in types]

    def posted(self, path: str) -> list[Any]:
        with self.lock:
            return [body for p, body in self.posts if p == path]

    def forget(self) -> None:
        with self.lock:
            self.heard.clear()
            self.posts.clear()

    def say(self, message: dict[str, Any]) -> None:
        """Sends a message of its own to every page."""
        for socket in list(self.sockets):
            asyncio.run_coroutine_threadsafe(socket.send_json(message), self.loop).result(5)

    def show(self, key: str, **fields: Any) -> None:
        """Changes an item of the view, and tells it."""
        (item,) = (item for item in self.view or [] if item["key"] == key)
        item.update(fields)
        self.say({"type": "view", "items": self.view})

    def cut(self) -> None:
        """Closes every page's socket."""
        for socket in list(self.sockets):
            asyncio.run_coroutine_threadsafe(socket.close(1001), self.loop).result(5)

    async def _socket(self, socket: WebSocket) -> None:
        if not self.accepts:
            await socket.close()
            return
        await socket.accept()
        self.sockets.add(socket)
        await socket.send_json({"type": "view", "items": self.view})
        sender = asyncio.create_task(self._send_states(socket))
        try:
            while True:
                message = await socket.receive_json()
                with self.lock:
                    self.heard.append(message)
                    self._obey(message["type"])
        except (WebSocketDisconnect, RuntimeError):
            pass
        finally:
            self.sockets.discard(socket)
            sender.cancel()

    def _obey(self, kind: str) -> None:
        mode = self.state["mode"]
        if self.obeys and kind == "jog_start" and mode in ("idle", "unhomed"):
            self.state["mode"] = "jogging"
        elif kind == "jog_end" and mode == "jogging":
            self.state["mode"] = "idle" if self.state["homed"] else "unhomed"

    async def _send_states(self, socket: WebSocket) -> None:
        while True:
            with self.lock:
                state = None if self.silent else {"type": "state", **self.state}
            if state is not None:
                await socket.send_json(state)
            await asyncio.sleep(1 / 30)

    async def _api(self, request: Request) -> Response:
        path = request.path_params["path"]
        if request.method == "GET":
            return JSONResponse({"robot": self.robot, "ports": self.ports}[path])
        body = await request.body()
        with self.lock:
            self.posts.append((path, json.loads(body) if body else None))
            status, detail = self.refusals.get(path, (202, ""))
        return JSONResponse({"detail": detail}, status)

    async def scene(self, _request: Request) -> Response:
        return HTMLResponse(SCENE)

    async def _scene(self, request: Request) -> Response:
        return await self.scene(request)


async def _with_policy(app: Any, scope: Any, receive: Any, send: Any) -> None:
    async def guarded(message: Any) -> None:
        if message["type"] == "http.response.start" and not scope["path"].startswith("/scene"):
            message["headers"].append((b"content-security-policy", CSP.encode()))
        await send(message)

    await app(scope, receive, guarded)


@pytest.fixture(scope="session")
def served() -> Iterator[tuple[Machine, str]]:
    machine = Machine()

    async def app(scope: Any, receive: Any, send: Any) -> None:
        await _with_policy(machine.app, scope, receive, send)

    config = uvicorn.Config(app, host="127.0.0.1", port=0, log_level="error", lifespan="off")
    server = uvicorn.Server(config)

    async def run() -> None:
        machine.loop = asyncio.get_running_loop()
        await server.serve()

    thread = threading.Thread(target=asyncio.run, args=(run(),), daemon=True)
    thread.start()
    until(lambda: server.started)
    port = server.servers[0].sockets[0].getsockname()[1]
    yield machine, f"http://127.0.0.1:{port}"
    server.should_exit = True
    thread.join(10)


def until(condition: Callable[[], Any], seconds: float = 10.0) -> Any:
    """Waits for something that is bound to happen, and gives it."""
    end = time.monotonic() + seconds
    while not (found := condition()):
        if time.monotonic() > end:
            raise AssertionError(f"did not happen within {seconds} s")
        time.sleep(0.005)
    return found


@pytest.fixture
def wait_until() -> Callable[..., Any]:
    return until


@pytest.fixture
def machine(served: tuple[Machine, str]) -> Machine:
    served[0].reset()
    return served[0]


@pytest.fixture
def url(served: tuple[Machine, str]) -> str:
    return served[1]


@pytest.fixture(scope="module")
def context(browser: Browser) -> Callable[..., BrowserContext]:
    """One context for each set of options: making one takes longer than most tests."""

    @cache
    def make(**options: Any) -> BrowserContext:
        return browser.new_context(**options)

    return make


@pytest.fixture
def pages() -> list[Page]:
    """The pages that the test has open."""
    return []


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item: pytest.Item) -> Any:
    """A failure on a page that slept is a PageSlept, for which pytest runs the test again."""
    try:
        return (yield)
    except AssertionError as error:
        naps = [nap_ms(page) for page in getattr(item, "funcargs", {}).get("pages", [])]
        if max(naps, default=0) > NAP_MS:
            raise PageSlept(f"for {max(naps):.0f} ms") from error
        raise


def nap_ms(page: Page) -> float:
    """The longest time for which the page's main thread did not run, since it was loaded."""
    try:
        return page.evaluate("window.longestNap ?? 0")
    except PlaywrightError:  # closed by the test
        return 0.0


@pytest.fixture
def open_page(
    context: Callable[..., BrowserContext], machine: Machine, url: str, pages: list[Page]
) -> Iterator[Callable[..., Page]]:
    """Opens the console, connected and drawn; fails the test on any error on the page."""
    errors: list[str] = []

    def keep_violation(text: str) -> None:
        if "Content Security" in text:
            errors.append(text)

    def open_(width: int = 1280, height: int = 800, **options: Any) -> Page:
        page = context(**options).new_page()
        page.set_viewport_size({"width": width, "height": height})
        pages.append(page)
        page.on("pageerror", lambda error: errors.append(str(error)))
        page.on("console", lambda message: keep_violation(message.text))
        page.add_init_script(WATCH_FOR_NAPS)
        page.goto(url + "/")
        page.wait_for_selector("#pad button")
        until(lambda: page.evaluate("!document.querySelector('#control').disabled"))
        page.wait_for_selector("#sliders input", state="attached")
        page.frame_locator("#scene").locator("body").wait_for()
        page.bring_to_front()
        until(lambda: page.evaluate("document.hasFocus()"))
        page.evaluate("window.longestNap = 0")  # what it took to start is no concern of a test
        return page

    yield open_
    for page in pages:
        page.evaluate("localStorage.clear()")
        page.close()
    assert errors == []
