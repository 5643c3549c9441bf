"""A bench whose controller talks through a link keeper, as the machine's process has it."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable
from concurrent.futures import Future

from deltaviz.link.messages import HostMessage
from deltaviz.link.transport import Transport
from deltaviz.machine.link_keeper import LinkKeeper
from deltaviz.machine.opener import open_now
from deltaviz.robots import Robot
from tests.machine.conftest import Bench


def at_once(open_: Callable[[], Transport]) -> Future[Transport]:
    future: Future[Transport] = Future()
    open_now(open_, future)
    return future


class KeptBench(Bench):
    """Subclasses give the transport, and the board behind it."""

    _keeper: LinkKeeper | None = None

    @property
    def transport(self) -> Transport | None:
        return None if self._keeper is None else self._keeper.transport

    def close(self) -> None:
        if self._keeper is not None:
            self._keeper.close()

    @abstractmethod
    def _open(self, _link: str, _robot: Robot) -> Transport: ...

    def _turn(self) -> None:
        if self._keeper is None:
            self._keeper = LinkKeeper(self.controller, open_link=self._open, opener=at_once)
        self._keeper.receive(self.now)
        self._send(self._messages())
        self._keeper.follow()

    def _send(self, messages: list[HostMessage]) -> None:
        self.sent += messages
        assert self._keeper is not None
        self._keeper.send(messages)
