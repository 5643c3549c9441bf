"""Real ports (pseudo-terminals, sockets) as transports: bytes, ends, and what can be wrong."""

from __future__ import annotations

import fcntl
import os
import re
import select
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from deltaviz.link.board import SimulatedBoard
from deltaviz.link.board.port import BoardPort
from deltaviz.link.descriptor_stream import DescriptorStream, window
from deltaviz.link.messages import Done, Hello, HelloReply, HostMessage, Keep, Stop, Tool
from deltaviz.link.port_trouble import trouble, users
from deltaviz.link.serial_link import SerialAddress, open_serial, open_stream
from deltaviz.link.stream_transport import StreamTransport
from deltaviz.link.transport import LinkError
from deltaviz.link.wire.codec import decode_host, encode
from deltaviz.link.wire.frames import FrameReader, write_frame
from tests.link.cable import PATIENCE, Cable


@pytest.fixture
def cable() -> Iterator[Cable]:
    cable = Cable()
    yield cable
    cable.unplug()


@pytest.fixture
def link(cable: Cable) -> Iterator[StreamTransport]:
    transport = open_serial(cable.device)
    yield transport
    transport.close()


def until(look, what: str):
    end = time.monotonic() + PATIENCE
    while not (seen := look()):
        assert time.monotonic() < end, what
        time.sleep(0.001)
    return seen


def first_heard(cable: Cable) -> tuple[HostMessage, int]:
    """The first message that comes, and its sequence."""
    reader = FrameReader()
    frame = until(lambda: reader.feed(cable.hear()), "a message")[0]
    return decode_host(frame.type, frame.payload), frame.sequence


def answer(command_sequence: int, name: str) -> bytes:
    type_, payload = encode(Done(name))
    return write_frame(type_, command_sequence, payload)


def test_messages_go_both_ways(cable: Cable, link: StreamTransport) -> None:
    link.send(Tool(on=True, servo_angle=0.5))
    message, sequence = first_heard(cable)
    assert message == Tool(on=True, servo_angle=0.5)
    cable.say(answer(sequence, "tool"))
    assert until(link.receive, "the answer") == [Done("tool")]
    assert link.report.round_trip is not None


def test_its_descriptor_becomes_readable_when_something_comes(
    cable: Cable, link: StreamTransport
) -> None:
    assert select.select([link], [], [], 0)[0] == []
    cable.say(b"\0")
    assert select.select([link], [], [], PATIENCE)[0] == [link]


def test_a_pulled_cable_is_noticed(cable: Cable, link: StreamTransport) -> None:
    link.send(Tool(on=True, servo_angle=0.5))
    _, sequence = first_heard(cable)
    cable.say(answer(sequence, "tool"))
    assert until(link.receive, "the answer") == [Done("tool")]
    cable.unplug()
    until(lambda: link.receive() or link.closed, "the end")
    assert cable.device in str(link.problem)
    assert "unplugged" in str(link.problem)
    assert "connect" in str(link.problem)
    link.send(Stop())  # lost, and no error
    assert link.receive() == []


def test_writing_into_a_pulled_cable_is_noticed(cable: Cable, link: StreamTransport) -> None:
    cable.unplug()
    link.send(Keep(1))
    until(lambda: link.receive() or link.closed, "the end")


def test_after_closing_it_has_no_problem_and_the_port_is_free(
    cable: Cable, link: StreamTransport
) -> None:
    link.close()
    link.close()
    assert link.closed
    assert link.problem is None
    open_serial(cable.device).close()


def test_nobody_reads_and_nobody_waits(cable: Cable, link: StreamTransport) -> None:
    for seen in range(5000):  # far more than the system holds
        link.send(Keep(seen))
    assert not link.closed
    link.send(Stop())
    reader, said = FrameReader(), []

    def drain() -> bool:
        said.extend(decode_host(f.type, f.payload) for f in reader.feed(cable.hear()))
        link.receive()  # sends on
        return Stop() in said

    until(drain, "the stop")
    assert said[-1] == Stop()
    assert said[:-1] == [Keep(seen) for seen in range(len(said) - 1)], "what the system held"
    assert len(said) < 4000


