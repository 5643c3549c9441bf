"""The page's websocket: the newest state out, intents in. Neither side waits for the other."""

from __future__ import annotations

import asyncio
import contextlib
import json
import time
from collections import deque

from fastapi import WebSocket
from starlette.websockets import WebSocketDisconnect, WebSocketState

from deltaviz.machine.intent import ClientGone, ClientHere
from deltaviz.machine.port import MachinePort
from deltaviz.web.conversation import Conversation, Reply, Verdict
from deltaviz.web.once import OncePerMinute
from deltaviz.web.scene_port import ScenePort
from deltaviz.web.session import Sessions
from deltaviz.web.state import state_json
from deltaviz.web.view_json import view_json

STATE_PERIOD = 1 / 40  # s; 30 Hz is promised
MAX_SOCKETS = 64
_REPLIES_KEPT = 32
_READ_AT_ONCE = 16  # messages of one page before the others have their turn
_POLICY_VIOLATION, _TRY_AGAIN_LATER = 1008, 1013


class Pages:
    """All open page sockets."""

    def __init__(
        self,
        *,
        machine: MachinePort,
        sessions: Sessions,
        scene: ScenePort,
    ) -> None:
        self._machine = machine
        self._sessions = sessions
        self._scene = scene
        self._logged = OncePerMinute()

    async def serve(self, websocket: WebSocket) -> None:
        """Talk with one page until it goes."""
        if self._sessions.open_sockets >= MAX_SOCKETS:
            await websocket.accept()
            await websocket.close(_TRY_AGAIN_LATER, f"{MAX_SOCKETS} pages are open already")
            return
        client = self._sessions.client_of_socket(websocket)
        if self._sessions.opened(client):
            self._machine.post(ClientHere(client))
        try:
            await websocket.accept()
            await self._talk(websocket, client)
        finally:
            if self._sessions.closed(client):
                self._machine.post(ClientGone(client))

    async def _talk(self, websocket: WebSocket, client: str) -> None:
        outbox = Outbox(asyncio.get_running_loop())
        conversation = Conversation(
            machine=self._machine,
            client=client,
            reply=outbox.put,
            scene=self._scene,
            logged=self._logged,
        )
        sending = asyncio.create_task(self._send(websocket, client, outbox))
        try:
            verdict = await _listen(websocket, conversation)
        finally:
            sending.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await sending
        if verdict is Verdict.HANG_UP and websocket.client_state is WebSocketState.CONNECTED:
            await websocket.close(_POLICY_VIOLATION, "Too many messages that cannot be read")

    async def _send(self, websocket: WebSocket, client: str, outbox: Outbox) -> None:
        """The state, again and again. While this page is slow, states are left out."""
        with contextlib.suppress(WebSocketDisconnect, RuntimeError):  # it is gone: _listen ends
            next_state = time.monotonic()
            told = None
            while True:
                for reply in outbox.take():
                    await websocket.send_text(json.dumps(reply))
                now = time.monotonic()
                if now >= next_state:
                    await websocket.send_text(self._state_for(client))
                    next_state = now + STATE_PERIOD
                    if (items := self._scene.items(client)) is not told:
                        await websocket.send_text(view_json(items))
                        told = items
                await outbox.wait(next_state - time.monotonic())

    def _state_for(self, client: str) -> str:
        machine = self._machine
        state = state_json(
            machine.snapshot, robot=machine.robot, client=client, now=time.monotonic()
        )
        return json.dumps({"type": "state", **state}, allow_nan=False)


async def _listen(websocket: WebSocket, conversation: Conversation) -> Verdict:
    """Read until the page goes, or had better go."""
    heard = 0
    while True:
        event = await websocket.receive()
        if event["type"] == "websocket.disconnect":
            return Verdict.GO_ON
        if conversation.hear(event.get("text")) is Verdict.HANG_UP:
            return Verdict.HANG_UP
        heard += 1
        if heard % _READ_AT_ONCE == 0:
            await asyncio.sleep(0)


class Outbox:
    """Replies on their way to a page; beyond a few, the oldest are lost."""

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self._loop = loop
        self._replies: deque[Reply] = deque(maxlen=_REPLIES_KEPT)
        self._some = asyncio.Event()

    def put(self, reply: Reply) -> None:
        """From any thread."""
        self._replies.append(reply)
        with contextlib.suppress(RuntimeError):  # the loop is closed: nobody is left to tell
            self._loop.call_soon_threadsafe(self._some.set)

    def take(self) -> list[Reply]:
        self._some.clear()
        taken = list(self._replies)
        self._replies.clear()
        return taken

    async def wait(self, seconds: float) -> None:
        """Until there is a reply, at most so long."""
        if seconds <= 0:
            await asyncio.sleep(0)
            return
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(seconds):
                await self._some.wait()
