"""A terminal's or serial port's descriptor as a stream of bytes that never waits."""

from __future__ import annotations

import fcntl
import os
import select
import struct
import termios

_AT_ONCE = 1 << 16  # bytes
_READS = 16  # at once: a flood may not hold its reader for ever
_LEAST_WINDOW = 64  # bytes
_GONE = select.POLLHUP | select.POLLERR | select.POLLNVAL
_UNPLUGGED = "it was unplugged, or has lost its power"


def window(baud: int) -> int:
    """How many bytes may lie in the operating system's buffer: 10 ms on the line, 10 bits each."""
    return max(_LEAST_WINDOW, baud // 1000)


class DescriptorStream:
    """`ended` says why, once nothing can come any more.

    Of what is written, the operating system is given at most `in_system` bytes at a time, so that
    a stop does not stand in line behind more than that. The caller keeps the descriptor open and
    closes it after the stream; it is non-blocking.
    """

    def __init__(self, descriptor: int, *, in_system: int) -> None:
        os.set_blocking(descriptor, False)
        self.ended: str | None = None
        self._descriptor = descriptor
        self._in_system = in_system
        self._broken = False  # a write failed
        self._poll = select.poll()
        self._poll.register(descriptor, select.POLLIN)

    def write(self, data: bytes) -> int:
        if self.ended is not None:
            return len(data)
        room = self._in_system - self._queued()
        if room <= 0:
            return 0
        try:
            return os.write(self._descriptor, data[:room])
        except BlockingIOError:
            return 0
        except OSError:
            self._broken = True  # what came before is still to be read: `read` ends it
            return len(data)

    def read(self) -> bytes:
        arrived: list[bytes] = []
        while self.ended is None and len(arrived) < _READS:
            try:
                chunk = os.read(self._descriptor, _AT_ONCE)
            except BlockingIOError:
                chunk = b""
            except OSError:
                self.ended = _UNPLUGGED
                break
            if not chunk:
                self._look_whether_it_lives()
                break
            arrived.append(chunk)
        return b"".join(arrived)

    def fileno(self) -> int:
        return self._descriptor

    def close(self) -> None:
        self.ended = self.ended or "it was closed"

    def _look_whether_it_lives(self) -> None:
        """A terminal reads as empty both when nothing has come and when it is gone."""
        news = self._poll.poll(0)
        if self._broken or (news and news[0][1] & _GONE):
            self.ended = _UNPLUGGED

    def _queued(self) -> int:
        """Bytes that were written and have not left; 0 where the driver does not tell."""
        try:
            answer = fcntl.ioctl(self._descriptor, termios.TIOCOUTQ, b"\0\0\0\0")
        except OSError:
            return 0
        return struct.unpack("i", answer)[0]
