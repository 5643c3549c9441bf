"""`deltaviz monitor`: one line a message, from a capture, a growing one, or a port."""

from __future__ import annotations

import json
import re
import signal
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from deltaviz.cli import main
from deltaviz.link.capture.reader import read_capture
from deltaviz.link.capture.records import Kind, Record, head, write_record
from deltaviz.link.messages import (
    BoardState,
    EStop,
    Fault,
    Hello,
    HostMessage,
    Inputs,
    Stop,
    Telemetry,
    TelemetryFlags,
)
from deltaviz.link.traffic import Direction, Garbage, Said, Sender
from deltaviz.link.wire.codec import encode
from deltaviz.link.wire.frames import FrameReader, write_frame
from tests.link.cable import PATIENCE, Cable
from tests.link.capture.make import KEPT

TELEMETRY = Telemetry(
    now=0,
    state=BoardState.DISABLED,
    fault=Fault.NONE,
    epoch=0,
    last_index=0,
    t_queue_end=0,
    free=64,
    inputs=Inputs(0),
    flags=TelemetryFlags(0),
    counts=(0, 0, 0),
)


def run(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, list[str], str]:
    try:
        status = main(["monitor", *arguments])
    except SystemExit as exit:
        status = exit.code if isinstance(exit.code, int) else 1
    out, err = capsys.readouterr()
    return status, out.splitlines(), err


def kept(capsys: pytest.CaptureFixture[str], *options: str) -> list[str]:
    status, lines, _ = run(capsys, "--capture", str(KEPT), *options)
    assert status == 0
    return lines


def test_a_capture_is_one_line_a_message(capsys) -> None:
    lines = kept(capsys)
    assert lines[0].endswith("-- capture: format 1, program tests, robot stm32")
    assert lines[1] == "    0.002000  -- opened memory"
    assert re.fullmatch(r" +0\.004000  host >   Hello +#\d+  version 1", lines[2])
    assert re.search(r"< board  HelloReply +#\d+  version 1  board simulated  build", lines[3])
    assert lines[-1].endswith("-- closed: by this program")
    assert any("state ARMED" in line and "flags HOMED|MOVING" in line for line in lines)
    arm = next(line for line in lines if " Arm " in line)
    assert arm.endswith("epoch 1  t_start 4294908295  counts [0 0 0]")


def test_times_grow(capsys) -> None:
    times = [float(line.split()[0]) for line in kept(capsys)]
    assert times == sorted(times)


def names(lines: list[str]) -> set[str]:
    return {line.split()[3] for line in lines if " -- " not in line}


def test_filters(capsys) -> None:
    everything = names(kept(capsys))
    assert {"Hello", "Telemetry", "Segment", "Stop", "Stopped"} <= everything
    assert names(kept(capsys, "--only", "Arm,Stop")) == {"Arm", "Stop"}
    assert names(kept(capsys, "--hide", "Telemetry, Segment")) == everything - {
        "Telemetry",
        "Segment",
    }
    both = [names(kept(capsys, "--from", side)) for side in ("host", "board")]
    assert both[0] | both[1] == everything
    assert "Telemetry" not in both[0]
    assert "Segment" not in both[1]


def test_json_is_one_object_a_line(capsys) -> None:
    lines = [json.loads(line) for line in kept(capsys, "--json")]
    assert lines[0]["note"].startswith("capture")
    configure = next(line for line in lines if line.get("message") == "Configure")
    assert configure["from"] == "host"
    assert configure["fields"]["kind"] == "ROTARY_DELTA"
    assert configure["fields"]["workspace_x"] == ["-inf", "inf"]
    telemetry = next(line for line in lines if line.get("message") == "Telemetry")
    assert telemetry["fields"]["flags"] == ["HOMED", "CONFIGURED"]


def test_a_replay_is_quiet_about_what_is_the_same(capsys) -> None:
    for what in ("session", "board"):
        status, lines, _ = run(capsys, "--capture", str(KEPT), "--replay", what)
        assert status == 0
        assert lines
        assert not any(" ! " in line for line in lines)


def test_a_replay_that_comes_out_otherwise_is_status_1(capsys, tmp_path: Path) -> None:
    other = tmp_path / "other"
    records = read_capture(KEPT)
    lost = next(k for k, x in enumerate(records) if x.kind is Kind.SENT and _is_segment(x.data))
    del records[lost]
    other.write_bytes(b"".join(write_record(x, k) for k, x in enumerate(records)))
    status, lines, _ = run(capsys, "--capture", str(other), "--replay", "session")
    assert status == 1
    assert any(" ! " in line for line in lines)


def _is_segment(data: bytes) -> bool:
    return any(frame.type == 0x06 for frame in FrameReader().feed(data))


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ([], "either a port's URL or --capture FILE"),
        (["/dev/ttyUSB0", "--capture", "x"], "either a port's URL or --capture FILE"),
        (["/dev/ttyUSB0", "--follow"], "go with --capture"),
        (["/dev/ttyUSB0", "--replay", "board"], "go with --capture"),
        (["--capture", "x", "--only", "Halt"], "there is no message 'Halt'; there is: Arm,"),
        (["--capture", "x", "--from", "nobody"], "nobody"),
    ],
)
def test_bad_usage_is_status_2(capsys, arguments: list[str], says: str) -> None:
    status, _, err = run(capsys, *arguments)
    assert status == 2
    assert says in err


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["--capture", "/none"], "No such file"),
        (["--capture", __file__], "is no capture"),
        (["/dev/ttyNone"], "There is no /dev/ttyNone"),
        (["sim://"], "is not a link"),
    ],
)
def test_what_cannot_be_had_is_status_1(capsys, arguments: list[str], says: str) -> None:
    status, _, err = run(capsys, *arguments)
    assert status == 1
    assert says in err
    assert "Traceback" not in err


