"""A connected socket as a stream of bytes that never waits for the other side."""

from __future__ import annotations

import socket

_AT_ONCE = 1 << 16  # bytes
_READS = 16  # at once: a flood may not hold its reader for ever


class SocketStream:
    """`ended` says why, once nothing can come any more."""

    def __init__(self, sock: socket.socket) -> None:
        sock.setblocking(False)
        self._socket = sock
        self.ended: str | None = None

    def write(self, data: bytes) -> int:
        if self.ended is not None:
            return len(data)
        try:
            return self._socket.send(data)
        except BlockingIOError:
            return 0
        except OSError:
            # What the other side sent before it went is still to be read: `read` ends it.
            return len(data)

    def read(self) -> bytes:
        arrived: list[bytes] = []
        try:
            while self.ended is None and len(arrived) < _READS:
                arrived.append(self._socket.recv(_AT_ONCE))
                if not arrived[-1]:
                    self.ended = "it has ended"
        except BlockingIOError:
            pass
        except OSError:
            self.ended = "it has ended"
        return b"".join(arrived)

    def fileno(self) -> int:
        return self._socket.fileno()

    def close(self) -> None:
        self._socket.close()
        self.ended = self.ended or "it was closed"
