"""What the console mends in viser's own panel, tried on the real one."""

from __future__ import annotations

import asyncio
import re
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
import viser
from playwright.sync_api import FrameLocator, Page, expect
from starlette.requests import Request
from starlette.responses import HTMLResponse
from starlette.routing import WebSocketRoute
from starlette.websockets import WebSocket
from websockets.asyncio.client import connect
from websockets.typing import Subprotocol

pytestmark = pytest.mark.browser

INDEX = Path(str(viser.__file__)).parent / "client/build/index.html"


@pytest.fixture
def values(machine: Any, monkeypatch: pytest.MonkeyPatch) -> Iterator[list[float]]:
    """Puts a real viser with one slider into the frame; gives the values it was set to."""
    server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    heard: list[float] = []
    with server.gui.add_folder("Angles"):
        slider = server.gui.add_slider("θ1 °", min=-45.0, max=90.0, step=0.1, initial_value=0.0)
    slider.on_update(lambda _: heard.append(slider.value))
    server.gui.main_panel.dock_left()

    async def page(_request: Request) -> HTMLResponse:
        return HTMLResponse(INDEX.read_text(encoding="utf-8"))

    async def forward(socket: WebSocket) -> None:
        offered = socket.headers["sec-websocket-protocol"].split(",")
        protocols = [Subprotocol(p.strip()) for p in offered]
        url = f"ws://127.0.0.1:{server.get_port()}/"
        async with connect(url, subprotocols=protocols, max_size=None) as upstream:
            await socket.accept(subprotocol=upstream.subprotocol)

            async def down() -> None:
                async for message in upstream:
                    await socket.send_bytes(message if isinstance(message, bytes) else b"")

            task = asyncio.create_task(down())
            with suppress(Exception):
                while True:
                    await upstream.send(await socket.receive_bytes())
            task.cancel()

    monkeypatch.setattr(machine, "scene", page)
    machine.app.router.routes.insert(0, WebSocketRoute("/scene", forward))
    yield heard
    machine.app.router.routes.pop(0)
    server.stop()


@pytest.fixture
def panel(values: list[float], open_page: Callable[..., Page]) -> tuple[Page, FrameLocator]:
    page = open_page()
    frame = page.frame_locator("#scene")
    frame.get_by_role("slider").first.wait_for(timeout=60_000)
    return page, frame


def test_number_boxes_are_for_reading(
    panel: tuple[Page, FrameLocator], values: list[float]
) -> None:
    page, frame = panel
    box = frame.locator("input.mantine-NumberInput-input")
    expect(box).to_have_attribute("readonly", "")
    box.focus()
    page.keyboard.type("55")
    page.keyboard.press("ArrowUp")
    page.keyboard.press("Enter")
    page.wait_for_timeout(300)
    assert box.input_value() == "0"
    assert values == []


def test_sliders_have_names_and_keep_their_keys(
    panel: tuple[Page, FrameLocator],
    machine: Any,
    values: list[float],
    wait_until: Callable[..., Any],
) -> None:
    page, frame = panel
    slider = frame.get_by_role("slider", name="θ1 °")
    slider.focus()
    page.keyboard.press("ArrowRight")
    wait_until(lambda: values)
    assert machine.messages("jog_start") == []


def test_who_only_watches_cannot_use_the_panel(
    panel: tuple[Page, FrameLocator], machine: Any
) -> None:
    _, frame = panel
    leaf = frame.locator("[data-testid=floating-panel]")
    expect(leaf).not_to_have_attribute("inert", re.compile(""))
    machine.set(control={"holder": "another", "you": False})
    expect(leaf).to_have_attribute("inert", "")
    machine.set(control={"holder": None, "you": False})
    expect(leaf).not_to_have_attribute("inert", re.compile(""))
