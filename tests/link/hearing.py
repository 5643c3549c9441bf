"""What a test waits for a board to say."""

from __future__ import annotations

import time
from collections.abc import Callable
from multiprocessing.connection import wait
from typing import TypeVar

from deltaviz.link.messages import BoardMessage
from deltaviz.link.transport import Transport

M = TypeVar("M", bound=BoardMessage)
PATIENCE = 60.0  # s, of a loaded machine
LOOK = 0.05  # s


def hear(link: Transport, kind: type[M], when: Callable[[M], object] = bool) -> M:
    """Waits for a message of `kind` that `when` accepts."""
    deadline = time.monotonic() + PATIENCE
    while time.monotonic() < deadline:
        wait([link.fileno()], LOOK)
        for message in link.receive():
            if isinstance(message, kind) and when(message):
                return message
        assert not link.closed, link.problem
    raise AssertionError("the board did not say it")
