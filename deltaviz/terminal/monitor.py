"""`deltaviz monitor`: what passes on a link, one line a message, from a capture or a port."""

from __future__ import annotations

import contextlib
import json
import select
import time
from collections.abc import Collection, Iterator
from dataclasses import asdict, dataclass, fields
from enum import Enum, Flag
from pathlib import Path
from typing import Any, get_args

from deltaviz.link import messages
from deltaviz.link.capture.reader import CaptureFile, read_capture
from deltaviz.link.capture.records import Kind, Record, about
from deltaviz.link.capture.replay_board import replay_board
from deltaviz.link.capture.replay_session import replay_session
from deltaviz.link.capture.spoken import Event, ReplayError, connections
from deltaviz.link.serial_link import open_stream, serial_address
from deltaviz.link.traffic import Direction, Garbage, Said, Sender

NAMES = (
    *sorted(kind.__name__ for kind in get_args(messages.HostMessage | messages.BoardMessage)),
    "Garbage",
)
LOOK = 0.2  # s between looks at a file that is being written
_SHOWN = 48  # bytes of garbage


@dataclass(frozen=True, slots=True)
class Note:
    """What is no message: a link was opened, or has ended; records were lost."""

    at: float
    text: str


Item = Said | Garbage | Note


@dataclass(frozen=True, slots=True)
class Filter:
    """`only` and `hide` are names of messages; empty: all, none."""

    only: Collection[str] = ()
    hide: Collection[str] = ()
    sender: Sender | None = None

    def passes(self, item: Item) -> bool:
        if isinstance(item, Note):
            return True
        if self.sender is not None and item.sender is not self.sender:
            return False
        name = type(item.message).__name__ if isinstance(item, Said) else "Garbage"
        return name not in self.hide and (not self.only or name in self.only)


class CaptureItems:
    """Records in, items out."""

    def __init__(self) -> None:
        self._restart()

    def feed(self, record: Record) -> list[Item]:
        match record.kind:
            case Kind.SENT:
                return [*self._host.feed(record.data, record.at)]
            case Kind.RECEIVED:
                return [*self._board.feed(record.data, record.at)]
            case Kind.HEAD:
                self._restart()
                told = ", ".join(f"{key} {value}" for key, value in about(record).items())
                return [Note(0.0, f"capture: {told}")]
            case Kind.OPENED:
                self._restart()
                return [Note(record.at, f"opened {record.text}")]
            case Kind.CLOSED:
                return [Note(record.at, f"closed: {record.text or 'by this program'}")]
            case Kind.LOST:
                return [Note(record.at, f"{record.count} records were lost here")]

    def _restart(self) -> None:
        self._host, self._board = Direction(Sender.HOST), Direction(Sender.BOARD)


def capture_items(path: Path, *, follow: bool) -> Iterator[Item]:
    """All of a capture; with `follow` also what is still being written, for ever.

    Raises CaptureError.
    """
    capture, items = CaptureFile(path), CaptureItems()
    with contextlib.closing(capture):
        while True:
            for record in capture:
                yield from items.feed(record)
            if not follow:
                break
            time.sleep(LOOK)
        if capture.damaged:
            yield Note(0.0, f"{capture.damaged} damaged records were left out")


def port_items(url: str) -> Iterator[Item]:
    """What is heard on a port, which is never written to. Raises LinkError."""
    stream, release = open_stream(serial_address(url))
    line, began = Direction(None), time.monotonic()
    try:
        yield Note(0.0, f"listening on {url}")
        while stream.ended is None:
            select.select([stream.fileno()], [], [], LOOK)
            yield from line.feed(stream.read(), time.monotonic() - began)
        yield Note(time.monotonic() - began, f"closed: {stream.ended}")
    finally:
        stream.close()
        release()


def run(
    *, url: str | None, capture: Path | None, follow: bool, filter_: Filter, as_json: bool
) -> int:
    """Print until it ends, or somebody ends it. The exit status. Raises CaptureError, LinkError."""
    items = capture_items(capture, follow=follow) if capture else port_items(url or "")
    line = json_line if as_json else text_line
    with contextlib.suppress(KeyboardInterrupt):
        for item in items:
            if filter_.passes(item):
                print(line(item), flush=True)
    return 0


def replay(path: Path, what: str, *, as_json: bool) -> int:
    """Print what comes of it; status 1: something else than then. Raises CaptureError, and
    ReplayError when nothing can be replayed.
    """
    replay_one = replay_session if what == "session" else replay_board
    parts = connections(read_capture(path))
    if not parts:
        raise ReplayError(f"{path}: no link was opened while it was written.")
    differs = False
    for records in parts:
        for event in replay_one(records):
            differs = differs or event.differs
            print(json.dumps(asdict(event)) if as_json else _event_line(event))
    return 1 if differs else 0


def _event_line(event: Event) -> str:
    mark = "!" if event.differs else " "
    return f"{event.at:12.6f} {mark} {event.text}"


def text_line(item: Item) -> str:
    if isinstance(item, Note):
        return f"{item.at:12.6f}  -- {item.text}"
    arrow = "host >" if item.sender is Sender.HOST else "< board"
    start = f"{item.at:12.6f}  {arrow:<7}  "
    if isinstance(item, Garbage):
        return f"{start}{'Garbage':<11}    {_garbage(item.data)}"
    number = f"#{item.sequence}" if item.sequence else ""
    values = "  ".join(f"{name} {_text(value)}" for name, value in _fields(item.message))
    return f"{start}{type(item.message).__name__:<10} {number:>4}  {values}".rstrip()


def json_line(item: Item) -> str:
    if isinstance(item, Note):
        return json.dumps({"t_s": item.at, "note": item.text})
    told: dict[str, Any] = {"t_s": item.at, "from": str(item.sender)}
    if isinstance(item, Garbage):
        return json.dumps(told | {"garbage_hex": item.data.hex()})
    told |= {"message": type(item.message).__name__, "sequence": item.sequence}
    told["fields"] = {name: _plain(value) for name, value in _fields(item.message)}
    return json.dumps(told)


def _fields(message: Any) -> list[tuple[str, Any]]:
    return [(field.name, getattr(message, field.name)) for field in fields(message)]


def _text(value: Any) -> str:
    if isinstance(value, Flag):
        return "|".join(_names(value)) or "-"
    if isinstance(value, Enum):
        return value.name
    if isinstance(value, tuple):
        return f"[{' '.join(map(_text, value))}]"
    if isinstance(value, float):
        return f"{value:.7g}"
    return "-" if value is None else str(value).lower() if isinstance(value, bool) else str(value)


def _plain(value: Any) -> Any:
    if isinstance(value, Flag):
        return _names(value)
    if isinstance(value, Enum):
        return value.name
    if isinstance(value, tuple):
        return [_plain(part) for part in value]
    if isinstance(value, float) and abs(value) == float("inf"):
        return "inf" if value > 0 else "-inf"  # JSON has no such number
    return value


def _names(value: Flag) -> list[str]:
    return [flag.name for flag in type(value) if flag.value and flag in value and flag.name]


def _garbage(data: bytes) -> str:
    shown = data[:_SHOWN]
    more = f" and {len(data) - _SHOWN} more" if len(data) > _SHOWN else ""
    text = "".join(chr(byte) if 0x20 <= byte < 0x7F else "." for byte in shown)
    return f"{shown.hex(' ')}{more}  '{text}'"
