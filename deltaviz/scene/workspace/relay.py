"""A picture that is replaced while somebody looks at it.

viser shows nothing of a node until the page has read its new data, which takes it some frames: so
the newest picture gets a node of its own, and the one before it stays for a moment.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable

import viser

STAYS = 0.25  # s


class Relay:
    """Two nodes below `name`, in turn. Runs in viser's event loop only."""

    def __init__(self, name: str) -> None:
        self._next, self._other = f"{name}/a", f"{name}/b"
        self._newest: viser.SceneNodeHandle | None = None
        self._old: viser.SceneNodeHandle | None = None
        self._leaving: asyncio.TimerHandle | None = None

    def show(self, add: Callable[[str], viser.SceneNodeHandle]) -> None:
        """`add` draws it by the name that it is given."""
        self._drop_old()
        self._old, self._newest = self._newest, add(self._next)
        self._next, self._other = self._other, self._next
        if self._old is not None:
            loop = asyncio.get_running_loop()
            self._leaving = loop.call_later(STAYS, self._drop_old)

    def remove(self) -> None:
        self._drop_old()
        if self._newest is not None:
            self._newest.remove()
            self._newest = None

    def _drop_old(self) -> None:
        if self._leaving is not None:
            self._leaving.cancel()
            self._leaving = None
        if self._old is not None:
            self._old.remove()
            self._old = None
