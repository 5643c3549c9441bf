"""Who may speak to us: decided by the request's headers, for HTTP and websockets alike.

Any page a person visits can send requests to a server on their own machine. What tells it from
our page is what the browser itself writes: Host, Origin and Sec-Fetch-Site.
"""

from __future__ import annotations

import json
from collections.abc import Iterable

from starlette.types import ASGIApp, Receive, Scope, Send

LOOPBACK_NAMES = ("127.0.0.1", "localhost", "[::1]")
READING = ("GET", "HEAD")
DEFAULT_PORT = 80  # browsers leave it out of Host and Origin


def allowed_hosts(host: str, port: int) -> frozenset[str]:
    """The values of Host that mean this server, bound to `host` (an IPv6 one in brackets)."""
    names = {*LOOPBACK_NAMES, host.lower()}
    hosts = {f"{name}:{port}" for name in names}
    return frozenset(hosts | names if port == DEFAULT_PORT else hosts)


def refusal(
    *, method: str, headers: Iterable[tuple[bytes, bytes]], allowed: frozenset[str]
) -> str | None:
    """Why this request may not be answered, for a person; None when it may.

    `method` is the HTTP method, or "WEBSOCKET". Requests without Origin and Sec-Fetch-Site come
    from no browser and are allowed, which is right on a loopback address only.
    """
    seen = _Headers(headers)
    host = seen.only("host")
    if host is None or host.lower() not in allowed:
        return f"This server does not go by that Host; use {_example(allowed)}."
    if seen.has("origin") and (seen.only("origin") or "").lower() != f"http://{host.lower()}":
        return "Another page's requests are not taken: the Origin is not this server's own."
    if not seen.has("sec-fetch-site"):
        return None
    site = seen.only("sec-fetch-site")
    if site == "same-origin" or (site == "none" and method in READING):
        return None
    if method in READING and _is_opened_by_a_link(seen):
        return None
    return "Another page's requests are not taken: Sec-Fetch-Site is not same-origin."


class _Headers:
    def __init__(self, headers: Iterable[tuple[bytes, bytes]]) -> None:
        self._values: dict[str, list[str]] = {}
        for name, value in headers:
            key = name.decode("latin-1").lower()
            self._values.setdefault(key, []).append(value.decode("latin-1"))

    def has(self, name: str) -> bool:
        return name in self._values

    def only(self, name: str) -> str | None:
        """The header's value; None when it is missing or given twice."""
        values = self._values.get(name, [])
        return values[0] if len(values) == 1 else None


def _is_opened_by_a_link(headers: _Headers) -> bool:
    """A whole page that a person opened from elsewhere; nothing of it can be read there."""
    return (
        headers.only("sec-fetch-mode") == "navigate"
        and headers.only("sec-fetch-dest") == "document"
    )


def _example(allowed: frozenset[str]) -> str:
    ipv4 = sorted(host for host in allowed if host.startswith("127.0.0.1"))
    return f"http://{(ipv4 or sorted(allowed))[-1]}"


class OriginGuard:
    """Answers 403 to whoever `refusal` refuses; the application never sees the request."""

    def __init__(self, app: ASGIApp, *, allowed: frozenset[str]) -> None:
        self._app = app
        self._allowed = allowed

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        method = "WEBSOCKET" if scope["type"] == "websocket" else scope["method"]
        reason = refusal(method=method, headers=scope["headers"], allowed=self._allowed)
        if reason is None:
            await self._app(scope, receive, send)
        elif scope["type"] == "http":
            await _refuse(send, "http.response", reason)
        elif "websocket.http.response" in scope.get("extensions", {}):
            await receive()  # the connect event
            await _refuse(send, "websocket.http.response", reason)
        else:
            await receive()
            await send({"type": "websocket.close", "code": 1008, "reason": reason})


async def _refuse(send: Send, kind: str, reason: str) -> None:
    body = json.dumps({"detail": reason}).encode()
    headers = [
        (b"content-type", b"application/json"),
        (b"content-length", str(len(body)).encode()),
    ]
    await send({"type": f"{kind}.start", "status": 403, "headers": headers})
    await send({"type": f"{kind}.body", "body": body})