class Running:
    """The command as a process, read line by line."""

    def __init__(self, *arguments: str) -> None:
        self.process = subprocess.Popen(
            [sys.executable, "-m", "deltaviz", "monitor", *arguments],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, bufsize=1,
        )  # fmt: skip

    def line(self) -> str:
        assert self.process.stdout is not None
        return self.process.stdout.readline()

    def interrupt(self) -> int:
        self.process.send_signal(signal.SIGINT)
        _, errors = self.process.communicate(timeout=PATIENCE)
        assert errors == ""
        return self.process.returncode


def test_a_growing_capture_is_followed_until_somebody_ends_it(tmp_path: Path) -> None:
    path = tmp_path / "growing"
    path.write_bytes(write_record(head({"robot": "stm32"}), 0))
    monitor = Running("--capture", str(path), "--follow")
    assert "robot stm32" in monitor.line()
    with path.open("ab", buffering=0) as file:
        stop = write_frame(*_frame(Stop()))
        file.write(write_record(Record(Kind.SENT, 1.5, stop), 1))
        assert monitor.line().split() == ["1.500000", "host", ">", "Stop"]
    assert monitor.interrupt() == 0


def test_a_port_is_listened_to_and_never_written_to() -> None:
    cable = Cable()
    monitor = Running(cable.device)
    try:
        assert "listening" in monitor.line()
        cable.say(b"\0" + write_frame(*_frame(Hello(1), 9)))
        assert monitor.line().split()[1:] == ["host", ">", "Hello", "#9", "version", "1"]
        cable.say(b"Grbl 1.1h\r\n")
        assert "Garbage" in (line := monitor.line())
        assert "'Grbl 1.1h..'" in line
        assert cable.hear() == b""
        cable.unplug()
        assert "closed: it was unplugged" in monitor.line()
        assert monitor.process.wait(PATIENCE) == 0
    finally:
        monitor.process.kill()
        monitor.process.communicate()
        cable.unplug()


def _frame(message, sequence: int = 0) -> tuple[int, int, bytes]:
    type_, payload = encode(message)
    return type_, sequence, payload


def test_garbage_between_frames_is_shown_and_costs_no_message() -> None:
    stop = write_frame(*_frame(Stop()))
    line = Direction(None)
    heard = line.feed(b"noise\0" + stop + b"\x03\x01\0" + stop + b"tail", 1.0)
    assert [type(item) for item in heard] == [Garbage, Said, Garbage, Said]
    assert line.feed(b" of text\r\n", 2.0) == [Garbage(2.0, Sender.BOARD, b"tail of text\r\n")]
    endless = [item for _ in range(100) for item in line.feed(b"\x55" * 100, 3.0)]
    assert sum(len(item.data) for item in endless if isinstance(item, Garbage)) > 9000
    assert line.feed(b"\0" + stop, 4.0)[-1] == Said(4.0, Sender.HOST, 0, Stop())


@pytest.mark.parametrize("at", range(1, 39))
@pytest.mark.parametrize("sender", [Sender.BOARD, None])
def test_a_frame_may_arrive_in_two_parts_wherever_it_is_cut(sender: Sender | None, at: int) -> None:
    """As it does through sockets; its bytes may well be a line's end."""
    newline = 0x0A0A0A0A
    telemetry = replace(TELEMETRY, now=newline, counts=(newline,) * 3)
    frame = write_frame(*_frame(telemetry, 10))
    line = Direction(sender)
    assert line.feed(frame[:at], 1.0) == []
    assert line.feed(frame[at:], 2.0) == [Said(2.0, Sender.BOARD, 10, telemetry)]


@pytest.mark.parametrize("message", [Stop(), EStop(), Hello(version=10)])
def test_no_frame_of_a_host_begins_like_a_line_of_text(message: HostMessage) -> None:
    for sequence in range(256):
        frame = write_frame(*_frame(message, sequence))
        for at in range(1, len(frame)):
            assert Direction(Sender.HOST).feed(frame[:at], 0.0) == []


def test_a_host_does_not_say_what_only_boards_say() -> None:
    stop = write_frame(*_frame(Stop()))
    (item,) = Direction(Sender.BOARD).feed(stop, 0.0)
    assert isinstance(item, Garbage)


def test_a_reader_that_leaves_early_is_no_error() -> None:
    with subprocess.Popen(
        [sys.executable, "-m", "deltaviz", "monitor", "--capture", str(KEPT)],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE,
    ) as process:  # fmt: skip
        assert process.stdout is not None
        process.stdout.readline()
        process.stdout.close()
        assert process.stderr is not None
        assert b"Traceback" not in process.stderr.read()
