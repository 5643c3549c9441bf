"""Who is asking: a page's cookie ties its requests to its sockets."""

from __future__ import annotations

import re
import secrets

from starlette.requests import HTTPConnection
from starlette.responses import Response

HTTP_CLIENT = "http"  # whoever asks without an open page; control is its for one motion at a time
_TOKEN = re.compile(r"[A-Za-z0-9_-]{32,64}")


class Sessions:
    """Names callers, and knows which pages are open.

    A session is a random name, not a permission: what a page may do is decided by where its
    requests come from (`origin`) and by who holds control (the machine).
    """

    def __init__(self, *, port: int) -> None:
        self._cookie = f"deltaviz_session_{port}"  # cookies do not tell ports apart
        self._sockets: dict[str, int] = {}

    def of(self, connection: HTTPConnection) -> str | None:
        """The session in the caller's cookie; None without a usable one."""
        token = connection.cookies.get(self._cookie, "")
        return token if _TOKEN.fullmatch(token) else None

    def welcome(self, connection: HTTPConnection, response: Response) -> None:
        """Give the caller a session, unless it has one."""
        if self.of(connection) is None:
            response.set_cookie(
                self._cookie, secrets.token_urlsafe(32), httponly=True, samesite="strict", path="/"
            )

    def client_of_request(self, connection: HTTPConnection) -> str:
        """Who an HTTP request speaks for: its page, if that is open, or `HTTP_CLIENT`.

        A closed page's control would never be freed, so its cookie alone names nobody.
        """
        session = self.of(connection)
        return session if session in self._sockets else HTTP_CLIENT

    def client_of_socket(self, connection: HTTPConnection) -> str:
        """Who a websocket speaks for; without a cookie, for itself alone."""
        return self.of(connection) or f"socket-{secrets.token_urlsafe(16)}"

    @property
    def open_sockets(self) -> int:
        return sum(self._sockets.values())

    def opened(self, client: str) -> bool:
        """Count one socket of this client; True when it is the first."""
        self._sockets[client] = self._sockets.get(client, 0) + 1
        return self._sockets[client] == 1

    def closed(self, client: str) -> bool:
        """Forget one socket of this client; True when it was the last."""
        self._sockets[client] -= 1
        if self._sockets[client] == 0:
            del self._sockets[client]
        return client not in self._sockets
