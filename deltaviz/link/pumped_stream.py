"""A pyserial object without a descriptor, pumped through a socket pair by two threads."""

from __future__ import annotations

import contextlib
import socket
import threading
from collections.abc import Callable
from typing import Protocol

from serial import SerialException

from deltaviz.link.socket_stream import SocketStream

LOOK = 0.1  # s between looks whether the stream was closed: the port's read time-out
_WINDOW = 1024  # bytes on their way to the port; the system rounds this up to a few thousand
_PATIENCE = 0.5  # s for a thread to end


class Port(Protocol):
    """What is used of a pyserial object."""

    @property
    def in_waiting(self) -> int: ...
    def read(self, size: int, /) -> bytes: ...
    def write(self, data: bytes, /) -> int | None: ...
    def close(self) -> None: ...


class PumpedStream:
    """Owns `port`, whose read time-out is LOOK: closing the stream closes it."""

    def __init__(self, port: Port) -> None:
        ours, self._theirs = socket.socketpair()
        ours.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, _WINDOW)
        self._near = SocketStream(ours)
        self._port = port
        self._closing = False
        self._problem: str | None = None
        self._threads = [
            threading.Thread(target=self._run, args=(pump,), name="serial", daemon=True)
            for pump in (self._from_port, self._to_port)
        ]
        for thread in self._threads:
            thread.start()

    @property
    def ended(self) -> str | None:
        return self._near.ended and (self._problem or self._near.ended)

    def write(self, data: bytes) -> int:
        return self._near.write(data)

    def read(self) -> bytes:
        return self._near.read()

    def fileno(self) -> int:
        return self._near.fileno()

    def close(self) -> None:
        self._closing = True
        self._near.close()
        for thread in self._threads:
            thread.join(_PATIENCE)

    def _run(self, pump: Callable[[], None]) -> None:
        """Whatever ends one of the pumps ends the stream."""
        try:
            pump()
        except (SerialException, OSError, TypeError, AttributeError) as error:
            # The last two come from pyserial's own objects, closed by the other pump.
            if not self._closing:
                self._problem = self._problem or f"it has ended ({error})"
        with contextlib.suppress(OSError):
            self._theirs.shutdown(socket.SHUT_RDWR)
        if pump == self._from_port:
            with contextlib.suppress(SerialException, OSError):
                self._port.close()
            self._theirs.close()

    def _from_port(self) -> None:
        while not self._closing:
            first = self._port.read(1)
            if first:
                self._theirs.sendall(first + self._port.read(self._port.in_waiting))

    def _to_port(self) -> None:
        while data := self._theirs.recv(_WINDOW):
            self._port.write(data)
