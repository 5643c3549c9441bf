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
        self._stops: deque[bytes] = deque()
        self._frames: deque[bytes] = deque()
        self._unsent = 0
        self.overflowed = False

    def put(self, frames: list[bytes], *, stop: bool = False) -> None:
        """All that can be sent is sent.

        A stop takes the place of what has not begun: of that, commands that are still wanted are
        repeated, and what leads to motion must not follow it. It waits there once.
        """
        if stop:
            self._unsent -= sum(map(len, self._frames))
            self._frames.clear()
            frames = [frame for frame in frames if frame not in self._stops]
            self._stops.extend(frames)
        else:
            self._frames.extend(frames)
        self._unsent += sum(map(len, frames))
        self.flush()
        self.overflowed = self.overflowed or self._unsent > MOST_UNSENT

    def flush(self) -> None:
        while self._send_one():
            pass

    def _send_one(self) -> bool:
        """Whether a frame, or the rest of one, was taken whole."""
        waiting = self._stops or self._frames
        frame = self._begun or (waiting[0] if waiting else b"")
        taken = self._stream.write(frame) if frame else 0
        if not taken:
            return False
        if not self._begun:
            waiting.popleft()
        self._begun = frame[taken:]
        self._unsent -= taken
        return not self._begun
