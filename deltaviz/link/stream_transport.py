"""Messages over a stream of bytes, as a transport."""

from __future__ import annotations

import time
from collections.abc import Callable

from deltaviz.link.messages import BoardMessage, HostMessage
from deltaviz.link.report import LinkReport
from deltaviz.link.wire.channel import Channel
from deltaviz.link.wire.stream import ByteStream


class StreamTransport:
    """`broke` makes a sentence of why the stream ended; `release` frees what carries it, once."""

    def __init__(
        self,
        stream: ByteStream,
        *,
        broke: Callable[[str], str],
        release: Callable[[], None] = lambda: None,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._channel = Channel(stream, clock)
        self._broke = broke
        self._release = release
        self._closed = False

    @property
    def closed(self) -> bool:
        return self._closed or self._channel.ended is not None

    @property
    def problem(self) -> str | None:
        reason = self._channel.ended
        return None if self._closed or reason is None else self._broke(reason)

    @property
    def report(self) -> LinkReport:
        return self._channel.report

    def send(self, message: HostMessage) -> None:
        if not self.closed:
            self._channel.send(message)

    def receive(self) -> list[BoardMessage]:
        return [] if self._closed else self._channel.receive()

    def fileno(self) -> int:
        return self._channel.fileno()

    def close(self) -> None:
        if not self._closed:
            self._closed = True
            self._channel.close()
            self._release()
