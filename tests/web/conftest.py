"""A machine and a scene that record what they are asked, behind the real web application."""

from __future__ import annotations

import asyncio
import dataclasses
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from pathlib import Path
from typing import Any

import httpx
import pytest
from fastapi import APIRouter, FastAPI, WebSocket
from fastapi.responses import HTMLResponse
from fastapi.testclient import TestClient
from starlette.requests import HTTPConnection
from websockets.sync.client import ClientConnection, connect

from deltaviz.link.links import Link
from deltaviz.machine.intent import Accepted, Answer, Intent
from deltaviz.machine.mode import Mode
from deltaviz.machine.snapshot import LinkPhase, LinkStatus, Snapshot
from deltaviz.robots import Robot, load_robot
from deltaviz.robots.load import Loaded
from deltaviz.scene.items import AnyItem
from deltaviz.web.app import create_app
from deltaviz.web.listening import listen
from deltaviz.web.origin import allowed_hosts
from deltaviz.web.server import Server

PORT = 8000
ORIGIN = f"http://127.0.0.1:{PORT}"
PATIENCE = 20.0  # s; what has not happened by then never will


def snapshot_of(robot: Robot) -> Snapshot:
    """Idle at the ready pose."""
    theta = robot.homing.ready
    xyz = tuple(robot.forward(theta).tolist())
    rest = (0.0,) * robot.joint_count
    return Snapshot(
        at=time.monotonic(),
        robot=robot.name,
        mode=Mode.IDLE,
        homed=True,
        theta=theta,
        xyz=xyz,
        theta_speed=rest,
        xyz_speed=(0.0,) * len(xyz),
        command_theta=theta,
        command_xyz=xyz,
        target_theta=None,
        target_xyz=None,
        margins=(1.0,) * robot.joint_count,
        held_by=(),
        link=LinkStatus(id="sim", phase=LinkPhase.READY, age=0.002),
        holder=None,
        stop_reason=None,
        fault=None,
        override=1.0,
        next_step=None,
        board_time=1.0,
        underruns=0,
        counts=(0,) * robot.joint_count,
    )


class FakeMachine:
    """Keeps, in order, what it is told: intents as they are, stops as ("stop", client)."""

    def __init__(self, robot: Robot) -> None:
        self.robot = robot
        self.reset()

    def reset(self) -> None:
        self.snapshot = snapshot_of(self.robot)
        self.told: list[Any] = []
        self.answer: Answer | Exception | None = Accepted()  # None: it never answers

    @property
    def loaded(self) -> Loaded:
        return Loaded(self.robot, "")

    def links(self) -> tuple[Link, ...]:
        return (Link("sim", "sim://", "Simulated board"), Link("ttyusb0", "/dev/ttyUSB0", "A port"))

    def post(self, intent: Intent) -> Future[Answer]:
        self.told.append(intent)
        future: Future[Answer] = Future()
        if isinstance(self.answer, Exception):
            future.set_exception(self.answer)
        elif self.answer is not None:
            future.set_result(self.answer)
        return future

    def stop(self, client: str, reason: str) -> None:
        self.told.append(("stop", client))

    def estop(self, client: str, reason: str) -> None:
        self.told.append(("estop", client))

    def show(self, **changes: Any) -> None:
        self.snapshot = dataclasses.replace(self.snapshot, **changes)

    def told_of(self, kind: type) -> list[Any]:
        return [told for told in self.told if isinstance(told, kind)]


class FakeScene:
    def __init__(self) -> None:
        self.yaw: float | None = None
        self.themes: list[tuple[str, bool]] = []
        self.shown: dict[str, tuple[AnyItem, ...]] = {}
        self.chosen: list[tuple[str, str, object]] = []
        self.refusal: str | None = None
        self.visitors: list[str | None] = []
        self.holds_control: Callable[[str], bool] = lambda session: False

    def router(
        self,
        *,
        session_of: Callable[[HTTPConnection], str | None],
        holds_control: Callable[[str], bool],
    ) -> APIRouter:
        self.holds_control = holds_control
        router = APIRouter()

        @router.get("/scene/")
        async def page() -> HTMLResponse:
            return HTMLResponse("scene", headers={"Content-Security-Policy": "sandbox"})

        @router.websocket("/scene")
        async def socket(websocket: WebSocket) -> None:
            self.visitors.append(session_of(websocket))
            await websocket.accept()
            await websocket.close()

        return router

    def camera_yaw(self, session: str) -> float | None:
        return self.yaw

    def set_theme(self, session: str, dark: bool) -> None:
        self.themes.append((session, dark))

    def items(self, session: str) -> tuple[AnyItem, ...] | None:
        return self.shown.get(session)

    def choose(self, session: str, key: str, value: object, refused: Callable[[str], None]) -> None:
        self.chosen.append((session, key, value))
        if self.refusal is not None:
            refused(self.refusal)


