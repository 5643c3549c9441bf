"""A page that is really hidden: Chromium by its raw protocol, without Playwright's emulation,
which keeps every page visible and focused."""

from __future__ import annotations

import itertools
import json
import subprocess
import urllib.request
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from websockets.sync.client import ClientConnection, connect

CHROMIUM = "/usr/bin/chromium"
ARGS = [
    "--headless=new",
    "--no-sandbox",
    "--no-first-run",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--window-size=1280,900",
    "--remote-debugging-port=0",
]

pytestmark = pytest.mark.browser


class Tab:
    def __init__(self, socket: ClientConnection, target: str) -> None:
        self.socket, self.target = socket, target
        self._ids = itertools.count(1)

    def call(self, method: str, **params: Any) -> Any:
        request = next(self._ids)
        self.socket.send(json.dumps({"id": request, "method": method, "params": params}))
        while True:
            answer = json.loads(self.socket.recv(timeout=20))
            if answer.get("id") == request:
                return answer["result"]

    def evaluate(self, expression: str) -> Any:
        answer = self.call("Runtime.evaluate", expression=expression, returnByValue=True)
        return answer["result"].get("value")

    def press(self, kind: str, x: float, y: float) -> None:
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)

    def key(self, kind: str, code: str) -> None:
        self.call("Input.dispatchKeyEvent", type=kind, code=code, key=code[-1].lower())

    def centre(self, selector: str) -> tuple[float, float]:
        x, y = self.evaluate(
            f"(() => {{ const b = document.querySelector({selector!r}).getBoundingClientRect();"
            " return [b.x + b.width / 2, b.y + b.height / 2]; })()"
        )
        return x, y


class Chromium:
    def __init__(self, port: int) -> None:
        self._base = f"http://127.0.0.1:{port}/json"

    def _get(self, path: str, method: str = "GET") -> Any:
        request = urllib.request.Request(self._base + path, method=method)
        with urllib.request.urlopen(request, timeout=20) as answer:
            return json.loads(answer.read().decode() or "null")

    def tab(self, url: str) -> Tab:
        opened = self._get(f"/new?{url}", "PUT")
        return Tab(connect(opened["webSocketDebuggerUrl"], max_size=None), opened["id"])


@pytest.fixture
def chromium(tmp_path: Path) -> Iterator[Chromium]:
    process = subprocess.Popen(
        [CHROMIUM, *ARGS, f"--user-data-dir={tmp_path}", "about:blank"],
        stderr=subprocess.PIPE,
        text=True,
    )
    assert process.stderr is not None
    line = next(line for line in process.stderr if "DevTools listening" in line)
    yield Chromium(int(line.split(":")[-1].split("/")[0]))
    process.terminate()
    process.wait(20)
    process.stderr.close()


@pytest.fixture
def tab(
    chromium: Chromium, machine: Any, url: str, wait_until: Callable[..., Any]
) -> Iterator[Tab]:
    tab = chromium.tab(url + "/")
    tab.call("Page.enable")
    wait_until(lambda: tab.evaluate("document.querySelectorAll('#sliders input').length > 0"), 30)
    wait_until(lambda: tab.evaluate("!document.querySelector('#control').disabled"))
    assert tab.evaluate("[document.visibilityState, document.hasFocus()]") == ["visible", True]
    machine.set(mode="jogging")
    machine.forget()
    yield tab
    tab.socket.close()


def hide(tab: Tab, chromium: Chromium, wait_until: Callable[..., Any]) -> None:
    chromium.tab("about:blank").socket.close()
    wait_until(lambda: tab.evaluate("document.visibilityState") == "hidden")
    assert tab.evaluate("document.hasFocus()") is False


def test_hiding_the_page_ends_a_held_button(
    tab: Tab, chromium: Chromium, machine: Any, wait_until: Callable[..., Any]
) -> None:
    x, y = tab.centre("#pad [data-area=e]")
    tab.press("mousePressed", x, y)
    wait_until(lambda: len(machine.messages("jog")) >= 2)
    hide(tab, chromium, wait_until)
    wait_until(lambda: machine.messages("jog_end"))
    beats = len(machine.messages("jog"))
    tab.evaluate("1")  # the page still answers, and yet
    assert len(machine.messages("jog")) == beats


def test_hiding_the_page_ends_a_key_held_in_the_frame(
    tab: Tab, chromium: Chromium, machine: Any, wait_until: Callable[..., Any]
) -> None:
    tab.press("mousePressed", 500, 500)
    tab.press("mouseReleased", 500, 500)
    assert tab.evaluate("document.activeElement.id") == "scene"
    assert tab.evaluate("document.hasFocus()") is True  # a click into the frame is no loss
    tab.key("rawKeyDown", "KeyD")
    wait_until(lambda: len(machine.messages("jog")) >= 2)
    hide(tab, chromium, wait_until)
    wait_until(lambda: machine.messages("jog_end"))


def test_hiding_the_page_ends_a_drag(
    tab: Tab, chromium: Chromium, machine: Any, wait_until: Callable[..., Any]
) -> None:
    tab.press("mousePressed", 500, 500)
    wait_until(lambda: len(machine.messages("drag_alive")) >= 2)
    hide(tab, chromium, wait_until)
    tab.evaluate("1")
    count = len(machine.messages("drag_alive"))
    for _ in range(20):
        tab.evaluate("new Promise((done) => setTimeout(done, 20))")
    assert len(machine.messages("drag_alive")) == count


def test_a_closed_tab_sends_nothing_more(
    tab: Tab, machine: Any, wait_until: Callable[..., Any]
) -> None:
    tab.key("rawKeyDown", "KeyD")
    wait_until(lambda: len(machine.messages("jog")) >= 2)
    tab.call("Page.close")
    wait_until(lambda: not machine.sockets)
    count = len(machine.messages("jog"))
    assert len(machine.messages("jog")) == count
