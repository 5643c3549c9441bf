"""Messages between two of our own processes over a socket, never waiting for the other side."""

from __future__ import annotations

import pickle
import socket
import struct
from typing import Any

_LENGTH = struct.Struct("<I")
_MOST_UNSENT = 1 << 20  # bytes: a peer that leaves so much unread has stopped


class PickleSocket:
    """Whole values in, whole values out. `ended` says why, once nothing can come any more."""

    def __init__(self, sock: socket.socket) -> None:
        sock.setblocking(False)
        self._socket = sock
        self._unsent = bytearray()
        self._arrived = bytearray()
        self.ended: str | None = None

    def fileno(self) -> int:
        return self._socket.fileno()

    def close(self) -> None:
        self._socket.close()
        self.ended = self.ended or "it was closed"

    def send(self, value: object) -> None:
        if self.ended is not None:
            return
        data = pickle.dumps(value, pickle.HIGHEST_PROTOCOL)
        self._unsent += _LENGTH.pack(len(data)) + data
        self._flush()
        if len(self._unsent) > _MOST_UNSENT:
            self.ended = "it has stopped reading"

    def receive(self) -> list[Any]:
        if self.ended is None:
            self._flush()
            self._fill()
        values: list[Any] = []
        while len(self._arrived) >= _LENGTH.size:
            (length,) = _LENGTH.unpack_from(self._arrived)
            end = _LENGTH.size + length
            if len(self._arrived) < end:
                break
            values.append(pickle.loads(bytes(self._arrived[_LENGTH.size : end])))
            del self._arrived[:end]
        return values

    def _flush(self) -> None:
        try:
            while self._unsent:
                del self._unsent[: self._socket.send(self._unsent)]
        except BlockingIOError:
            pass
        except OSError:
            # What the other side sent before it went is still to be read: `_fill` ends it.
            self._unsent.clear()

    def _fill(self) -> None:
        try:
            while data := self._socket.recv(1 << 16):
                self._arrived += data
        except BlockingIOError:
            return
        except OSError:
            pass
        self.ended = self.ended or "it has ended"
