"""The plug is pulled while the robot moves: whatever breaks, it comes to rest and stays there."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
from collections.abc import Callable
from typing import Any

import pytest
from playwright.sync_api import Page

LONG = 120_000


@pytest.fixture
def jogging(page: Page, served: Any, hold: Callable[..., Any]) -> Page:
    """A page that holds a jog at speed."""
    page.goto(served.url)
    page.locator("#mode", has_text="Idle").wait_for(timeout=LONG)
    hold(page, "ArrowRight", lambda s: s["mode"] == "jogging" and s["xyz_mm"][0] > 5)
    return page


def rests(served: Any) -> dict[str, Any]:
    """The state in which the robot has come to rest, and still is a while later."""
    rest = served.wait(lambda s: s["mode"] == "idle", "rest")
    later = served.wait(lambda s: s["board_time_s"] > rest["board_time_s"] + 0.3, "time passing")
    assert (later["mode"], later["xyz_mm"]) == ("idle", rest["xyz_mm"])
    return rest


@pytest.mark.browser
def test_a_page_that_is_closed_mid_jog(jogging: Page, served: Any) -> None:
    jogging.context.close()
    rests(served)


@pytest.mark.parametrize("cut", ["reset", "silence"])
def test_a_browser_that_vanishes_mid_jog(
    served: Any, page_socket: Callable[[], Any], cut: str
) -> None:
    """Its connection is reset, or stays open and says no more."""
    page = page_socket()
    page.press([100.0, 0.0, 0.0])
    served.wait(lambda s: s["mode"] == "jogging" and s["xyz_mm"][0] > 5, "a jog at speed")
    if cut == "reset":
        page.reset()
    else:
        page.fall_silent()
    assert rests(served)["stop_reason"]


@pytest.mark.browser
def test_a_page_that_hangs_mid_jog(jogging: Page, served: Any) -> None:
    """Its socket stays open; only its heartbeats cease."""
    jogging.evaluate("() => { setTimeout(() => { for (;;); }, 0); }")
    assert rests(served)["stop_reason"]


@pytest.mark.browser
def test_a_page_that_loses_the_focus_mid_jog(jogging: Page, served: Any) -> None:
    """The key stays down; what the browser tells is all that changes."""
    jogging.evaluate(
        "() => { document.hasFocus = () => false; window.dispatchEvent(new Event('blur')); }"
    )
    rests(served)


@pytest.mark.browser
def test_a_page_that_goes_elsewhere_mid_jog(jogging: Page, served: Any) -> None:
    jogging.goto("about:blank")
    rests(served)


@pytest.mark.browser
def test_a_reload_mid_jog_resumes_nothing(jogging: Page, served: Any) -> None:
    jogging.reload()
    jogging.locator("#mode", has_text="Idle").wait_for(timeout=LONG)
    rests(served)


def processes_below(parent: int) -> dict[int, str]:
    """Every process whose ancestor is `parent`, with its command line."""
    children: dict[int, list[int]] = {}
    for name in filter(str.isdecimal, os.listdir("/proc")):
        try:
            with open(f"/proc/{name}/stat") as stat:
                above = int(stat.read().rsplit(")", 1)[1].split()[1])
        except OSError:
            continue
        children.setdefault(above, []).append(int(name))
    found: dict[int, str] = {}
    todo = [parent]
    while todo:
        for child in children.get(todo.pop(), []):
            found[child] = ""
            todo.append(child)
    return found


def gone(pid: int) -> bool:
    """Whether a process has ended (a zombie has)."""
    try:
        with open(f"/proc/{pid}/stat") as stat:
            return stat.read().rsplit(")", 1)[1].split()[0] == "Z"
    except OSError:
        return True


def start_moving(serve: Callable[..., Any]) -> tuple[Any, dict[int, str]]:
    """A server whose robot is in the middle of a move, and the processes below it."""
    served = serve()
    served.wait(lambda s: s["mode"] == "idle", "the start")
    below = processes_below(served.process.pid)
    assert len(below) >= 2, "a controller and a board"
    assert served.post("/api/move", {"xyz_mm": [100, 0, -300], "speed": 0.3}) == 202
    served.wait(lambda s: s["mode"] == "moving", "the move")
    return served, below


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT, signal.SIGKILL])
def test_the_server_is_ended_mid_move(
    serve: Callable[..., Any], wait_for: Callable[..., Any], number: signal.Signals
) -> None:
    served, below = start_moving(serve)
    served.process.send_signal(number)
    status = served.process.wait(timeout=20)
    assert status == (-number if number is signal.SIGKILL else 0)
    wait_for(
        lambda: [pid for pid in below if not gone(pid)], lambda left: not left, "no process left"
    )


def test_ctrl_c_in_a_terminal_goes_to_every_process(
    serve: Callable[..., Any], wait_for: Callable[..., Any]
) -> None:
    served, below = start_moving(serve)
    os.killpg(served.process.pid, signal.SIGINT)
    assert served.process.wait(timeout=20) == 0
    wait_for(
        lambda: [pid for pid in below if not gone(pid)], lambda left: not left, "no process left"
    )
    assert "Traceback" not in (served.process.stdout.read() if served.process.stdout else "")


def test_the_controller_dies_mid_move(
    serve: Callable[..., Any], wait_for: Callable[..., Any]
) -> None:
    """The page says what happened; the server itself answers on."""
    served, below = start_moving(serve)
    for pid in below:
        os.kill(pid, signal.SIGKILL)
    state = served.wait(lambda s: s["mode"] == "offline", "the loss")
    assert state["link"]["problem"]
    assert served.post("/api/stop") in (200, 202)
    assert served.post("/api/move", {"xyz_mm": [0, 0, -300], "speed": 0.3}) == 409


def test_a_port_that_is_taken(serve: Callable[..., Any]) -> None:
    served = serve()
    port = served.url.rsplit(":", 1)[1]
    second = subprocess.run(
        [sys.executable, "-m", "deltaviz", "--port", port, "--no-browser"],
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert second.returncode == 1
    assert port in second.stderr
    assert "in use" in second.stderr
    assert "Traceback" not in second.stderr
    assert served.state()["mode"] in ("idle", "offline")


def test_nothing_but_loopback_is_listened_on(serve: Callable[..., Any]) -> None:
    served = serve()
    port = int(served.url.rsplit(":", 1)[1])
    with open("/proc/net/tcp") as table:
        sockets = [line.split() for line in table.readlines()[1:]]
    listening = {s[1] for s in sockets if s[3] == "0A" and s[1].endswith(f":{port:04X}")}
    assert listening == {f"0100007F:{port:04X}"}
    with pytest.raises(ConnectionRefusedError):
        socket.create_connection(("127.0.0.2", port), timeout=1)
