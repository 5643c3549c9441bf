"""How the surfaces reach the machine, wherever it runs."""

from __future__ import annotations

from concurrent.futures import Future
from typing import Protocol

from deltaviz.link.links import Link
from deltaviz.machine.intent import Answer, Intent
from deltaviz.machine.snapshot import Snapshot
from deltaviz.robots import Robot
from deltaviz.robots.load import Loaded


class MachinePort(Protocol):
    """Thread-safe. `post` never blocks; its future is answered by the controller."""

    @property
    def snapshot(self) -> Snapshot:
        """The newest picture of the machine."""
        ...

    @property
    def robot(self) -> Robot:
        """The robot that the controller drives now."""
        ...

    @property
    def loaded(self) -> Loaded:
        """`robot` with the text of its file."""
        ...

    def links(self) -> tuple[Link, ...]:
        """The links that may be chosen now. Asks the system, which takes some milliseconds."""
        ...

    def post(self, intent: Intent) -> Future[Answer]: ...

    def stop(self, client: str, reason: str) -> None:
        """A controlled stop, by a pipe of its own that is read before all else."""
        ...

    def estop(self, client: str, reason: str) -> None:
        """Drivers off, by the same pipe."""
        ...
