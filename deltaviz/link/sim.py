"""`sim://`: the simulated board in a small process of its own, behind a socket pair."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
from pathlib import Path
from typing import Self
from urllib.parse import parse_qsl, urlsplit

from deltaviz.link.socket_stream import SocketStream
from deltaviz.link.stream_transport import StreamTransport
from deltaviz.link.tap import Tap, untapped
from deltaviz.link.transport import LinkError

_PATIENCE = 1.5  # s: the lease (150 ms) and the longest brake, and some


class SimTransport(StreamTransport):
    """The host's end. `start` returns before the board has begun to answer."""

    def __init__(self, process: subprocess.Popen[bytes], board: socket.socket, tap: Tap) -> None:
        super().__init__(tap(SocketStream(board)), broke=_broke, release=self._see_it_end)
        self._process = process

    @classmethod
    def start(cls, *, homed: bool = True, tap: Tap = untapped) -> Self:
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
        return cls(process, ours, tap)

    @property
    def pid(self) -> int:
        return self._process.pid

    def _see_it_end(self) -> None:
        """Waits until the board has come to rest and its process has ended."""
        try:
            self._process.wait(_PATIENCE)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()


def starts_homed(url: str) -> bool:
    """Whether the simulated board of this URL starts enabled and homed. Raises LinkError."""
    parts = urlsplit(url)
    if parts.netloc or parts.path or parts.fragment:
        raise LinkError(f"{url!r}: nothing may stand between sim:// and a question mark")
    homed = True
    for key, value in parse_qsl(parts.query, keep_blank_values=True):
        if key != "homed":
            raise LinkError(f"{url!r}: sim:// has no option {key!r}; it has homed=0 or homed=1")
        if value not in ("0", "1"):
            raise LinkError(f"{url!r}: homed is {value!r}; it may be 0 or 1")
        homed = value == "1"
    return homed


def _broke(reason: str) -> str:
    return f"The simulated board does not answer: {reason}. Connect again."


def _python_path() -> str:
    """Where this package stands, before whatever the user has set."""
    here = str(Path(__file__).resolve().parents[2])
    inherited = os.environ.get("PYTHONPATH")
    return f"{here}{os.pathsep}{inherited}" if inherited else here
