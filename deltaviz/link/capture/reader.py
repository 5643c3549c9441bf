"""Capture files, read: whole, or while they are being written."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import IO

from deltaviz.link.capture.records import FORMAT, Kind, Record, about, read_record
from deltaviz.link.wire.errors import Malformed
from deltaviz.link.wire.frames import FrameReader

_AT_ONCE = 1 << 16  # bytes


class CaptureError(Exception):
    """A file that is no capture or cannot be opened; the text is for a person."""


class RecordReader:
    """Bytes in, records out. `damaged` counts what was neither."""

    def __init__(self) -> None:
        self._frames = FrameReader()
        self._malformed = 0

    @property
    def damaged(self) -> int:
        return self._frames.dropped + self._malformed

    def feed(self, data: bytes) -> list[Record]:
        records: list[Record] = []
        for frame in self._frames.feed(data):
            try:
                records.append(read_record(frame))
            except Malformed:
                self._malformed += 1
        return records


class CaptureFile:
    """An open capture. Raises CaptureError for what is none, or of a format to come."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._reader = RecordReader()
        self._file = _open(path)
        self._first = self._read()
        if not self._first or self._first[0].kind is not Kind.HEAD:
            self._file.close()
            raise CaptureError(f"{path} is no capture: deltaviz serve --capture FILE writes one.")
        format_ = about(self._first[0]).get("format")
        if format_ != FORMAT:
            self._file.close()
            raise CaptureError(
                f"{path} is a capture of format {format_}; this deltaviz reads format {FORMAT}."
            )

    @property
    def damaged(self) -> int:
        return self._reader.damaged

    def read(self) -> list[Record]:
        """What is there and was not read yet; empty at the end of the file, for now."""
        first, self._first = self._first, []
        return first or self._read()

    def __iter__(self) -> Iterator[Record]:
        """All that is there now."""
        while records := self.read():
            yield from records

    def close(self) -> None:
        self._file.close()

    def _read(self) -> list[Record]:
        while data := self._file.read(_AT_ONCE):
            if records := self._reader.feed(data):
                return records
        return []


def read_capture(path: Path) -> list[Record]:
    """All records of a file. Raises CaptureError."""
    capture = CaptureFile(path)
    try:
        return list(capture)
    finally:
        capture.close()


def _open(path: Path) -> IO[bytes]:
    try:
        return path.open("rb")
    except OSError as error:
        raise CaptureError(f"{path} cannot be read: {error.strerror}.") from error
