"""`deltaviz emulate`: a board to connect to, and a hand at its bench."""

from __future__ import annotations

import re
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator

import pytest

from deltaviz import load_robot
from deltaviz.cli import main
from deltaviz.link.messages import Hello, HelloReply
from deltaviz.link.transport import Transport
from deltaviz.link.urls import open_link
from tests.link.hearing import PATIENCE, hear


class Command:
    """`deltaviz emulate`, running."""

    def __init__(self, *arguments: str) -> None:
        self.process = subprocess.Popen(
            [sys.executable, "-m", "deltaviz", "emulate", *arguments],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        found = re.search(r"socket://127\.0\.0\.1:\d+", self.line())
        assert found is not None
        self.url = found[0]
        assert self.url in self.line()
        assert "Ctrl-C" in self.line()

    def line(self) -> str:
        assert self.process.stdout is not None
        return self.process.stdout.readline()

    def type(self, text: str) -> str:
        """What it says to that."""
        assert self.process.stdin is not None
        print(text, file=self.process.stdin, flush=True)
        return self.line()


@pytest.fixture
def command() -> Iterator[Command]:
    running = Command("--robot", "trossen", "--port", "0")
    yield running
    running.process.kill()
    running.process.communicate()


def hello(link: Transport) -> HelloReply:
    link.send(Hello(1))
    return hear(link, HelloReply)


def test_hosts_connect_one_after_another_to_the_same_board(command: Command) -> None:
    boots: set[int] = set()
    for _ in range(2):
        link = open_link(command.url, load_robot("trossen"))
        boots.add(hello(link).boot)
        link.close()
    assert len(boots) == 1


def test_commands_are_obeyed_and_what_is_none_is_explained(command: Command) -> None:
    before = command.type("arms")
    assert re.fullmatch(r"Arms at (-?\d+\.\d\d°  ){2}-?\d+\.\d\d°; drivers off\.\n", before)
    assert "is pressed" in command.type("estop")
    assert "is released" in command.type("release")
    assert "joint 2 is held" in command.type("press 2")
    assert "joint 2 is its arm's" in command.type("free 2")
    for wrong in ("press 4", "press", "arms 1", "dance"):
        assert "press N" in command.type(wrong)


def test_ctrl_c_ends_it(command: Command) -> None:
    command.process.send_signal(signal.SIGINT)
    assert command.process.wait(PATIENCE) == 0


def test_a_port_in_use_is_told_with_a_way_out(capsys: pytest.CaptureFixture[str]) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        assert main(["emulate", "--port", str(port)]) == 1
    assert "--port, or 0" in capsys.readouterr().err
