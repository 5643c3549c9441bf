"""What every response carries, errors included, and the last resort when a handler fails."""

from __future__ import annotations

import logging

from starlette.datastructures import MutableHeaders
from starlette.responses import JSONResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

log = logging.getLogger(__name__)

CONSOLE_POLICY = "; ".join(
    (
        "default-src 'self'",
        "script-src 'self'",
        "style-src 'self'",
        "img-src 'self' data: blob:",
        "connect-src 'self'",
        "frame-src 'self'",
        "frame-ancestors 'none'",
        "object-src 'none'",
        "base-uri 'none'",
        "form-action 'none'",
    )
)
ALWAYS = {
    "x-content-type-options": "nosniff",
    "referrer-policy": "no-referrer",
    "cross-origin-opener-policy": "same-origin",
    "cross-origin-resource-policy": "same-origin",
}
RESPONSE_STARTS = ("http.response.start", "websocket.http.response.start")


class Shield:
    """Outermost: adds the security headers; a failing handler answers 500, without details.

    A response that brings its own Content-Security-Policy or Cache-Control keeps it.
    """

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        started = False

        async def guarded(message: Message) -> None:
            nonlocal started
            if message["type"] in RESPONSE_STARTS:
                started = True
                _harden(MutableHeaders(raw=message["headers"]), scope["path"])
            await send(message)

        try:
            await self._app(scope, receive, guarded)
        except Exception:
            if scope["type"] == "websocket" or started:
                raise
            log.exception("%s %s failed", scope["method"], scope["path"])
            failure = JSONResponse({"detail": "The server failed at this."}, status_code=500)
            await failure(scope, receive, guarded)


def _harden(headers: MutableHeaders, path: str) -> None:
    headers.update(ALWAYS)
    headers.setdefault("content-security-policy", CONSOLE_POLICY)
    headers.setdefault("cache-control", "no-store" if path.startswith("/api/") else "no-cache")
