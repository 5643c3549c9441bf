"""The parts of a capture as a replay needs them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar

from deltaviz.link.capture.records import Kind, Record
from deltaviz.link.messages import BoardMessage, HostMessage
from deltaviz.link.traffic import Direction, Said, Sender

M = TypeVar("M", bound=HostMessage | BoardMessage)


class ReplayError(Exception):
    """This part of a capture cannot be replayed; the text says why."""


@dataclass(frozen=True, slots=True)
class Event:
    """What came of a replay at this time (s); `differs`: not what is in the capture."""

    at: float
    text: str
    differs: bool = False


@dataclass(frozen=True, slots=True)
class Spoken(Generic[M]):
    """One message of a known kind."""

    at: float
    sequence: int
    message: M


def connections(records: Iterable[Record]) -> list[list[Record]]:
    """The records of each opening of a link."""
    found: list[list[Record]] = []
    for record in records:
        if record.kind is Kind.OPENED:
            found.append([record])
        elif found and record.kind is not Kind.HEAD:
            found[-1].append(record)
    return found


def spoken(records: Iterable[Record]) -> Iterator[Said]:
    """All messages of one connection."""
    directions = {Kind.SENT: Direction(Sender.HOST), Kind.RECEIVED: Direction(Sender.BOARD)}
    for record in records:
        if (direction := directions.get(record.kind)) is not None:
            for item in direction.feed(record.data, record.at):
                if isinstance(item, Said):
                    yield item


def of_kind(kind: type[M], said: Sequence[Said]) -> list[Spoken[M]]:
    return [
        Spoken(item.at, item.sequence, item.message)
        for item in said
        if isinstance(item.message, kind)
    ]
