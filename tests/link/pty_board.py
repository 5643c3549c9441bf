"""A board at a pseudo-terminal, in real time, as a process: `python -m tests.link.pty_board PATH`.

PATH becomes a link to the terminal. A line on standard input does what it says: `unplug` (the
board goes on by itself), `plug` (the same board, another terminal), `restart` (power off and on).
Each is answered by the same line once it is done.
"""

from __future__ import annotations

import contextlib
import os
import select
import sys
import time
from pathlib import Path

from deltaviz.link.board import SimulatedBoard
from deltaviz.link.board.port import BoardPort
from deltaviz.link.sim_process import Pace
from tests.link.cable import Cable

TURN = 0.001  # s


class PtyBoard:
    def __init__(self, path: Path) -> None:
        self._path = path
        self._boot = 0
        self._cable: Cable | None = None
        self._pace = Pace(time.monotonic())
        self.restart()
        self.plug()

    def plug(self) -> None:
        self.unplug()
        self._cable = Cable()
        self._path.unlink(missing_ok=True)
        self._path.symlink_to(self._cable.device)

    def unplug(self) -> None:
        self._path.unlink(missing_ok=True)
        if self._cable is not None:
            self._cable.unplug()
            self._cable = None

    def restart(self) -> None:
        self._boot += 1
        self._port = BoardPort(SimulatedBoard(boot=self._boot))

    def turn(self) -> None:
        if self._cable is not None:
            self._port.feed(self._cable.hear())
        self._port.board.advance(self._pace.due(time.monotonic()))
        data = b"".join(self._port.take())
        if self._cable is not None:
            with contextlib.suppress(BlockingIOError):  # nobody reads: as a UART, it is lost
                self._cable.say(data)


def main(path: str) -> None:
    board = PtyBoard(Path(path))
    print("plug", flush=True)
    lines = b""
    while True:
        if select.select([sys.stdin], [], [], TURN)[0]:
            lines += (data := os.read(sys.stdin.fileno(), 1000))
            if not data:
                return
            *whole, lines = lines.split(b"\n")
            for line in whole:
                getattr(board, line.decode())()
                print(line.decode(), flush=True)
        board.turn()


if __name__ == "__main__":
    main(sys.argv[1])