@pytest.fixture(scope="session")
def robot() -> Robot:
    return load_robot("stm32")


@pytest.fixture(scope="session")
def the_machine(robot: Robot) -> FakeMachine:
    return FakeMachine(robot)


@pytest.fixture(scope="session")
def the_app(the_machine: FakeMachine, static: Path) -> FastAPI:
    """One application for many tests: building it takes longer than most of them."""
    return _app(the_machine, FakeScene(), static)


@pytest.fixture
def machine(the_machine: FakeMachine) -> FakeMachine:
    the_machine.reset()
    return the_machine


@pytest.fixture
def scene() -> FakeScene:
    return FakeScene()


@pytest.fixture(scope="session")
def static(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("web") / "static"
    folder.mkdir()
    (folder / "index.html").write_text("<!doctype html><title>console</title>")
    (folder / "main.js").write_text("export {};")
    (folder / "notes.txt").write_text("secret")
    (folder / ".hidden").write_text("secret")
    (folder.parent / "secret.txt").write_text("secret")
    return folder


def _app(machine: FakeMachine, scene: FakeScene, static: Path, port: int = PORT) -> FastAPI:
    return create_app(
        machine=machine,
        scene=scene,
        allowed_hosts=allowed_hosts("127.0.0.1", port),
        port=port,
        static_dir=static,
    )


@pytest.fixture
def make_app(robot: Robot, static: Path) -> Callable[..., FastAPI]:
    """For tests that change the application or what it serves."""

    def make(folder: Path = static) -> FastAPI:
        return _app(FakeMachine(robot), FakeScene(), folder)

    return make


@pytest.fixture
def client(the_app: FastAPI, machine: FakeMachine) -> Iterator[TestClient]:
    """A program on this computer: no browser, no cookie."""
    with TestClient(the_app, base_url=ORIGIN) as client:
        yield client


def eventually(look: Callable[[], Any], what: str) -> Any:
    """The first truthy thing seen; polling is not synchronising by sleep."""
    end = time.monotonic() + PATIENCE
    while not (seen := look()):
        assert time.monotonic() < end, f"{what}: not within {PATIENCE:g} s"
        time.sleep(0.002)
    return seen


class Live:
    """The application behind a real server on a port the system chose."""

    def __init__(self, make_app: Callable[[int], FastAPI]) -> None:
        self._socket = listen("127.0.0.1", 0)
        self.port = self._socket.getsockname()[1]
        self.url = f"http://127.0.0.1:{self.port}"
        started = threading.Event()
        self._server = Server(make_app(self.port), started_up=started.set)
        self._thread = threading.Thread(
            target=lambda: asyncio.run(self._server.serve(sockets=[self._socket]))
        )
        self._thread.start()
        assert started.wait(PATIENCE)

    def page(self) -> str:
        """A browser's session: the cookie of a page that was opened."""
        return httpx.get(f"{self.url}/").headers["set-cookie"].split(";")[0]

    def socket(self, cookie: str | None = None, **options: Any) -> ClientConnection:
        headers = {} if cookie is None else {"Cookie": cookie}
        address = f"ws://127.0.0.1:{self.port}/ws"
        options = {"compression": None, "close_timeout": 0.5} | options  # tests leave states unread
        return connect(address, additional_headers=headers, **options)

    def close(self) -> None:
        self._server.should_exit = True
        self._thread.join(PATIENCE)
        assert not self._thread.is_alive()


@pytest.fixture
def live(machine: FakeMachine, scene: FakeScene, static: Path) -> Iterator[Live]:
    server = Live(lambda port: _app(machine, scene, static, port))
    yield server
    server.close()


@pytest.fixture(name="eventually")
def eventually_fixture() -> Callable[[Callable[[], Any], str], Any]:
    return eventually
