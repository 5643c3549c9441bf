"""Messages over any stream of bytes: what all transports to a board have in common."""

from __future__ import annotations

import time
from collections.abc import Callable
from random import randint

from deltaviz.link.impression import Listener
from deltaviz.link.messages import BoardMessage, EStop, HostMessage, Stop
from deltaviz.link.report import LinkReport
from deltaviz.link.wire.delivery import Delivery
from deltaviz.link.wire.stream import ByteStream, Outbox


class Channel:
    """The host's end. `receive` is called every few milliseconds: it also repeats what is due."""

    def __init__(self, stream: ByteStream, clock: Callable[[], float] = time.monotonic) -> None:
        """`clock` gives seconds."""
        self._stream = stream
        self._clock = clock
        self._delivery = Delivery(randint(1, 255))
        self._outbox = Outbox(stream)
        self._listener = Listener()

    @property
    def ended(self) -> str | None:
        """Why nothing can come any more; None while it lives."""
        return "it has stopped reading" if self._outbox.overflowed else self._stream.ended

    @property
    def report(self) -> LinkReport:
        delivery = self._delivery
        return LinkReport(
            dropped=delivery.dropped,
            repeated=delivery.repeated,
            round_trip=delivery.round_trip,
            impression=self._listener.impression,
        )

    def send(self, message: HostMessage) -> None:
        if self.ended is None:
            frames = self._delivery.send(message, self._clock())
            self._outbox.put(frames, stop=isinstance(message, Stop | EStop))

    def receive(self) -> list[BoardMessage]:
        """All that has arrived, in order, also what came before the end."""
        now = self._clock()
        data = self._stream.read()
        self._listener.hear(data)
        said, frames = self._delivery.receive(data, now)
        if self.ended is None:
            self._outbox.put(frames + self._delivery.due(now))
        return said

    def fileno(self) -> int:
        return self._stream.fileno()

    def close(self) -> None:
        self._stream.close()