def test_of_what_is_written_the_system_is_given_a_window_at_a_time(
    cable: Cable, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A pseudo-terminal does not tell what lies in it, as a serial port does: this stands in."""
    port = os.open(cable.device, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
    stream = DescriptorStream(port, in_system=100)
    for queued, room in [(0, 100), (100, 0), (140, 0), (99, 1), (40, 60)]:
        monkeypatch.setattr(stream, "_queued", lambda queued=queued: queued)
        assert stream.write(bytes(300)) == room
    os.close(port)


def test_the_window_is_10_ms_of_the_line() -> None:
    assert window(921600) == 921
    assert window(115200) == 115
    assert window(9600) == 64, "one small frame at least"


def test_of_a_socket_and_a_terminal_the_system_tells_what_is_unsent(cable: Cable) -> None:
    near, far = socket.socketpair()
    with near, far:
        stream = DescriptorStream(near.fileno(), in_system=1 << 20)
        assert stream._queued() == 0
        stream.write(bytes(1000))
        assert stream._queued() >= 1000
        far.recv(2000)
        assert stream._queued() == 0


@pytest.fixture
def server() -> Iterator[socket.socket]:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        listener.settimeout(PATIENCE)
        yield listener


def test_a_socket_is_a_link_without_delay(server: socket.socket) -> None:
    url = f"socket://127.0.0.1:{server.getsockname()[1]}"
    stream, release = open_stream(SerialAddress(url))
    far, _ = server.accept()
    with far:
        own = socket.socket(fileno=os.dup(stream.fileno()))
        with own:
            assert own.getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY)
        assert stream.write(b"hello") == 5
        assert far.recv(10) == b"hello"
        far.sendall(b"answer")
        assert until(stream.read, "the answer") == b"answer"
    until(lambda: stream.read() or stream.ended, "the end")
    stream.close()
    release()


def test_a_board_behind_a_socket_says_hello(server: socket.socket) -> None:
    link = open_serial(f"socket://127.0.0.1:{server.getsockname()[1]}")
    far, _ = server.accept()
    port = BoardPort(SimulatedBoard())
    with far:
        link.send(Hello(1))
        port.feed(far.recv(1000))
        far.sendall(b"".join(port.take()))
        said = until(link.receive, "the answer")
        assert [type(message) for message in said][:1] == [HelloReply]
    until(lambda: link.receive() or link.closed, "the end")
    assert "ended" in str(link.problem)
    link.close()


def test_what_has_no_descriptor_is_pumped() -> None:
    """loop:// gives back what it is given."""
    stream, release = open_stream(SerialAddress("loop://"))
    data = bytes(range(256)) * 20
    sent = got = b""
    end = time.monotonic() + PATIENCE
    while got != data:
        assert time.monotonic() < end
        sent = data[: len(sent) + stream.write(data[len(sent) :])]
        select.select([stream.fileno()], [], [], 0.01)
        got += stream.read()
    assert stream.ended is None
    threads = [t for t in threading.enumerate() if t.name == "serial"]
    stream.close()
    release()
    assert stream.ended == "it was closed"
    assert not any(thread.is_alive() for thread in threads)


def test_a_spied_port_is_read_through_the_spy(cable: Cable, tmp_path: Path) -> None:
    log = tmp_path / "seen"
    stream, release = open_stream(SerialAddress(f"spy://{cable.device}?file={log}"))
    stream.write(b"\x01\x02")
    assert cable.hear_bytes(2) == b"\x01\x02"
    stream.close()
    release()
    assert "01 02" in log.read_text()


def test_a_pump_that_fails_ends_the_stream(cable: Cable, tmp_path: Path) -> None:
    stream, release = open_stream(SerialAddress(f"spy://{cable.device}?file={tmp_path / 'seen'}"))
    cable.unplug()
    until(lambda: stream.read() or stream.ended, "the end")
    assert "ended" in str(stream.ended)
    stream.close()
    release()


# What is wrong with a port, and the way out.


def refusal(url: str) -> str:
    with pytest.raises(LinkError) as refused:
        open_serial(url)
    return str(refused.value)


def test_a_port_that_is_not_there(tmp_path: Path) -> None:
    device = str(tmp_path / "ttyUSB7")
    assert refusal(device).startswith(f"There is no {device}. Plug the board in")


HOLDER = "import serial, sys; s = serial.Serial(sys.argv[1], exclusive=True); print(); input()"


def test_a_port_in_use_names_the_program_that_uses_it(cable: Cable) -> None:
    with subprocess.Popen(
        [sys.executable, "-c", HOLDER, cable.device], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    ) as holder:
        assert holder.stdout is not None
        holder.stdout.readline()
        said = refusal(f"serial://{cable.device}")
        assert re.search(rf"in use by python\S* \(process {holder.pid}\)", said)
        assert "End that, then connect" in said
        assert users(cable.device)[0][0] == holder.pid
        holder.kill()


def test_a_port_that_this_program_has_open_cannot_be_opened_twice(
    cable: Cable, link: StreamTransport
) -> None:
    assert "in use by another program" in refusal(cable.device)


def test_a_port_without_permission_names_the_group(
    cable: Cable, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Root may do all: the refusal is the system's own, the file's group and mode are real."""
    os.chmod(cable.device, 0o660)
    os.chown(cable.device, -1, 20)  # dialout, on Debian
    said = trouble(cable.device, PermissionError(13, "Permission denied"))
    assert said == (
        f"{cable.device} may not be opened. Join the group dialout that may: "
        "sudo usermod -aG dialout $USER, log out and in again, then connect."
    )
    os.chmod(cable.device, 0o600)
    said = trouble(cable.device, PermissionError(13, "Permission denied"))
    assert said == f"{cable.device} may not be opened. Ask its owner for permission."


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can become somebody who may not")
def test_the_system_refuses_and_the_refusal_is_understood(cable: Cable) -> None:
    os.chmod(cable.device, 0o600)
    code = (
        "import grp, os, sys; from deltaviz.link.serial_link import open_serial, LinkError\n"
        "try: open_serial('/none')  # imports what it needs\n"
        "except LinkError: pass\n"
        "os.setgid(65534); os.setuid(65534)\n"
        "try: open_serial(sys.argv[1])\n"
        "except LinkError as error: print(error)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, cable.device], capture_output=True, text=True, check=True
    )
    assert f"{cable.device} may not be opened." in done.stdout


@pytest.mark.parametrize("path", ["/dev/null", __file__, str(Path(__file__).parent)])
def test_what_is_no_serial_port(path: str) -> None:
    assert refusal(path) == (
        f"{path} is no serial port. Choose another (deltaviz ports lists them)."
    )


def test_a_device_that_fails() -> None:
    said = trouble("/dev/ttyUSB0", OSError(5, "Input/output error"))
    assert said.startswith("/dev/ttyUSB0 does not work (Input/output error). Pull")


def test_nobody_listens_at_the_address(server: socket.socket) -> None:
    port = server.getsockname()[1]
    server.close()
    said = refusal(f"socket://127.0.0.1:{port}")
    assert "Connection refused" in said
    assert "check" in said.lower()


@pytest.mark.parametrize("url", ["socket://", "socket://127.0.0.1", "rfc2217://x:y", "loop://?x=1"])
def test_an_address_that_is_none(url: str) -> None:
    assert url.split("?")[0] in refusal(url)


def test_a_port_is_claimed_against_those_who_ask_for_no_lock(cable: Cable) -> None:
    from deltaviz.link import serial_link

    port = os.open(cable.device, os.O_RDWR | os.O_NOCTTY)
    try:
        serial_link.claim(port, "/dev/ttyUSB0")
        assert exclusive(port)
        fcntl.ioctl(port, 0x540D)  # TIOCNXCL
        serial_link.claim(port, cable.device)
        assert not exclusive(port), "a pseudo-terminal would stay claimed after a crash"
    finally:
        os.close(port)


def exclusive(port: int) -> bool:
    tiocgexcl = 0x80045440
    return fcntl.ioctl(port, tiocgexcl, b"\0\0\0\0") != b"\0\0\0\0"
