"""A serial server by RFC 2217, as pyserial brings one: the link by rfc2217:// is pumped to it."""

from __future__ import annotations

import contextlib
import select
import socket
import threading
import time
from collections.abc import Callable, Iterator
from types import SimpleNamespace
from typing import Any, cast

import pytest
from serial.rfc2217 import PortManager

from deltaviz.link.messages import Done, Tool
from deltaviz.link.serial_link import open_serial
from deltaviz.link.wire.codec import decode_host, encode
from deltaviz.link.wire.frames import Frame, FrameReader, write_frame
from tests.link.cable import PATIENCE


class Server:
    """`port` is what the client has asked of the serial port; it answers frames by `answer`."""

    def __init__(self, answer: Callable[[Frame], bytes]) -> None:
        self.port = SimpleNamespace(
            baudrate=9600, bytesize=8, parity="N", stopbits=1, cts=True, dsr=True, ri=False,
            cd=True, rtscts=False, xonxoff=False, dtr=False, rts=False, break_condition=False,
            reset_input_buffer=lambda: None, reset_output_buffer=lambda: None,
        )  # fmt: skip
        self._answer = answer
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.url = f"rfc2217://127.0.0.1:{self._listener.getsockname()[1]}"
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._run)
        self._thread.start()

    def _run(self) -> None:
        client, _ = self._listener.accept()
        reader = FrameReader()
        with client, contextlib.suppress(OSError):
            writer = SimpleNamespace(write=client.sendall)
            manager = PortManager(cast("Any", self.port), cast("Any", writer))
            while not self._over.is_set():
                if not select.select([client], [], [], 0.05)[0]:
                    continue
                data = client.recv(4096)
                if not data:
                    return
                for frame in reader.feed(b"".join(manager.filter(data))):
                    client.sendall(b"".join(manager.escape(self._answer(frame))))

    def close(self) -> None:
        self._over.set()
        self._thread.join()
        self._listener.close()


def done(frame: Frame) -> bytes:
    assert decode_host(frame.type, frame.payload) == Tool(on=True, servo_angle=0.25)
    type_, payload = encode(Done("tool"))
    return write_frame(type_, frame.sequence, payload)


@pytest.fixture
def server() -> Iterator[Server]:
    server = Server(done)
    yield server
    server.close()


@pytest.mark.filterwarnings("ignore::DeprecationWarning")  # pyserial's own thread
def test_messages_go_both_ways_and_the_end_is_noticed(server: Server) -> None:
    link = open_serial(f"{server.url}?baud=115200")
    assert server.port.baudrate == 115200
    link.send(Tool(on=True, servo_angle=0.25))
    said, end = [], time.monotonic() + PATIENCE
    while not said:
        assert time.monotonic() < end
        select.select([link.fileno()], [], [], 0.1)
        said = link.receive()
    assert said == [Done("tool")]
    server.close()
    end = time.monotonic() + PATIENCE
    while not link.closed:
        assert time.monotonic() < end
        link.receive()
    assert server.url in str(link.problem)
    link.close()
