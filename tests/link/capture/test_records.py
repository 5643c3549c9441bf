"""The format of a capture, and what a reader makes of damaged ones."""

from __future__ import annotations

import zlib
from pathlib import Path

import pytest
from cobs import cobs
from hypothesis import given, settings
from hypothesis import strategies as st

from deltaviz.link.capture.reader import CaptureError, CaptureFile, RecordReader, read_capture
from deltaviz.link.capture.records import DATA_MAX, Kind, Record, about, head, write_record

TIMES = st.integers(0, 2**48 - 1).map(lambda us: us / 1e6)


def test_a_record_is_laid_out_as_described() -> None:
    record = Record(Kind.SENT, 1.000_002, b"\x01\x00\x02")
    body = bytes([4, 7]) + (1_000_002).to_bytes(6, "little") + b"\x01\x00\x02"
    frame = cobs.encode(body + zlib.crc32(body).to_bytes(4, "little")) + b"\0"
    assert write_record(record, 7) == frame
    assert RecordReader().feed(frame) == [record]


def test_a_head_says_what_it_is() -> None:
    (record,) = RecordReader().feed(write_record(head({"robot": "stm32"}), 1))
    assert about(record) == {"format": 1, "robot": "stm32"}


@settings(derandomize=True, deadline=None)
@given(
    st.lists(
        st.builds(
            Record,
            st.sampled_from([Kind.SENT, Kind.RECEIVED, Kind.OPENED]),
            TIMES,
            st.binary(max_size=DATA_MAX),
        ),
        max_size=8,
    ),
    st.data(),
)
def test_whatever_is_written_is_read_in_whatever_pieces(
    records: list[Record], data: st.DataObject
) -> None:
    stream = b"".join(write_record(record, number) for number, record in enumerate(records))
    reader, found = RecordReader(), []
    while stream:
        size = data.draw(st.integers(1, len(stream)))
        found += reader.feed(stream[:size])
        stream = stream[size:]
    assert [(r.kind, r.data) for r in found] == [(r.kind, r.data) for r in records]
    for was, is_ in zip(records, found, strict=True):
        assert is_.at == pytest.approx(was.at, abs=0.6e-6)
    assert reader.damaged == 0


RECORDS = [Record(Kind.SENT, k / 8, bytes([k]) * 20) for k in range(5)]
WHOLE = b"".join(write_record(record, k) for k, record in enumerate(RECORDS))


@pytest.mark.parametrize("cut", range(0, len(WHOLE), 7))
def test_a_file_cut_off_anywhere_has_all_records_before(cut: int) -> None:
    found = RecordReader().feed(WHOLE[:cut])
    assert found == RECORDS[: len(found)]
    assert len(found) == WHOLE[:cut].count(b"\0")


def test_garbage_in_the_middle_costs_one_record() -> None:
    damaged = bytearray(WHOLE)
    damaged[len(WHOLE) // 2] ^= 0x55
    reader = RecordReader()
    found = reader.feed(bytes(damaged))
    assert len(found) >= 3
    assert reader.damaged >= 1
    assert all(record in RECORDS for record in found)


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (b"", "is no capture"),
        (b"any text\n" * 1000, "is no capture"),
        (WHOLE, "is no capture"),
        (write_record(Record(Kind.HEAD, 0.0, b'{"format": 2}'), 1), "format 2"),
    ],
)
def test_what_is_no_capture_is_told_apart(tmp_path: Path, content: bytes, says: str) -> None:
    path = tmp_path / "file"
    path.write_bytes(content)
    with pytest.raises(CaptureError, match=says):
        CaptureFile(path)


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(CaptureError, match="No such file"):
        read_capture(tmp_path / "none")


def test_a_growing_file_is_read_on(tmp_path: Path) -> None:
    path = tmp_path / "growing"
    path.write_bytes(write_record(head({}), 0))
    capture = CaptureFile(path)
    assert [record.kind for record in capture] == [Kind.HEAD]
    assert capture.read() == []
    frame = write_record(RECORDS[1], 1)
    for part in (frame[:9], frame[9:]):
        with path.open("ab") as file:
            file.write(part)
        found = capture.read()
    assert found == [RECORDS[1]]
    capture.close()
