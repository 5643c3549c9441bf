"""uvicorn, set up for small messages that must not wait, and ended by us instead of itself."""

from __future__ import annotations

import asyncio
import contextlib
import logging
from collections.abc import Callable, Iterator
from socket import socket

import uvicorn
from starlette.types import ASGIApp
from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol

from deltaviz.web.once import OncePerMinuteFilter

CLOSE_TIMEOUT = 1  # s for what is still under way when the server closes
_MAX_SOCKET_MESSAGE = 64 * 1024  # bytes; what the scene's gateway takes, /ws takes less
_READ_AT_ONCE = 4 * 1024  # bytes
_PING_EVERY, _PING_TIMEOUT = 5.0, 10.0  # s; a page that vanished without a word


class FairSocket(WebSocketsSansIOProtocol):
    """Reads a little at a time, so that one page's flood leaves the others their turn.

    All frames of one read are parsed at a stretch: 60 ms for a whole receive buffer of them.
    """

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        setattr(transport, "max_size", _READ_AT_ONCE)  # noqa: B010 - asyncio's, undocumented
        super().connection_made(transport)


class Server(uvicorn.Server):
    """Leaves the signals alone; `started_up` is called once requests are answered."""

    def __init__(self, app: ASGIApp, *, started_up: Callable[[], None]) -> None:
        logging.getLogger("uvicorn.error").addFilter(OncePerMinuteFilter())
        super().__init__(
            uvicorn.Config(
                app,
                loop="asyncio",
                http="h11",
                ws=FairSocket,
                ws_max_size=_MAX_SOCKET_MESSAGE,
                ws_per_message_deflate=False,
                ws_ping_interval=_PING_EVERY,
                ws_ping_timeout=_PING_TIMEOUT,
                lifespan="off",
                log_config=None,
                log_level="warning",
                access_log=False,
                proxy_headers=False,
                server_header=False,
                timeout_graceful_shutdown=CLOSE_TIMEOUT,
            )
        )
        self._started_up = started_up

    async def startup(self, sockets: list[socket] | None = None) -> None:
        await super().startup(sockets)
        self._started_up()

    @contextlib.contextmanager
    def capture_signals(self) -> Iterator[None]:
        yield
