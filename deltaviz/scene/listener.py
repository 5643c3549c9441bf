"""viser's server on loopback, behind a secret that only our gateway knows.

viser 1.1 checks neither Origin nor Host nor a password: whoever reaches its port may steer.
So the one listener it opens is wrapped while the server is constructed, and refuses whoever
does not carry this process's secret, over websocket and plain HTTP alike. `open_listener`
tries that on itself and raises when the door stands open.
"""

from __future__ import annotations

import contextlib
import hmac
import http.client
import io
import secrets
import threading
from collections.abc import Callable, Iterator
from contextvars import ContextVar
from dataclasses import dataclass
from typing import Any

import viser
import viser._client_autobuild
import viser._messages as messages
import websockets.asyncio.server
from websockets.asyncio.server import ServerConnection
from websockets.http11 import Request, Response

SECRET_HEADER = "X-Deltaviz-Secret"
SESSION_HEADER = "X-Deltaviz-Session"
HOST = "127.0.0.1"

SESSION: ContextVar[str | None] = ContextVar("session", default=None)
"""The session whose browser caused the running callback; None for ours."""

_construction = threading.Lock()  # the wrap below is global while a server is constructed


class ListenerOpenError(RuntimeError):
    """viser's listener let in somebody without the secret; nothing may be served."""


@dataclass(frozen=True)
class Listener:
    """A viser server that only holders of `secret` can reach."""

    server: viser.ViserServer
    port: int
    secret: str

    def close(self) -> None:
        """Stop the server and its threads."""
        with contextlib.redirect_stdout(io.StringIO()):  # viser announces its end
            self.server.stop()


def open_listener() -> Listener:
    """Start viser on a free loopback port.

    Raises ListenerOpenError when a connection without the secret is not refused.
    """
    secret = secrets.token_urlsafe(32)
    with _construction, _guarded(secret), contextlib.redirect_stdout(io.StringIO()):
        server = viser.ViserServer(host=HOST, port=0, verbose=False)
    _disable_sharing(server)
    listener = Listener(server=server, port=server.get_port(), secret=secret)
    try:
        check_refusal(listener.port, secret)
    except BaseException:
        listener.close()
        raise
    return listener


def check_refusal(port: int, secret: str) -> None:
    """Connect without, with a wrong and with the right secret; raise ListenerOpenError if a
    stranger gets in, or the gateway would not."""
    wrong = {SECRET_HEADER: secrets.token_urlsafe(32)}
    for headers in ({}, wrong):
        for upgrade in (False, True):
            if (status := _status(port, headers, upgrade=upgrade)) != 403:
                kind = "websocket" if upgrade else "HTTP"
                raise ListenerOpenError(
                    f"viser answered {status} to a {kind} connection without the secret; 403"
                    " was expected. The installed viser does not fit this program."
                )
    if (status := _status(port, {SECRET_HEADER: secret}, upgrade=True)) != 101:
        raise ListenerOpenError(f"viser answered {status} to our own connection; 101 was expected")


@contextlib.contextmanager
def _guarded(secret: str) -> Iterator[None]:
    """While this holds, a websocket server that is opened asks for the secret first."""
    serve = websockets.asyncio.server.serve
    ensure_built = viser._client_autobuild.ensure_client_is_built

    def guarded_serve(handler: Callable[..., Any], *args: Any, **kwargs: Any) -> Any:
        kwargs["process_request"] = _asking_for(secret, kwargs.get("process_request"))
        return serve(_remembering_session(handler), *args, **kwargs)

    websockets.asyncio.server.serve = guarded_serve  # type: ignore[assignment]
    # The packaged client is what we serve: never fetch tools to build another one.
    viser._client_autobuild.ensure_client_is_built = lambda: None
    try:
        yield
    finally:
        websockets.asyncio.server.serve = serve  # type: ignore[misc]
        viser._client_autobuild.ensure_client_is_built = ensure_built


def _asking_for(
    secret: str, inner: Callable[[ServerConnection, Request], Response | None] | None
) -> Callable[[ServerConnection, Request], Response | None]:
    expected = secret.encode()

    def process_request(connection: ServerConnection, request: Request) -> Response | None:
        given = request.headers.get_all(SECRET_HEADER)
        if len(given) != 1 or not hmac.compare_digest(given[0].encode(), expected):
            return connection.respond(403, "Forbidden\n")
        return None if inner is None else inner(connection, request)

    return process_request


def _remembering_session(handler: Callable[..., Any]) -> Callable[..., Any]:
    async def handle(connection: ServerConnection) -> None:
        if connection.request is not None:
            SESSION.set(connection.request.headers.get(SESSION_HEADER))
        await handler(connection)

    return handle


def _disable_sharing(server: viser.ViserServer) -> None:
    """No client and no code of ours may open viser's tunnel to the outside."""

    def refuse(verbose: bool = True) -> str | None:
        raise RuntimeError("sharing through a tunnel is disabled")

    server._websock_server.unregister_handler(messages.ShareUrlRequest)
    server._websock_server.unregister_handler(messages.ShareUrlDisconnect)
    server.request_share_url = refuse  # type: ignore[method-assign]


def _status(port: int, headers: dict[str, str], *, upgrade: bool) -> int:
    """The HTTP status of one attempt; 0 when the connection was closed without any."""
    handshake = {
        "Connection": "Upgrade",
        "Upgrade": "websocket",
        "Sec-WebSocket-Version": "13",
        "Sec-WebSocket-Key": "AAAAAAAAAAAAAAAAAAAAAA==",
        "Sec-WebSocket-Protocol": f"viser-v{viser.__version__}",
    }
    connection = http.client.HTTPConnection(HOST, port, timeout=5.0)
    try:
        connection.request("GET", "/", headers=headers | (handshake if upgrade else {}))
        return connection.getresponse().status
    except (OSError, http.client.HTTPException):
        return 0
    finally:
        connection.close()
