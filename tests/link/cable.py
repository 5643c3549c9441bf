"""A pseudo-terminal as a cable: the host opens `device`, the test holds the other end.

What is written to a pseudo-terminal arrives a little later: tests that turn the clock themselves
wait here for the bytes, never for a time.
"""

from __future__ import annotations

import contextlib
import fcntl
import os
import select
import socket
import struct
import termios
import time
import tty

from deltaviz.link.wire.stream import ByteStream

PATIENCE = 20.0  # s, of a loaded machine


class Cable:
    def __init__(self) -> None:
        self._far, near = os.openpty()
        tty.setraw(near)
        self.device = os.ttyname(near)
        os.close(near)
        os.set_blocking(self._far, False)
        self.plugged = True

    def say(self, data: bytes) -> None:
        while data:
            data = data[os.write(self._far, data) :]

    def hear(self, most: int = 1 << 16) -> bytes:
        """What has arrived; empty also when nobody has the device open."""
        try:
            return os.read(self._far, most)
        except (BlockingIOError, OSError):
            return b""

    def hear_bytes(self, count: int) -> bytes:
        """The next `count` bytes, which have been written already."""
        data, end = b"", time.monotonic() + PATIENCE
        while len(data) < count:
            assert time.monotonic() < end, f"{len(data)} of {count} bytes have come"
            select.select([self._far], [], [], 0.1)
            data += self.hear(count - len(data))
        return data

    def unplug(self) -> None:
        if self.plugged:
            self.plugged = False
            os.close(self._far)


def wait_for_bytes(descriptor: int, count: int) -> None:
    """Until so many can be read; an end of the cable ends the wait, too."""
    end = time.monotonic() + PATIENCE
    while _readable(descriptor) < count:
        assert time.monotonic() < end, f"{_readable(descriptor)} of {count} bytes have come"


def _readable(descriptor: int) -> int:
    with contextlib.suppress(OSError):
        answer = fcntl.ioctl(descriptor, termios.FIONREAD, b"\0\0\0\0")
        return struct.unpack("i", answer)[0]
    return 1 << 30


class Counted:
    """A stream that counts what passes."""

    def __init__(self, stream: ByteStream) -> None:
        self._stream = stream
        self.written = 0
        self.read_ = 0

    @property
    def ended(self) -> str | None:
        return self._stream.ended

    def write(self, data: bytes) -> int:
        taken = self._stream.write(data)
        if self._stream.ended is None:
            self.written += taken
        return taken

    def read(self) -> bytes:
        data = self._stream.read()
        self.read_ += len(data)
        return data

    def fileno(self) -> int:
        return self._stream.fileno()

    def close(self) -> None:
        self._stream.close()


class SocketCable:
    """The same over TCP: the host connects to `device`."""

    def __init__(self) -> None:
        self._listener = socket.create_server(("127.0.0.1", 0))
        self._far: socket.socket | None = None
        self.device = f"socket://127.0.0.1:{self._listener.getsockname()[1]}"
        self.plugged = True

    def say(self, data: bytes) -> None:
        self._connection().sendall(data)

    def hear_bytes(self, count: int) -> bytes:
        data = b""
        while len(data) < count:
            part = self._connection().recv(count - len(data))
            assert part, f"{len(data)} of {count} bytes have come"
            data += part
        return data

    def unplug(self) -> None:
        if self.plugged:
            self.plugged = False
            self._listener.close()
            if self._far is not None:
                self._far.close()

    def _connection(self) -> socket.socket:
        if self._far is None:
            self._far, _ = self._listener.accept()
            self._far.settimeout(PATIENCE)
            self._far.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        return self._far
