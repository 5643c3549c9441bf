"""What carries messages to a board and back: one contract for every kind of link."""

from __future__ import annotations

from typing import Protocol

from deltaviz.link.messages import BoardMessage, HostMessage
from deltaviz.link.report import LinkReport


class LinkError(Exception):
    """A link that cannot be opened or has ended; the text tells a person why and what to do."""


class Transport(Protocol):
    """One end of a link. Nothing here blocks but `close`, and that for about a second at most.

    A transport has a `fileno`, so `multiprocessing.connection.wait` takes it as it is.
    """

    @property
    def closed(self) -> bool:
        """True once either end is closed: nothing more will come, what is sent is lost."""
        ...

    @property
    def problem(self) -> str | None:
        """Why it closed by itself, for a person; None while it is open or after `close`."""
        ...

    @property
    def report(self) -> LinkReport: ...

    def send(self, message: HostMessage) -> None:
        """Takes a message to be sent; silently lost once closed."""
        ...

    def receive(self) -> list[BoardMessage]:
        """All that has arrived, in order; empty when nothing has."""
        ...

    def fileno(self) -> int:
        """The descriptor that becomes readable when messages arrive; -1: there is none, poll."""
        ...

    def close(self) -> None: ...
