"""Opens and closes the controller's link as the controller says, and carries its messages."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future

from deltaviz.link.messages import HostMessage
from deltaviz.link.transport import LinkError, Transport
from deltaviz.machine.core import CloseLink, Core, OpenLink
from deltaviz.machine.opener import Opener, abandon
from deltaviz.robots import Robot


class LinkKeeper:
    """`open_link` opens a link by its id, for a robot; `opener` decides where that runs."""

    def __init__(
        self, core: Core, *, open_link: Callable[[str, Robot], Transport], opener: Opener
    ) -> None:
        self._core = core
        self._open_link = open_link
        self._opener = opener
        self._opening: Future[Transport] | None = None
        self._transport: Transport | None = None

    @property
    def transport(self) -> Transport | None:
        return self._transport

    def receive(self, now: float) -> None:
        """Hand on what has arrived, and notice what was opened or has ended."""
        self._look_whether_open(now)
        transport = self._transport
        if transport is None:
            return
        self._core.receive(transport.receive(), now, transport.report)
        if transport.closed:
            problem = transport.problem or "The link was closed. Connect again."
            self._transport = None
            transport.close()
            self._core.link_failed(problem, now)

    def send(self, messages: list[HostMessage]) -> None:
        if self._transport is not None:
            for message in messages:
                self._transport.send(message)

    def follow(self) -> bool:
        """Do what the controller wants done with the link; whether there was anything."""
        action = self._core.link_action()
        if action is None:
            return False
        self.close()
        match action:
            case OpenLink(link, robot):
                self._opening = self._opener(lambda: self._open_link(link, robot))
            case CloseLink():
                pass
        return True

    def close(self) -> None:
        if self._opening is not None:
            abandon(self._opening)
            self._opening = None
        if self._transport is not None:
            self._transport.close()
            self._transport = None

    def _look_whether_open(self, now: float) -> None:
        opening = self._opening
        if opening is None or not opening.done():
            return
        self._opening = None
        try:
            self._transport = opening.result()
        except LinkError as error:
            self._core.link_failed(str(error), now)
        else:
            self._core.link_opened(now)
