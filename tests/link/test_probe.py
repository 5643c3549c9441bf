"""Ports are asked gently, all at once, in bounded time."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Iterator

import pytest

from deltaviz.link import probe as probing
from deltaviz.link.board import SimulatedBoard
from deltaviz.link.board.port import BoardPort
from deltaviz.link.impression import Kind
from deltaviz.link.messages import Hello
from deltaviz.link.probe import Finding, gentle_hello, probe, probe_all
from deltaviz.link.serial_link import SerialAddress, open_serial
from deltaviz.link.wire.codec import decode_host
from deltaviz.link.wire.frames import FrameReader
from tests.link.cable import PATIENCE, Cable
from tests.link.strangers import Deaf, Gps, OtherBaud, OtherVersion, Stranger, echo, silent


class Plugged:
    """A stranger at the end of a cable, in a thread of its own; `heard` is what it was sent."""

    def __init__(self, stranger: Stranger) -> None:
        self.cable = Cable()
        self.heard = b""
        self._stranger = stranger
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._run)
        self._thread.start()

    def _run(self) -> None:
        while not self._over.wait(0.005):
            data = self.cable.hear()
            self.heard += data
            self.cable.say(self._stranger(data))

    def close(self) -> None:
        self._over.set()
        self._thread.join()
        self.cable.unplug()


@pytest.fixture
def plug() -> Iterator[Callable[[Stranger], Plugged]]:
    plugged: list[Plugged] = []

    def plug_in(stranger: Stranger) -> Plugged:
        plugged.append(Plugged(stranger))
        return plugged[-1]

    yield plug_in
    for one in plugged:
        one.close()


class Board:
    def __init__(self) -> None:
        self._port = BoardPort(SimulatedBoard(boot=4))

    def __call__(self, heard: bytes) -> bytes:
        self._port.feed(heard)
        self._port.board.advance(1000)
        return b"".join(self._port.take())


def test_a_board_says_who_it_is(plug) -> None:
    device = plug(Board()).cable.device
    for _ in range(3):  # again and again
        finding = probe(SerialAddress(device))
        assert finding.board is not None
        assert finding.board.board == "simulated"
        assert finding.board.boot == 4


def test_a_board_in_a_session_is_heard_and_asked(plug) -> None:
    board = Board()
    board(gentle_hello())
    finding = probe(SerialAddress(plug(board).cable.device))
    assert finding.board is not None


def test_a_board_of_another_version_says_so(plug) -> None:
    finding = probe(SerialAddress(plug(OtherVersion(9)).cable.device))
    assert finding.board is not None
    assert finding.board.version == 9


@pytest.mark.parametrize(
    ("stranger", "kind"),
    [(silent, Kind.NOTHING), (echo, Kind.ECHO), (Gps(), Kind.TEXT), (OtherBaud(), Kind.NOISE),
     (Deaf(), Kind.BOARD)],
    ids=["silent", "echo", "gps", "noise", "deaf"],
)  # fmt: skip
def test_whatever_else_is_there_is_no_board(plug, stranger: Stranger, kind: Kind) -> None:
    finding = probe(SerialAddress(plug(stranger).cable.device))
    assert finding.board is None
    assert finding.problem is None
    assert finding.impression.kind is kind


@pytest.mark.parametrize("stranger", [Gps(), OtherBaud()], ids=["gps", "noise"])
def test_what_speaks_another_language_is_not_written_to(plug, stranger: Stranger) -> None:
    plugged = plug(stranger)
    probe(SerialAddress(plugged.cable.device))
    assert plugged.heard == b""


def test_what_is_silent_is_sent_one_hello_and_nothing_more(plug) -> None:
    plugged = plug(silent)
    probe(SerialAddress(plugged.cable.device))
    (frame,) = FrameReader().feed(plugged.heard)
    assert decode_host(frame.type, frame.payload) == Hello(1)


def test_a_hello_has_no_byte_that_does_something_elsewhere() -> None:
    hellos = {gentle_hello() for _ in range(500)}
    assert len(hellos) > 20, "two in a row are seldom the same: a board would repeat its answer"
    for hello in hellos:
        (frame,) = FrameReader().feed(hello)
        assert decode_host(frame.type, frame.payload) == Hello(1)
        assert not set(hello) & {3, 10, 13, 17, 19, 24, 27, 33, 63, 126}
        assert not any(0x84 <= byte <= 0xA1 for byte in hello)


def test_a_port_that_cannot_be_opened_says_why(plug) -> None:
    device = plug(silent).cable.device
    holder = open_serial(device)
    try:
        assert "in use by" in str(probe(SerialAddress(device)).problem)
    finally:
        holder.close()
    assert str(probe(SerialAddress("/dev/ttyNone")).problem).startswith("There is no")


def test_many_ports_are_asked_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each waits for all the others: one after the other they would wait for ever."""
    devices = [f"port {k}" for k in range(8)]
    together = threading.Barrier(len(devices), timeout=PATIENCE)

    def ask(address: SerialAddress) -> Finding:
        together.wait()
        return Finding(problem=address.target)

    monkeypatch.setattr(probing, "probe", ask)
    monkeypatch.setattr(probing, "OPENING", PATIENCE)
    assert {device: found.problem for device, found in probe_all(devices).items()} == {
        device: device for device in devices
    }


def test_a_port_that_hangs_is_given_up_and_keeps_nobody(monkeypatch: pytest.MonkeyPatch) -> None:
    opened = threading.Event()

    def hang(address: SerialAddress) -> Finding:
        if address.target == "hangs":
            opened.wait()
        return Finding(problem="fine")

    monkeypatch.setattr(probing, "probe", hang)
    monkeypatch.setattr(probing, "OPENING", 0.0)
    findings = probe_all(["works", "hangs"])
    assert findings["works"].problem == "fine"
    assert "hangs when it is opened" in str(findings["hangs"].problem)
    opened.set()


def test_nothing_is_left_open(plug) -> None:
    device = plug(Board()).cable.device
    before = len(os.listdir("/proc/self/fd"))
    probe(SerialAddress(device))
    assert len(os.listdir("/proc/self/fd")) == before
