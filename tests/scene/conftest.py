"""A machine that does at once what it is asked, a web app on a free port, a browser."""

from __future__ import annotations

import asyncio
import contextlib
import dataclasses
import socket
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest
import uvicorn
import viser
import zstandard
from fastapi import FastAPI
from websockets.sync.client import ClientConnection, connect

from deltaviz.link.links import Link
from deltaviz.machine.intent import (
    Accepted,
    Answer,
    DragTo,
    FollowAngles,
    FollowPoint,
    Intent,
    RefusalKind,
    Refused,
)
from deltaviz.machine.mode import Mode
from deltaviz.machine.snapshot import LinkPhase, LinkStatus, Snapshot
from deltaviz.mechanism import RotaryDelta
from deltaviz.robots import Robot, load_robot, preset_names
from deltaviz.robots.coordinates import in_robot
from deltaviz.robots.load import Loaded
from deltaviz.robots.presets import preset_text
from deltaviz.scene.listener import open_listener
from deltaviz.scene.view import Scene


class FakeMachine:
    """Takes every intent (or refuses every one) and is at once where it was told to be."""

    def __init__(self, robot: Robot) -> None:
        self._first = self._loaded_of(robot)
        self.begin_anew()

    def begin_anew(self) -> None:
        self.loaded = self._first
        self.posted: list[Intent] = []
        self.refusal: str | None = None
        self.holder: str | None = None
        self.follows = True
        self.snapshot = self._at(self.middle)

    @property
    def middle(self) -> tuple[float, ...]:
        """On the z axis, half way down the workspace."""
        return in_robot(self.robot, (0.0, 0.0, sum(self.robot.zone.z) / 2))

    def _at(self, xyz: tuple[float, ...], **changes: Any) -> Snapshot:
        theta = tuple(float(angle) for angle in self.robot.inverse(xyz))
        zeros = (0.0,) * len(theta)
        snapshot = Snapshot(
            at=time.monotonic(),
            robot=self.robot.name,
            mode=Mode.IDLE,
            homed=True,
            theta=theta,
            xyz=xyz,
            theta_speed=zeros,
            xyz_speed=(0.0,) * len(xyz),
            command_theta=theta,
            command_xyz=xyz,
            target_theta=theta,
            target_xyz=xyz,
            margins=(1.0,) * len(theta),
            held_by=(),
            link=LinkStatus(id="sim", phase=LinkPhase.READY, age=0.0),
            holder=self.holder,
            stop_reason=None,
            fault=None,
            override=1.0,
            next_step=None,
            board_time=0.0,
            underruns=0,
            counts=None,
        )
        return dataclasses.replace(snapshot, **changes)

    def be_at(self, xyz: tuple[float, ...], **changes: Any) -> None:
        self.snapshot = self._at(xyz, **changes)

    def be_held_by(self, holder: str | None) -> None:
        self.holder = holder
        self.snapshot = dataclasses.replace(self.snapshot, holder=holder)

    @property
    def robot(self) -> Robot:
        return self.loaded.robot

    @staticmethod
    def _loaded_of(robot: Robot) -> Loaded:
        """Of a robot that no file describes, with that of a preset."""
        known = robot.name if robot.name in preset_names() else "stm32"
        return Loaded(robot, preset_text(known))

    def become(self, robot: Robot) -> None:
        self.loaded = self._loaded_of(robot)
        self.be_at(self.middle)

    def of(self, kind: type) -> list[Any]:
        return [intent for intent in self.posted if isinstance(intent, kind)]

    def links(self) -> tuple[Link, ...]:
        return (Link("sim", "sim://", "Simulated board"), Link("ttyusb0", "/dev/ttyUSB0", "A port"))

    def post(self, intent: Intent) -> Future[Answer]:
        self.posted.append(intent)
        answer: Future[Answer] = Future()
        if self.refusal is not None:
            answer.set_result(Refused(kind=RefusalKind.MODE, detail=self.refusal))
            return answer
        if self.follows and isinstance(intent, DragTo | FollowPoint):
            self.be_at(intent.xyz)
        if self.follows and isinstance(intent, FollowAngles):
            self.be_at(tuple(self.robot.forward(intent.theta).tolist()), theta=intent.theta)
        answer.set_result(Accepted())
        return answer

    def stop(self, client: str, reason: str) -> None:
        raise AssertionError("the scene has no stop")

    def estop(self, client: str, reason: str) -> None:
        raise AssertionError("the scene has no stop")


