"""`sim://`: the simulated board in a small process of its own, behind a socket pair."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
from pathlib import Path
from typing import Self

from deltaviz.link.messages import BoardMessage, HostMessage
from deltaviz.link.socket_stream import SocketStream
from deltaviz.link.wire.channel import Channel

_PATIENCE = 1.5  # s: the lease (150 ms) and the longest brake, and some


class SimTransport:
    """The host's end. `start` returns before the board has begun to answer."""

    def __init__(self, process: subprocess.Popen[bytes], board: Channel) -> None:
        self._process = process
        self._board = board
        self._closed = False

    @classmethod
    def start(cls, *, homed: bool = True) -> Self:
        ours, theirs = socket.socketpair()
        with theirs:
            process = subprocess.Popen(
                [
                    sys.executable,
                    "-P",  # the folder it is started from has nothing to say
                    "-m",
                    "deltaviz.link.sim_process",
                    str(theirs.fileno()),
                    *(["homed"] if homed else []),
                ],
                pass_fds=(theirs.fileno(),),
                stdin=subprocess.DEVNULL,
                start_new_session=True,  # a Ctrl-C in the terminal is for the host to judge
                env=os.environ | {"PYTHONPATH": _python_path()},
            )
        return cls(process, Channel(SocketStream(ours)))

    @property
    def pid(self) -> int:
        return self._process.pid

    @property
    def closed(self) -> bool:
        return self._closed or self._board.ended is not None

    @property
    def problem(self) -> str | None:
        if self._closed or self._board.ended is None:
            return None
        return f"The simulated board does not answer: {self._board.ended}. Connect again."

    def send(self, message: HostMessage) -> None:
        if not self.closed:
            self._board.send(message)

    def receive(self) -> list[BoardMessage]:
        return [] if self._closed else self._board.receive()

    def fileno(self) -> int:
        return self._board.fileno()

    def close(self) -> None:
        """Closes our end and waits until the board has come to rest and its process has ended."""
        if self._closed:
            return
        self._closed = True
        self._board.close()
        try:
            self._process.wait(_PATIENCE)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()


def _python_path() -> str:
    """Where this package stands, before whatever the user has set."""
    here = str(Path(__file__).resolve().parents[2])
    inherited = os.environ.get("PYTHONPATH")
    return f"{here}{os.pathsep}{inherited}" if inherited else here
