"""`deltaviz ports`: what stands at each port, for people and for scripts."""

from __future__ import annotations

import json
import threading
from collections.abc import Iterator
from types import SimpleNamespace

import pytest

from deltaviz.cli import main
from deltaviz.link.board import SimulatedBoard
from deltaviz.link.board.port import BoardPort
from deltaviz.link.impression import Impression, Kind
from deltaviz.link.messages import PROTOCOL_VERSION, HelloReply, StopCause
from deltaviz.link.probe import Finding
from deltaviz.terminal.ports import sentence
from tests.link.cable import Cable


@pytest.fixture
def board() -> Iterator[str]:
    """The device of a board that runs in a thread."""
    cable, port, over = Cable(), BoardPort(SimulatedBoard()), threading.Event()

    def turn() -> None:
        while not over.wait(0.005):
            port.feed(cable.hear())
            port.board.advance(1000)
            cable.say(b"".join(port.take()))

    thread = threading.Thread(target=turn)
    thread.start()
    yield cable.device
    over.set()
    thread.join()
    cable.unplug()


@pytest.fixture
def found(monkeypatch: pytest.MonkeyPatch, board: str) -> list[SimpleNamespace]:
    ports = [
        SimpleNamespace(device=board, description="CP2102 USB to UART"),
        SimpleNamespace(device="/dev/ttyNone", description="n/a"),
    ]
    monkeypatch.setattr("serial.tools.list_ports.comports", lambda: ports)
    return ports


def test_it_names_the_board_and_says_why_another_cannot_be_asked(capsys, found) -> None:
    assert main(["ports"]) == 0
    out = capsys.readouterr().out
    assert "/dev/ttyNone  Serial port ttyNone\n    There is no /dev/ttyNone." in out
    assert "CP2102 USB to UART" in out
    assert "\n    Board 'simulated', firmware python, not configured yet." in out


def test_for_scripts(capsys, found, board: str) -> None:
    assert main(["ports", "--json"]) == 0
    ports = {port["device"]: port for port in json.loads(capsys.readouterr().out)["ports"]}
    assert ports[board]["what"].startswith("CP2102")
    assert ports[board]["board"] == {
        "name": "simulated",
        "build": "python",
        "version": PROTOCOL_VERSION,
        "joints": 0,
        "homed": False,
    }
    assert ports["/dev/ttyNone"]["board"] is None
    assert "There is no" in ports["/dev/ttyNone"]["told"]
    assert ports["/dev/ttyNone"]["id"] == "ttynone"


def test_a_list_alone_opens_nothing(capsys, found, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("serial.serial_for_url", lambda *_, **__: pytest.fail("it was opened"))
    assert main(["ports", "--list"]) == 0
    assert "Board" not in capsys.readouterr().out


def test_no_ports(capsys, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("serial.tools.list_ports.comports", list)
    assert main(["ports"]) == 0
    assert "Plug the board in" in capsys.readouterr().out


def test_a_baud_rate_that_is_none(capsys) -> None:
    with pytest.raises(SystemExit) as exit:
        main(["ports", "--baud", "fast"])
    assert exit.value.code == 2
    assert "like 115200" in capsys.readouterr().err


BOARD = HelloReply(
    version=PROTOCOL_VERSION, board="stm32f407", build="1.2", joints=3, tick_hz=200_000,
    queue_places=64, boot=1, last_epoch=0, homed=True, configuration=5,
    last_stop=StopCause.NONE,
)  # fmt: skip


@pytest.mark.parametrize(
    ("finding", "says"),
    [
        (Finding(board=BOARD), "Board 'stm32f407', firmware 1.2, 3 joints, homed."),
        (Finding(impression=Impression(Kind.TEXT, "Grbl")), "It says 'Grbl': no board."),
        (Finding(impression=Impression(Kind.NOISE)), "baud rate"),
        (Finding(impression=Impression(Kind.ECHO)), "sends back"),
        (Finding(impression=Impression(Kind.BOARD)), "does it hear this computer"),
        (Finding(), "Nothing answers"),
        (Finding(problem="In use."), "In use."),
    ],
)
def test_each_finding_has_its_sentence(finding: Finding, says: str) -> None:
    assert says in sentence(finding)
