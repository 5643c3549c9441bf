"""The way from a browser to viser: the page, and a websocket that lets little through.

Host and Origin are checked before us (DESIGN 7). Here each frame from a browser is decoded,
checked and written anew; what no page of ours sends closes the socket that sent it.
"""

from __future__ import annotations

import asyncio
import logging
import re
import socket
import time
from collections.abc import Callable, Coroutine
from dataclasses import dataclass, field

from fastapi import APIRouter, Request, Response, WebSocket
from fastapi.responses import HTMLResponse, RedirectResponse
from starlette.requests import HTTPConnection
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed, WebSocketException
from websockets.typing import Subprotocol

from deltaviz.scene import frames
from deltaviz.scene.controls import Controls, Judgement
from deltaviz.scene.listener import HOST, SECRET_HEADER, SESSION_HEADER, Listener
from deltaviz.scene.page import Page

_log = logging.getLogger(__name__)

_ALLOWED_QUERY = re.compile(r"fixedDpr=[0-9]{1,2}(\.[0-9]{1,3})?")
_FRAMES_PER_SECOND = 200.0  # a page sends about 50 camera and 20 drag messages
_BURST = 400.0
_GRACE = 2.0  # s in which a page may not know yet that it lost control
_POLICY_VIOLATION, _TRY_AGAIN = 1008, 1013


@dataclass(frozen=True)
class Gate:
    """What the gateway must know: where viser is, what it takes, who is who."""

    listener: Listener
    page: Page
    controls: Controls
    session_of: Callable[[HTTPConnection], str | None]
    may_steer: Callable[[str], bool]
    is_dark: Callable[[str | None], bool]


def make_router(gate: Gate) -> APIRouter:
    """Routes for `/scene` and `/scene/`."""
    router = APIRouter(include_in_schema=False)

    @router.get("/scene")
    async def scene_without_slash() -> Response:
        return RedirectResponse("/scene/")

    @router.get("/scene/")
    async def scene_page(request: Request) -> Response:
        # The page's other queries name a source whose code it would run; its own reload
        # carries one of them.
        query = request.url.query
        if query and not _ALLOWED_QUERY.fullmatch(query):
            return RedirectResponse("/scene/")
        dark = gate.is_dark(gate.session_of(request))
        return HTMLResponse(
            gate.page.dark if dark else gate.page.light,
            headers={"Content-Security-Policy": gate.page.policy, "Cache-Control": "no-cache"},
        )

    @router.websocket("/scene")
    async def scene_socket(browser: WebSocket) -> None:
        await _relay(browser, gate)

    return router


async def _relay(browser: WebSocket, gate: Gate) -> None:
    """Join one browser to viser until either goes."""
    session = gate.session_of(browser)
    headers = {SECRET_HEADER: gate.listener.secret}
    if session is not None:
        headers[SESSION_HEADER] = session
    try:
        async with connect(
            f"ws://{HOST}/",
            sock=socket.create_connection((HOST, gate.listener.port)),
            subprotocols=_viser_protocols(browser),
            additional_headers=headers,
            compression=None,
            max_size=None,
            ping_interval=None,  # viser asks whether we live; it is in our own process
        ) as viser:
            await browser.accept(subprotocol=viser.subprotocol)
            await _first_to_end(
                _from_browser(browser, viser, _Visitor(gate=gate, session=session)),
                _to_browser(viser, browser),
            )
    except (OSError, WebSocketException):
        _log.warning("The scene is not there; a browser was told to try again.")
        await _close(browser, _TRY_AGAIN, "The scene is not there")


async def _to_browser(viser: ClientConnection, browser: WebSocket) -> None:
    """One frame at a time: while this browser is slow, viser keeps the newest state of each
    thing for it, and the others go on."""
    try:
        async for message in viser:
            assert isinstance(message, bytes)
            await browser.send_bytes(message)
    except (ConnectionClosed, RuntimeError, OSError):
        return  # either is gone
    await _close(browser, viser.close_code or 1001, viser.close_reason or "")


async def _from_browser(browser: WebSocket, viser: ClientConnection, visitor: _Visitor) -> None:
    while True:
        event = await browser.receive()
        if event["type"] == "websocket.disconnect":
            return
        try:
            frame = visitor.admit(event.get("bytes"), time.monotonic())
        except frames.FrameError as error:
            _log.warning("A browser's connection to the scene was closed: %s.", error)
            await _close(browser, _POLICY_VIOLATION, str(error)[:100])
            return
        if frame is not None:
            try:
                await viser.send(frames.encode(frame))
            except ConnectionClosed:
                return


@dataclass
class _Visitor:
    """One browser's connection: what it may say, and how often."""

    gate: Gate
    session: str | None
    _steered_at: float = -_GRACE
    _tokens: float = _BURST
    _counted_at: float = field(default_factory=time.monotonic)

    def admit(self, data: bytes | None, now: float) -> frames.Frame | None:
        """The frame to pass on, None to drop it. Raises FrameError to close the socket."""
        self._count(now)
        if data is None:
            raise frames.FrameError("text is not spoken here")
        frame = frames.decode(data)
        match self._judge(frame):
            case Judgement.SHOWS:
                return frame
            case Judgement.STEERS:
                return frame if self._may_steer(now) else None
            case Judgement.STALE:
                return None
            case Judgement.REFUSED:
                raise frames.FrameError("no input of this page takes this value")

    def _judge(self, frame: frames.Frame) -> Judgement:
        controls = self.gate.controls
        if isinstance(frame, frames.Camera | frames.Click):
            return Judgement.SHOWS
        if isinstance(frame, frames.GuiUpdate):
            return controls.judge(frame.uuid, frame.value)
        return controls.judge_drag(frame.name)

    def _may_steer(self, now: float) -> bool:
        if self.session is not None and self.gate.may_steer(self.session):
            self._steered_at = now
            return True
        if now - self._steered_at < _GRACE:
            return False
        raise frames.FrameError("another session has control")

    def _count(self, now: float) -> None:
        self._tokens = min(_BURST, self._tokens + (now - self._counted_at) * _FRAMES_PER_SECOND)
        self._counted_at = now
        self._tokens -= 1.0
        if self._tokens < 0.0:
            raise frames.FrameError("too many frames")


def _viser_protocols(browser: WebSocket) -> list[Subprotocol]:
    offered: list[str] = browser.scope.get("subprotocols", [])
    return [Subprotocol(name) for name in offered if re.fullmatch(r"viser-v[0-9.]{1,20}", name)]


async def _first_to_end(*coroutines: Coroutine[None, None, None]) -> None:
    tasks = [asyncio.ensure_future(coroutine) for coroutine in coroutines]
    try:
        await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
    finally:
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)


async def _close(browser: WebSocket, code: int, reason: str) -> None:
    try:
        await browser.close(code, reason)
    except RuntimeError:
        return  # gone already
