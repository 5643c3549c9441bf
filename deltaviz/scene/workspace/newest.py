"""One order of a kind at a time: a hand that moves faster than pictures are made waits for none of
them, and starves none."""

from __future__ import annotations

from collections.abc import Callable

from deltaviz.scene.workspace.tasks import Task


class Newest:
    """What is ordered while its like is computed waits, and of that only the newest.

    `send(topic, task)` orders, or with None cancels.
    """

    def __init__(self, send: Callable[[str, Task | None], None]) -> None:
        self._send = send
        self._computed: set[str] = set()
        self._waiting: dict[str, Task] = {}

    def tell(self, topic: str, task: Task | None) -> None:
        """Order it; None: nothing of the kind is wanted any more."""
        if task is not None and topic in self._computed:
            self._waiting[topic] = task
            return
        self._computed.discard(topic)
        self._waiting.pop(topic, None)
        if task is not None:
            self._computed.add(topic)
        self._send(topic, task)

    def came(self, topic: str) -> None:
        """What was ordered has come, or a first draft of it."""
        self._computed.discard(topic)
        if topic in self._waiting:
            self.tell(topic, self._waiting.pop(topic))
