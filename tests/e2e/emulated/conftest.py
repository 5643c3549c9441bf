"""The whole program in front of the real firmware: one emulated board and, as long as none is
killed, one server for all tests here. Each test finds the robot homed and at rest.
"""

from __future__ import annotations

import contextlib
import os
import re
import signal
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from deltaviz import load_robot
from deltaviz.robots import Robot
from deltaviz.robots.presets import preset_text
from tests.e2e.conftest import Served, start_server
from tests.emulator.hosted_board import HostedBoard

QUICK = {"fast_deg_s": 90, "slow_deg_s": 5, "backoff_deg": 1}  # homes in two seconds, not ten


@pytest.fixture(scope="package")
def robot_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The stm32 preset, quick to home, and with one motor reversed."""
    text = preset_text("stm32")
    for key, value in QUICK.items():
        text, count = re.subn(rf"(?m)^{key} = .*$", f"{key} = {value}", text)
        assert count == 1
    text = text.replace("invert = [false, false, false]", "invert = [false, true, false]")
    file = tmp_path_factory.mktemp("robot") / "bench.toml"
    file.write_text(text.replace('name = "stm32"', 'name = "bench"'))
    return file


@pytest.fixture(scope="package")
def robot(robot_file: Path) -> Robot:
    return load_robot(str(robot_file))


@pytest.fixture(scope="package")
def board(robot: Robot) -> Iterator[HostedBoard]:
    board = HostedBoard(robot)
    yield board
    board.close()


class Host:
    """`deltaviz serve`, which may be frozen, or killed with all of its processes."""

    def __init__(self, robot_file: Path, link: str) -> None:
        self._arguments = ("--robot", str(robot_file), "--link", link)
        self.served: Served | None = None

    def running(self) -> Served:
        if self.served is None or self.served.process.poll() is not None:
            self.served = start_server(*self._arguments)
        return self.served

    def kill(self) -> None:
        self._signal(signal.SIGKILL)
        assert self.served is not None
        self.served.process.wait()

    @contextlib.contextmanager
    def frozen(self) -> Iterator[None]:
        self._signal(signal.SIGSTOP)
        try:
            yield
        finally:
            self._signal(signal.SIGCONT)

    def _signal(self, number: signal.Signals) -> None:
        """To all of its processes at once: they are a group."""
        assert self.served is not None
        os.killpg(self.served.process.pid, number)

    def end(self) -> None:
        if self.served is not None and self.served.process.poll() is None:
            self.served.end()


@pytest.fixture(scope="package")
def host(robot_file: Path, board: HostedBoard) -> Iterator[Host]:
    host = Host(robot_file, board.wire.url)
    yield host
    host.end()


@pytest.fixture
def served(host: Host) -> Served:
    """Connected, enabled, homed and at rest, whatever the test before has left."""
    served = host.running()
    make_ready(served)
    return served


STEPS = {
    "offline": ("connect", {"link": "socket"}),
    "estop": ("reset", {}),
    "fault": ("reset", {}),
    "disabled": ("enable", {}),
    "unhomed": ("home", {}),
}


def is_waiting(state: dict[str, Any]) -> bool:
    """For somebody to do something."""
    if state["mode"] == "offline":
        return state["link"]["phase"] == "closed"
    return state["mode"] in {*STEPS, "idle"}


def make_ready(served: Served) -> None:
    for _ in range(6):
        mode = served.wait(is_waiting, "rest")["mode"]
        if mode == "idle":
            return
        call, body = STEPS[mode]
        assert served.post(f"/api/{call}", body) in (200, 202)
        served.wait(lambda s, mode=mode: s["mode"] != mode, f"what comes of {call}")
    raise AssertionError(f"the robot does not become ready: {served.state()}")


@pytest.fixture
def move(served: Served, board: HostedBoard) -> Callable[..., None]:
    """Into a long move of all joints at an even speed, and some way on."""

    def begin() -> None:
        target = -30.0 if served.state()["theta_deg"][0] > 15 else 60.0
        body = {"theta_deg": [target] * 3, "speed": 0.3}
        assert served.post("/api/move", body) == 202
        board.wire.until(lambda: board.wire.telemetry.moving, "the motion")
        board.wire.let_pass(0.15)
        assert board.wire.telemetry.moving, "the move is over already"

    return begin
