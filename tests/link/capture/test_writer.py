"""Writing a capture holds up nobody, and what it could not keep is counted and told."""

from __future__ import annotations

import errno
import os
import threading
from pathlib import Path

import pytest

from deltaviz.link.capture import writer
from deltaviz.link.capture.reader import CaptureError, read_capture
from deltaviz.link.capture.records import DATA_MAX, Kind, about
from deltaviz.link.capture.writer import WAITING_MAX, CaptureWriter, check_capture
from deltaviz.link.socket_stream import SocketStream

PATIENCE = 20.0  # s


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "a.capture"


class Clock:
    now = 100.0

    def __call__(self) -> float:
        return self.now


class SlowDisk:
    """A disk that takes nothing until it is told to."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.works = threading.Event()
        self.asked = threading.Event()
        write = os.write

        def slow(file: int, data: bytes) -> int:
            if threading.current_thread().name == "capture":
                self.asked.set()
                assert self.works.wait(PATIENCE)
            return write(file, data)

        monkeypatch.setattr(writer.os, "write", slow)


def test_what_was_recorded_is_in_the_file_with_its_times(path: Path) -> None:
    clock = Clock()
    capture = CaptureWriter(path, {"robot": "stm32"}, clock=clock)
    capture.record(Kind.OPENED, b"ttyusb0")
    clock.now += 0.25
    capture.record(Kind.SENT, b"hello")
    clock.now += 0.5
    capture.record(Kind.RECEIVED, b"answer")
    capture.close()
    first, *records = read_capture(path)
    assert about(first)["robot"] == "stm32"
    assert [(r.kind, r.at, r.data) for r in records] == [
        (Kind.OPENED, 0.0, b"ttyusb0"),
        (Kind.SENT, 0.25, b"hello"),
        (Kind.RECEIVED, 0.75, b"answer"),
    ]
    assert capture.status.lost == 0
    assert capture.status.size == path.stat().st_size


def test_long_data_is_several_records(path: Path) -> None:
    capture = CaptureWriter(path, {})
    data = os.urandom(3 * DATA_MAX + 5)
    capture.record(Kind.RECEIVED, data)
    capture.close()
    _, *records = read_capture(path)
    assert len(records) == 4
    assert b"".join(r.data for r in records) == data


def test_a_disk_that_hangs_holds_up_nobody_and_loses_a_counted_number(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    disk = SlowDisk(monkeypatch)
    capture = CaptureWriter(path, {})
    capture.record(Kind.SENT, b"first")
    assert disk.asked.wait(PATIENCE), "the thread is in the disk"
    count, size = 3000, 500
    for _ in range(count):
        capture.record(Kind.SENT, bytes(size))
    kept = WAITING_MAX // size + 1
    assert capture.status.lost == count - kept
    disk.works.set()
    capture.close()
    _, *records = read_capture(path)
    assert sum(r.kind is Kind.SENT for r in records) == 1 + kept
    assert [r.count for r in records if r.kind is Kind.LOST] == [count - kept]


def test_a_full_disk_is_told_and_ends_the_capture(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    capture = CaptureWriter(path, {})
    full = threading.Event()

    def fail(_file: int, _data: bytes) -> int:
        full.set()
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(writer.os, "write", fail)
    capture.record(Kind.SENT, b"x")
    assert full.wait(PATIENCE)
    capture.close()
    assert capture.status.problem == "The capture has ended: No space left on device."
    capture.record(Kind.SENT, b"y")
    assert capture.status.lost == 1


def test_a_capture_is_added_to_also_after_a_crash(path: Path) -> None:
    for run in ("first", "second"):
        capture = CaptureWriter(path, {"run": run})
        capture.record(Kind.SENT, run.encode())
        capture.close()
        if run == "first":
            path.write_bytes(path.read_bytes()[:-3])  # the last record was cut off
    records = read_capture(path)
    assert [about(r)["run"] for r in records if r.kind is Kind.HEAD] == ["first", "second"]
    assert [r.data for r in records if r.kind is Kind.SENT] == [b"second"]


def test_another_file_is_not_added_to(path: Path) -> None:
    path.write_text("a letter, perhaps\n")
    with pytest.raises(CaptureError, match="is no capture"):
        check_capture(path)
    with pytest.raises(CaptureError):
        CaptureWriter(path, {})
    assert path.read_text() == "a letter, perhaps\n"


def test_a_place_where_nothing_can_be_written(tmp_path: Path) -> None:
    with pytest.raises(CaptureError, match="cannot be written: No such file or directory"):
        check_capture(tmp_path / "none" / "a.capture")
    with pytest.raises(CaptureError, match="directory"):
        check_capture(tmp_path)


def test_a_tapped_stream_is_the_stream_and_all_that_passes_is_kept(path: Path) -> None:
    import socket

    capture = CaptureWriter(path, {})
    near, far = socket.socketpair()
    with far:
        stream = capture.tap("ttyusb0", SocketStream(near))
        assert stream.write(b"to the board") == 12
        assert far.recv(100) == b"to the board"
        far.send(b"to the host")
        assert stream.fileno() == near.fileno()
        assert stream.read() == b"to the host"
        assert stream.read() == b""
    assert stream.read() == b""
    assert stream.ended == "it has ended"
    stream.close()
    stream.close()
    capture.close()
    _, *records = read_capture(path)
    assert [(r.kind.name, r.data) for r in records] == [
        ("OPENED", b"ttyusb0"),
        ("SENT", b"to the board"),
        ("RECEIVED", b"to the host"),
        ("CLOSED", b"it has ended"),
    ]


def test_only_what_the_stream_took_is_recorded_as_sent(path: Path) -> None:
    class Narrow:
        ended = None

        def write(self, data: bytes) -> int:
            return 3

        def read(self) -> bytes:
            return b""

        def fileno(self) -> int:
            return -1

        def close(self) -> None:
            pass

    capture = CaptureWriter(path, {})
    assert capture.tap("x", Narrow()).write(b"12345") == 3
    capture.close()
    assert [r.data for r in read_capture(path) if r.kind is Kind.SENT] == [b"123"]
