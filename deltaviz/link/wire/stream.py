"""Bytes both ways, and the frames that wait to be taken."""

from __future__ import annotations

from collections import deque
from typing import Protocol

MOST_UNSENT = 1 << 18  # bytes: a peer that leaves so much unread has stopped


class ByteStream(Protocol):
    """What a link is made of: a socket, a serial port. Nothing here waits or raises."""

    @property
    def ended(self) -> str | None:
        """Why nothing can come any more ("it has ended"); None while it lives."""
        ...

    def write(self, data: bytes) -> int:
        """How many bytes of `data` were taken, from its beginning."""
        ...

    def read(self) -> bytes:
        """What has arrived; empty when nothing has."""
        ...

    def fileno(self) -> int:
        """The descriptor that becomes readable when bytes arrive; -1: there is none, poll."""
        ...

    def close(self) -> None: ...


class Outbox:
    """Frames in order on their way into a stream. One that was begun is always finished."""

    def __init__(self, stream: ByteStream) -> None:
        self._stream = stream
        self._begun = b""
        self._frames: deque[bytes] = deque()
        self._unsent = 0
        self.overflowed = False

    def put(self, frames: list[bytes], *, first: bool = False) -> None:
        """`first`: before all that has not begun. All that can be sent is sent."""
        if first:
            self._frames.extendleft(reversed(frames))
        else:
            self._frames.extend(frames)
        self._unsent += sum(map(len, frames))
        self.flush()
        self.overflowed = self.overflowed or self._unsent > MOST_UNSENT

    def flush(self) -> None:
        while self._begun or self._frames:
            frame = self._begun or self._frames.popleft()
            taken = self._stream.write(frame)
            self._unsent -= taken
            self._begun = frame[taken:]
            if self._begun:
                return
