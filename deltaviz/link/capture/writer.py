"""A capture as it is written: by a thread of its own, so that no disk holds up the control loop."""

from __future__ import annotations

import contextlib
import os
import threading
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from deltaviz.link.capture.reader import CaptureError, CaptureFile
from deltaviz.link.capture.records import DATA_MAX, Kind, Record, head, write_record
from deltaviz.link.wire.stream import ByteStream

WAITING_MAX = 1 << 20  # bytes: a minute of a moving robot
PERIOD = 0.1  # s between writes
_PATIENCE = 1.0  # s for the last one


@dataclass(frozen=True, slots=True)
class CaptureStatus:
    """`lost` counts the records that could not be kept; `problem` says why, for a person."""

    name: str
    size: int  # bytes written
    lost: int
    problem: str | None


def check_capture(path: Path) -> None:
    """Raises CaptureError when a capture cannot be written there. A capture is added to."""
    if path.exists() and path.stat().st_size:
        CaptureFile(path).close()
    try:
        with path.open("ab"):
            pass
    except OSError as error:
        raise CaptureError(f"{path} cannot be written: {error.strerror}.") from error


class CaptureWriter:
    """Appends to `path`. `record` never waits: what does not fit in memory is counted, and told.

    `about` stands in the head. Raises CaptureError as `check_capture` does.
    """

    def __init__(
        self, path: Path, about: dict[str, str], *, clock: Callable[[], float] = time.monotonic
    ) -> None:
        check_capture(path)
        self._name = path.name
        self._clock = clock
        self._began = clock()
        self._file = os.open(path, os.O_WRONLY | os.O_APPEND | os.O_CREAT | os.O_CLOEXEC, 0o644)
        self._waiting: deque[Record] = deque()
        self._taken = self._written = 0  # bytes of data; each counted by one thread only
        self._lost = 0
        self._told_lost = 0
        self._number = 0
        self._size = 0
        self._problem: str | None = None
        self._closing = threading.Event()
        self._write(b"\0" + self._numbered(head(about)))  # ends what a crash has left
        self._thread = threading.Thread(target=self._run, name="capture", daemon=True)
        self._thread.start()

    @property
    def status(self) -> CaptureStatus:
        return CaptureStatus(self._name, self._size, self._lost, self._problem)

    def record(self, kind: Kind, data: bytes) -> None:
        """From the control loop."""
        if self._problem is not None or self._taken - self._written > WAITING_MAX:
            self._lost += 1
            return
        at = self._clock() - self._began
        for start in range(0, max(1, len(data)), DATA_MAX):
            part = data[start : start + DATA_MAX]
            self._taken += len(part)
            self._waiting.append(Record(kind, at, part))

    def tap(self, name: str, stream: ByteStream) -> ByteStream:
        """`stream`, with all that passes recorded."""
        return _TappedStream(name, stream, self)

    def close(self) -> None:
        self._closing.set()
        self._thread.join(_PATIENCE)

    def _run(self) -> None:
        while not self._closing.wait(PERIOD):
            self._write_waiting()
        self._write_waiting()
        with contextlib.suppress(OSError):
            os.close(self._file)

    def _write_waiting(self) -> None:
        parts: list[bytes] = []
        while self._waiting:
            record = self._waiting.popleft()
            self._written += len(record.data)
            parts.append(self._numbered(record))
        if (lost := self._lost) > self._told_lost:
            data = (lost - self._told_lost).to_bytes(4, "little")
            self._told_lost = lost
            parts.append(self._numbered(Record(Kind.LOST, self._clock() - self._began, data)))
        if parts and self._problem is None:
            self._write(b"".join(parts))

    def _numbered(self, record: Record) -> bytes:
        self._number += 1
        return write_record(record, self._number)

    def _write(self, data: bytes) -> None:
        try:
            while data:
                count = os.write(self._file, data)
                self._size += count
                data = data[count:]
        except OSError as error:
            self._problem = f"The capture has ended: {error.strerror}."


class _TappedStream:
    """Its own first and last word are the opening and the end."""

    def __init__(self, name: str, stream: ByteStream, capture: CaptureWriter) -> None:
        self._stream = stream
        self._capture = capture
        self._open = True
        capture.record(Kind.OPENED, name.encode())

    @property
    def ended(self) -> str | None:
        return self._stream.ended

    def write(self, data: bytes) -> int:
        taken = self._stream.write(data)
        if taken:
            self._capture.record(Kind.SENT, data[:taken])
        return taken

    def read(self) -> bytes:
        data = self._stream.read()
        if data:
            self._capture.record(Kind.RECEIVED, data)
        return data

    def fileno(self) -> int:
        return self._stream.fileno()

    def close(self) -> None:
        if self._open:
            self._open = False
            self._capture.record(Kind.CLOSED, (self._stream.ended or "").encode())
        self._stream.close()
