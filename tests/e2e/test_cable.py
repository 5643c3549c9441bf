"""A board at a real terminal: chosen, pulled out and put in again, all from the page."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Page, expect

from deltaviz.link.capture.reader import read_capture
from deltaviz.link.capture.replay_session import replay_session
from deltaviz.link.capture.spoken import connections

PATIENCE = 60_000  # ms
TRIES = 5
ROOT = Path(__file__).parents[2]


class Board:
    """`tests.link.pty_board`, told what to do line by line."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._process = subprocess.Popen(
            [sys.executable, "-m", "tests.link.pty_board", str(path)],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1, cwd=ROOT,
        )  # fmt: skip
        self._answer("plug")

    def tell(self, what: str) -> None:
        assert self._process.stdin is not None
        self._process.stdin.write(what + "\n")
        self._answer(what)

    def _answer(self, expected: str) -> None:
        assert self._process.stdout is not None
        assert self._process.stdout.readline().strip() == expected

    def close(self) -> None:
        self._process.communicate("")


@pytest.fixture
def board(tmp_path: Path) -> Iterator[Board]:
    board = Board(tmp_path / "ttyBOARD")
    yield board
    board.close()


def home(page: Page, served: Any) -> None:
    """Once more where a machine with more to do than it can has broken it off, and rightly."""
    for _ in range(TRIES):
        page.get_by_role("button", name="Home", exact=True).click()
        served.wait(lambda s: s["mode"] in ("homing", "idle"), "homing")
        if served.wait(lambda s: s["mode"] != "homing", "its end")["homed"]:
            return


def test_the_cable_is_pulled_in_a_move_and_put_in_again(
    serve: Callable[..., Any], board: Board, page: Page, tmp_path: Path
) -> None:
    capture = tmp_path / "day.capture"
    served = serve("--link", str(board.path), "--capture", str(capture))
    page.goto(served.url)
    page.set_default_timeout(PATIENCE)
    expect(page.locator("#mode")).to_have_text("Disabled", timeout=PATIENCE)
    page.get_by_role("button", name="Enable", exact=True).click()
    expect(page.locator("#mode")).to_have_text("Not homed", timeout=PATIENCE)
    home(page, served)
    expect(page.locator("#mode")).to_have_text("Idle · homed", timeout=PATIENCE)

    moved = page.evaluate(
        """() => fetch("/api/move", {method: "POST", headers: {"content-type": "application/json"},
        body: JSON.stringify({xyz_mm: [60, 0, -300], speed: 0.1})}).then((r) => r.status)"""
    )
    assert moved == 202
    served.wait(lambda s: s["mode"] == "moving", "the move")
    board.tell("unplug")
    status = page.get_by_role("status")
    expect(status).to_contain_text("unplugged", timeout=PATIENCE)
    expect(status).to_contain_text("connect")
    page.get_by_role("button", name="Set-up").click()
    page.get_by_role("button", name="Connect", exact=True).click()
    expect(page.locator("#link-problem")).to_contain_text("There is no", timeout=PATIENCE)

    board.tell("plug")
    page.get_by_role("button", name="Connect", exact=True).click()
    expect(status).to_contain_text("kept its position", timeout=PATIENCE)
    expect(page.locator("#mode")).to_have_text("Idle · homed")
    assert served.state()["mode"] == "idle"

    board.tell("unplug")
    expect(status).to_contain_text("unplugged", timeout=PATIENCE)
    board.tell("restart")
    board.tell("plug")
    page.get_by_role("button", name="Connect", exact=True).click()
    expect(status).to_contain_text("so home it", timeout=PATIENCE)
    expect(page.locator("#mode")).to_have_text("Disabled")
    expect(page.locator("#link-facts")).to_contain_text("day.capture")

    served.end()
    parts = connections(read_capture(capture))
    assert len(parts) == 3, "one for each time that it was connected"
    for records in parts:
        assert not [event for event in replay_session(records) if event.differs]


def test_a_port_that_is_not_there_is_told_in_the_terminal_and_another_can_be_chosen(
    serve: Callable[..., Any], tmp_path: Path
) -> None:
    device = tmp_path / "ttyNone"
    served = serve("--link", str(device))
    assert served.process.stdout.readline().startswith(f"deltaviz: There is no {device}.")
    assert served.state()["link"]["id"] == "ttynone"
    assert [link["id"] for link in served.get("/api/ports")][:3] == ["sim", "emulate", "ttynone"]
    assert served.post("/api/connect", {"link": "nonsense"}) == 422
    assert served.post("/api/connect", {"link": "sim"}) == 200
    served.wait(lambda s: s["mode"] == "idle", "the simulated board")