@dataclasses.dataclass
class Stand:
    """A scene served to browsers."""

    machine: FakeMachine
    scene: Scene
    port: int

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self.port}/scene/"

    @property
    def server(self) -> viser.ViserServer:
        return self.scene._listener.server

    def draw(self, poses: Iterator[None]) -> None:
        """Draw a frame at each step of `poses`, in the thread that draws."""

        async def frames() -> None:
            for _ in poses:
                self.scene._frame()

        asyncio.run_coroutine_threadsafe(frames(), self.server.get_event_loop()).result(60.0)

    def eventually(self, holds: Callable[[], Any], within: float = 60.0) -> Any:
        return eventually(holds, within)


def eventually(holds: Callable[[], Any], within: float = 60.0) -> Any:
    """Wait for something to become true, and say what it became."""
    deadline = time.monotonic() + within
    while not (value := holds()):
        assert time.monotonic() < deadline, "it did not happen"
        time.sleep(0.01)
    return value


class Visitor:
    """A browser's connection to the scene, spoken by hand."""

    def __init__(self, port: int, session: str | None) -> None:
        headers = {"Cookie": f"session={session}"} if session else {}
        self.socket: ClientConnection = connect(
            f"ws://127.0.0.1:{port}/scene",
            subprotocols=[f"viser-v{viser.__version__}"],  # type: ignore[list-item]
            additional_headers=headers,
            max_size=None,
            compression=None,
            close_timeout=0.2,
        )
        self.inputs: dict[str, str] = {}
        self.seen: list[dict[str, Any]] = []

    def send(self, **message: Any) -> None:
        self.socket.send(msgspec.msgpack.encode(message))

    def look(self) -> None:
        """The first camera message, by which viser counts a browser as there."""
        self.send(**CAMERA)

    def read(self, until: Callable[[dict[str, Any]], bool], within: float = 10.0) -> dict[str, Any]:
        """The next message for which `until` is true."""
        deadline = time.monotonic() + within
        while True:
            while self.seen:
                if until(message := self.seen.pop(0)):
                    return message
            data = self.socket.recv(timeout=max(deadline - time.monotonic(), 0.0))
            assert isinstance(data, bytes)
            self.seen += (messages := spoken(data))
            for message in messages:
                if label := message.get("props", {}).get("label"):
                    self.inputs[label] = message["uuid"]

    def input(self, label: str) -> str:
        """The uuid of the input with this label."""
        if label not in self.inputs:
            self.read(lambda _: label in self.inputs)
        return self.inputs[label]

    def closed(self, within: float = 5.0) -> tuple[int, str]:
        """Wait until the server closes the connection; its code and reason."""
        deadline = time.monotonic() + within
        try:
            while True:
                self.socket.recv(timeout=max(deadline - time.monotonic(), 0.0))
        except TimeoutError:
            raise AssertionError("the connection stayed open") from None
        except Exception:
            code, reason = self.socket.protocol.close_code, self.socket.protocol.close_reason
            return code or 0, reason or ""


