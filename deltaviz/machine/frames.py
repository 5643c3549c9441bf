"""Values over a socket between our own two processes, never blocking either.

A frame is a length and a pickle: both ends are this program, on this computer.
"""

from __future__ import annotations

import contextlib
import pickle
import socket
import struct
from collections import deque
from typing import Any

_LENGTH = struct.Struct("!I")
_CHUNK = 65536


class FrameWriter:
    """Sends in order what must arrive, and of pictures only the newest."""

    def __init__(self, sock: socket.socket) -> None:
        sock.setblocking(False)
        self._sock = sock
        self._queue: deque[bytes] = deque()
        self._newest: bytes | None = None
        self._partly = b""  # the rest of a frame that is half sent
        self.closed = False

    def send(self, value: object) -> None:
        """This value will arrive, after all sent before."""
        self._queue.append(_framed(value))
        self.pump()

    def send_newest(self, value: object) -> None:
        """This value arrives unless a newer one overtakes it."""
        self._newest = _framed(value)
        self.pump()

    @property
    def pending(self) -> bool:
        return bool(self._partly or self._queue or self._newest) and not self.closed

    def pump(self) -> None:
        """Send what the socket takes now."""
        with contextlib.suppress(BlockingIOError):
            while self.pending:
                if not self._partly:
                    self._partly = self._next()
                try:
                    sent = self._sock.send(self._partly)
                except BlockingIOError:
                    raise
                except OSError:
                    self.closed = True
                    return
                self._partly = self._partly[sent:]

    def _next(self) -> bytes:
        if self._queue:
            return self._queue.popleft()
        frame, self._newest = self._newest or b"", None
        return frame


class FrameReader:
    def __init__(self, sock: socket.socket) -> None:
        sock.setblocking(False)
        self._sock = sock
        self._buffer = bytearray()
        self.closed = False

    def read(self) -> list[Any]:
        """All values that have arrived. `closed` once the other end is gone."""
        self._receive()
        values: list[Any] = []
        while (body := self._take()) is not None:
            values.append(pickle.loads(body))
        return values

    def read_one(self) -> Any:
        """The next value, or None while there is none; what follows stays for later."""
        self._receive()
        body = self._take()
        return None if body is None else pickle.loads(body)

    def _receive(self) -> None:
        try:
            while not self.closed:
                chunk = self._sock.recv(_CHUNK)
                self.closed = not chunk
                self._buffer += chunk
        except BlockingIOError:
            pass
        except OSError:
            self.closed = True

    def _take(self) -> bytes | None:
        if len(self._buffer) < _LENGTH.size:
            return None
        end = _LENGTH.size + _LENGTH.unpack_from(self._buffer)[0]
        if len(self._buffer) < end:
            return None
        body = bytes(self._buffer[_LENGTH.size : end])
        del self._buffer[:end]
        return body


def _framed(value: object) -> bytes:
    body = pickle.dumps(value, protocol=pickle.HIGHEST_PROTOCOL)
    return _LENGTH.pack(len(body)) + body
