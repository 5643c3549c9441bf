"""The whole life of the program, as a user starts and ends it."""

from __future__ import annotations

import contextlib
import os
import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest

from deltaviz.web import serve as serve_module
from deltaviz.web.listening import listen

COMMAND = [sys.executable, "-m", "deltaviz", "serve", "--no-browser", "--port"]
PATIENCE = 60.0  # s


@pytest.fixture
def program() -> Iterator[subprocess.Popen[str]]:
    """A running server in a process group of its own."""
    with subprocess.Popen(
        [*COMMAND, "0"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    ) as process:
        yield process
        if process.poll() is None:
            process.kill()


def descendants(pid: int) -> set[int]:
    found: set[int] = set()
    for children in Path(f"/proc/{pid}/task").glob("*/children"):
        with contextlib.suppress(OSError):
            for child in map(int, children.read_text().split()):
                found |= {child} | descendants(child)
    return found


def is_alive(pid: int) -> bool:
    try:
        state = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0]
    except OSError:
        return False
    return state != "Z"


def address(program: subprocess.Popen[str]) -> str:
    assert program.stdout is not None
    line = program.stdout.readline()
    found = re.search(r"http://[\d.]+:\d+", line)
    assert found, line
    return found[0]


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_it_starts_serves_and_ends_with_all_it_started(
    program: subprocess.Popen[str], number: signal.Signals, eventually: Any
) -> None:
    url = address(program)
    eventually(
        lambda: httpx.get(f"{url}/api/state", timeout=PATIENCE).json()["mode"] == "idle", "idle"
    )
    second = subprocess.run(
        [*COMMAND, url.rsplit(":", 1)[1]], capture_output=True, text=True, timeout=PATIENCE
    )
    assert second.returncode == 1
    assert "in use" in second.stderr
    assert second.stdout == ""

    moving = httpx.post(f"{url}/api/move", json={"theta_deg": [20] * 3, "speed": 0.05})
    assert moving.status_code == 202
    started = descendants(program.pid)
    assert started
    os.killpg(program.pid, number)  # as Ctrl-C does it: every process of the group hears it
    assert program.wait(PATIENCE) == 0
    eventually(lambda: not any(map(is_alive, started)), "the end of all processes")
    assert program.stderr is not None
    assert program.stderr.read() == ""


def test_a_link_that_is_not_there_is_told(tmp_path: Path) -> None:
    ended = subprocess.run(
        [*COMMAND, "0", "--link", "nonsense://"], capture_output=True, text=True, timeout=PATIENCE
    )
    assert ended.returncode in (1, 2)
    assert "nonsense" in ended.stderr
    assert "Traceback" not in ended.stderr


class Ended(BaseException):
    pass


def test_the_first_signal_stops_the_robot_and_the_second_ends_at_once(
    machine: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    timers: list[tuple[Any, ...]] = []

    class Timer:
        def __init__(self, *what: Any) -> None:
            timers.append(what)
            self.daemon = False

        def start(self) -> None:
            assert self.daemon

    def leave(status: int) -> None:
        raise Ended(status)

    monkeypatch.setattr(serve_module.threading, "Timer", Timer)
    monkeypatch.setattr(serve_module.os, "_exit", leave)
    with contextlib.closing(listen("127.0.0.1", 0)) as listener:
        life = serve_module._Life(listener, browser=False)
        life._machine = machine
        life._end()
        assert machine.told == [("stop", "server")]
        assert len(timers) == 1
        assert timers[0][0] < 2.0
        with pytest.raises(Ended):
            life._end()


@pytest.mark.parametrize(
    ("environment", "may"),
    [
        ({}, False),
        ({"DISPLAY": ":0"}, True),
        ({"WAYLAND_DISPLAY": "wayland-0"}, True),
        ({"BROWSER": "firefox"}, True),
        ({"DISPLAY": ""}, False),
    ],
)
def test_no_text_browser_takes_the_terminal(
    monkeypatch: pytest.MonkeyPatch, environment: dict[str, str], may: bool
) -> None:
    monkeypatch.setattr(serve_module.sys, "platform", "linux")
    monkeypatch.setattr(serve_module.os, "environ", environment)
    assert serve_module._has_desktop() is may