def spoken(data: bytes) -> list[dict[str, Any]]:
    """The messages in one of viser's frames; meshes have their arrays, of one dimension."""
    end = 16 + int.from_bytes(data[8:16], "little")
    plain = zstandard.ZstdDecompressor().decompress(data[16:end])
    content = msgspec.msgpack.decode(plain)
    buffers: list[bytes] = []
    for length in content["binaryBufferLengths"]:
        start = -(-end // 8) * 8
        buffers.append(data[start : (end := start + length)])
    for message in content["messages"]:
        props = message.get("props", {})
        for name, value in props.items():
            if isinstance(value, dict) and "__binary_index" in value:
                props[name] = np.frombuffer(buffers[value["__binary_index"]], value["dtype"])
    return content["messages"]


CAMERA: dict[str, Any] = {
    "type": "ViewerCameraMessage",
    "wxyz": [1, 0, 0, 0],
    "position": [0.9, -1.1, 0.3],
    "fov": 0.7,
    "near": 0.01,
    "far": 1000,
    "image_height": 752,
    "image_width": 648,
    "look_at": [0, 0, -0.2],
    "up_direction": [0, 0, 1],
}

DRAG: dict[str, Any] = {
    "type": "SceneNodeDragMessage",
    "phase": "start",
    "name": "/robot/effector/plate",
    "instance_index": None,
    "start_position": [0, 0, -0.3],
    "start_screen_pos": [0.5, 0.5],
    "end_position": [0, 0, -0.3],
    "end_screen_pos": [0.5, 0.5],
    "button": "left",
    "modifier": None,
    "owner": "",
}


@pytest.fixture
def camera_message() -> dict[str, Any]:
    return dict(CAMERA)


@pytest.fixture
def drag_message() -> dict[str, Any]:
    return dict(DRAG)


@pytest.fixture
def robot() -> Robot:
    return load_robot("stm32")


@pytest.fixture
def other_robot(robot: Robot) -> Robot:
    """Of another size, with arms elsewhere."""
    mechanism = RotaryDelta(
        base_radius=60, effector_radius=32, upper_arm=63, forearm=268, azimuths_deg=(-90, 30, 150)
    )
    zone = dataclasses.replace(robot.zone, z=(-290.0, -230.0), radius=120.0)
    return dataclasses.replace(robot, name="other", mechanism=mechanism, zone=zone)


@pytest.fixture(scope="session")
def planar_robot() -> Robot:
    return load_robot("fivebar")


@pytest.fixture(scope="session")
def tool_robot() -> Robot:
    """The preset stm32 with a tool that turns."""
    return load_robot(Path(__file__).parents[2] / "docs" / "examples" / "stm32-tool.toml")


@contextlib.contextmanager
def standing(robot: Robot) -> Iterator[Stand]:
    """A scene of its own, served on a free port."""
    machine = FakeMachine(robot)
    scene = Scene(machine)
    scene.start()
    app = FastAPI()
    app.include_router(
        scene.router(
            session_of=lambda connection: connection.cookies.get("session"),
            holds_control=lambda session: machine.snapshot.holder == session,
        )
    )
    listening = socket.create_server(("127.0.0.1", 0))
    server = uvicorn.Server(uvicorn.Config(app, log_level="warning", lifespan="off"))
    thread = threading.Thread(target=server.run, kwargs={"sockets": [listening]}, daemon=True)
    thread.start()
    eventually(lambda: server.started)
    try:
        yield Stand(machine=machine, scene=scene, port=listening.getsockname()[1])
    finally:
        server.should_exit = server.force_exit = True
        thread.join(5.0)
        scene.close()


@pytest.fixture(scope="module")
def shared_stand() -> Iterator[Stand]:
    with standing(load_robot("stm32")) as stand:
        yield stand


@pytest.fixture
def stand(shared_stand: Stand) -> Stand:
    """The module's scene, with nobody there and the machine as it was at first."""
    shared_stand.eventually(lambda: not shared_stand.server.get_clients())
    shared_stand.machine.begin_anew()
    return shared_stand


@pytest.fixture
def own_stand(robot: Robot) -> Iterator[Stand]:
    """A scene of the test's own, for tests that leave it changed."""
    with standing(robot) as stand:
        yield stand


@contextlib.contextmanager
def visiting(stand: Stand) -> Iterator[Callable[[str | None], Visitor]]:
    with contextlib.ExitStack() as visitors:

        def arrive(session: str | None) -> Visitor:
            visitor = Visitor(stand.port, session)
            visitors.callback(visitor.socket.close)
            return visitor

        yield arrive


@pytest.fixture
def visit(stand: Stand) -> Iterator[Callable[[str | None], Visitor]]:
    with visiting(stand) as arrive:
        yield arrive


@pytest.fixture
def visit_own(own_stand: Stand) -> Iterator[Callable[[str | None], Visitor]]:
    with visiting(own_stand) as arrive:
        yield arrive


@pytest.fixture(scope="module")
def scene_api() -> Iterator[viser.SceneApi]:
    """viser's nodes, without anything of ours."""
    listener = open_listener()
    yield listener.server.scene
    listener.close()


@pytest.fixture
def stand_in(robot: Robot) -> FakeMachine:
    """A machine without a scene."""
    return FakeMachine(robot)


@pytest.fixture
def steady() -> np.random.Generator:
    return np.random.default_rng(20)
