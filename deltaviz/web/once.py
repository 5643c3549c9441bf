"""Bad input is logged once a minute per kind and client: never a flood of lines."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Hashable

_QUIET = 60.0  # s between two lines about the same thing
_REMEMBERED = 256


class OncePerMinute:
    """Says whether a thing may be logged now."""

    def __init__(self, *, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._said: dict[Hashable, float] = {}

    def may_say(self, kind: Hashable) -> bool:
        now = self._clock()
        said = self._said.get(kind)
        if said is not None and now - said < _QUIET:
            return False
        if len(self._said) >= _REMEMBERED:
            self._forget_oldest()
        self._said[kind] = now
        return True

    def _forget_oldest(self) -> None:
        oldest = min(self._said, key=lambda kind: self._said[kind])
        del self._said[oldest]


class OncePerMinuteFilter(logging.Filter):
    """For loggers of others: the same text passes once a minute."""

    def __init__(self) -> None:
        super().__init__()
        self._once = OncePerMinute()

    def filter(self, record: logging.LogRecord) -> bool:
        return self._once.may_say((record.name, record.msg))
