"""The emulated board's time is granted to it, millisecond by millisecond. What it does not use soon
is forgotten, so that after a stall it does not hurry; ungranted, it stands still, and hears.

The other end is firmware/port/stm32f407/emulator/pace.c.
"""

from __future__ import annotations

import contextlib
import socket
import time
from collections.abc import Callable
from typing import Self

MOST_MS = 20  # that are made up for at once
_PERIOD = 0.002  # s


class Pace:
    """Grants time over a socket."""

    def __init__(self, sock: socket.socket) -> None:
        self._socket = sock

    @classmethod
    def pair(cls) -> tuple[Self, socket.socket]:
        """The granting end, and the board's."""
        ours, theirs = socket.socketpair()
        ours.setblocking(False)
        ours.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 1)  # as small as it gets: some grants
        return cls(ours), theirs

    def grant(self, ms: int) -> None:
        """Lost when the board has not used what it was granted before."""
        with contextlib.suppress(BlockingIOError, ConnectionError):
            self._socket.send(bytes([ms]))

    def close(self) -> None:
        self._socket.close()


def keep_to_our_time(pace: Pace, running: Callable[[], bool]) -> None:
    """Grants as much as has passed here, as long as it is `running`."""
    granted = time.monotonic()
    while running():
        now = time.monotonic()
        granted = max(granted, now - MOST_MS / 1000)
        ms = int((now - granted) * 1000)
        if ms:
            pace.grant(ms)
            granted += ms / 1000
        time.sleep(_PERIOD)
