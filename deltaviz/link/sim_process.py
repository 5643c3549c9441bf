"""The simulated board's process: `python -m deltaviz.link.sim_process FD [homed]`.

It outlives its host as a board does: when the host's end is closed, or the host is gone, it goes
on until it stands still (the lease sees to that), and ends.
"""

from __future__ import annotations

import os
import select
import signal
import socket
import sys
import time

from deltaviz.link.board import SimulatedBoard
from deltaviz.link.board.port import BoardPort
from deltaviz.link.rules import TELEMETRY_MS, TICK_HZ
from deltaviz.link.socket_stream import SocketStream
from deltaviz.link.wire.stream import Outbox

MOST_AT_ONCE = TICK_HZ // 50  # 20 ms
AT_ONCE = TICK_HZ // 1000  # 1 ms: while it moves a board hears its host, also when it catches up


class Pace:
    """Board time from the monotonic clock.

    When this process was held up for longer than 20 ms, board time makes up for 20 ms and forgets
    the rest: its stall is a pause of the board's clock, not a fault of the host.
    """

    def __init__(self, now: float) -> None:
        self._origin = now
        self._ticks = 0

    def due(self, now: float) -> int:
        """Ticks to advance by now."""
        ticks = int((now - self._origin) * TICK_HZ) - self._ticks
        if ticks > MOST_AT_ONCE:
            self._origin = now
            self._ticks = 0
            return MOST_AT_ONCE
        self._ticks += ticks
        return ticks


def run(board: SimulatedBoard, host: SocketStream) -> None:
    port, outbox = BoardPort(board), Outbox(host)
    parent = os.getppid()
    pace = Pace(time.monotonic())
    poller = select.poll()
    poller.register(host, select.POLLIN)
    while True:
        due = pace.due(time.monotonic())
        while True:
            port.feed(host.read())
            step = min(due, AT_ONCE) if board.moving else due
            board.advance(step)
            outbox.put(port.take())
            due -= step
            if due == 0:
                break
        listened_to = host.ended is None and not outbox.overflowed and os.getppid() == parent
        if listened_to:
            poller.poll(TELEMETRY_MS)
        elif board.moving:
            time.sleep(TELEMETRY_MS / 1000)
        else:
            return


def main(arguments: list[str]) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    descriptor, *options = arguments
    boot = int.from_bytes(os.urandom(4), "little")
    board = SimulatedBoard(start_homed="homed" in options, boot=boot)
    host = SocketStream(socket.socket(fileno=int(descriptor)))
    run(board, host)
    host.close()


if __name__ == "__main__":
    main(sys.argv[1:])
