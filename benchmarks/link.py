"""The link: a command's round trip by what carries it, and what a capture costs the control loop.

    python -m benchmarks.link [--trips N] [--seconds S]

The board is the simulated one in a process of its own, behind a socket pair, a pseudo-terminal or
a TCP socket of this computer. A real serial port adds its driver, its USB and the line itself:
0.3 ms for the 30 bytes of this command and its answer at 921600 baud.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import select
import socket
import statistics
import subprocess
import sys
import tempfile
import time
import tty
from collections.abc import Callable, Iterator
from pathlib import Path

from benchmarks.loop import measure
from deltaviz.link.messages import PROTOCOL_VERSION, Enable, Hello, HelloReply, Refused
from deltaviz.link.serial_link import open_serial
from deltaviz.link.sim import SimTransport
from deltaviz.link.stream_transport import StreamTransport
from deltaviz.machine.client import MachineClient

PATIENCE = 10.0  # s
BOARD = """
import sys
from deltaviz.link.board import SimulatedBoard
from deltaviz.link.descriptor_stream import DescriptorStream
from deltaviz.link.sim_process import run
run(SimulatedBoard(), DescriptorStream(int(sys.argv[1]), in_system=1 << 20))
"""


@contextlib.contextmanager
def board_at(descriptor: int) -> Iterator[None]:
    process = subprocess.Popen(
        [sys.executable, "-c", BOARD, str(descriptor)], pass_fds=(descriptor,)
    )
    try:
        yield
    finally:
        process.kill()
        process.wait()


@contextlib.contextmanager
def by_terminal() -> Iterator[StreamTransport]:
    far, near = os.openpty()
    tty.setraw(near)
    link = open_serial(os.ttyname(near))
    with board_at(far), contextlib.closing(link):
        yield link
    os.close(far)
    os.close(near)


@contextlib.contextmanager
def by_tcp() -> Iterator[StreamTransport]:
    with socket.create_server(("127.0.0.1", 0)) as server:
        link = open_serial(f"socket://127.0.0.1:{server.getsockname()[1]}")
        far, _ = server.accept()
        far.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        with far, board_at(far.fileno()), contextlib.closing(link):
            yield link


@contextlib.contextmanager
def by_socket_pair() -> Iterator[StreamTransport]:
    with contextlib.closing(SimTransport.start()) as link:
        yield link


def hear(link: StreamTransport, kind: type) -> None:
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        select.select([link.fileno()], [], [], 0.1)
        if any(isinstance(message, kind) for message in link.receive()):
            return
    raise SystemExit("the board does not answer")


def round_trips(link: StreamTransport, count: int) -> list[float]:
    """Seconds from sending a command that is refused at once to its answer."""
    link.send(Hello(PROTOCOL_VERSION))
    hear(link, HelloReply)
    times: list[float] = []
    while len(times) < count:
        began = time.perf_counter()
        link.send(Enable(on=True))
        hear(link, Refused)
        times.append(time.perf_counter() - began)
    return times


def show_round_trips(count: int) -> None:
    print(f"{'round trip, ms':28}{'p50':>8}{'p99':>8}{'worst':>8}")
    carriers: dict[str, Callable[[], contextlib.AbstractContextManager[StreamTransport]]] = {
        "socket pair (sim://)": by_socket_pair,
        "pseudo-terminal": by_terminal,
        "TCP (socket://)": by_tcp,
    }
    for name, carrier in carriers.items():
        with carrier() as link:
            times = round_trips(link, count)
        cuts = statistics.quantiles(times, n=100)
        shown = "".join(f"{1000 * t:8.2f}" for t in (cuts[49], cuts[98], max(times)))
        print(f"{name:28}{shown}")


def processor_time(pid: int) -> float:
    fields = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def show_capture(seconds: float) -> None:
    print(f"{'control loop, ms':28}{'p50':>8}{'p99':>8}{'worst':>8}{'processor':>11}{'kB/s':>7}")
    for name in ("without a capture", "with a capture"):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "capture" if name.startswith("with ") else None
            with MachineClient.start(capture=file) as machine:
                if not machine.ready(60.0):
                    raise SystemExit("no board")
                measure(machine, 1.0)
                used, began = processor_time(machine.pid), time.monotonic()
                size = 0 if file is None else file.stat().st_size
                stats = measure(machine, seconds)
                took = time.monotonic() - began
                share = (processor_time(machine.pid) - used) / took
                rate = 0.0 if file is None else (file.stat().st_size - size) / took / 1000
        times = "".join(f"{1000 * t:8.1f}" for t in (stats.p50, stats.p99, stats.worst))
        print(f"{name:28}{times}{100 * share:9.1f} %{rate:7.1f}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--trips", type=int, default=2000, help="round trips of each kind (2000)")
    parser.add_argument("--seconds", type=float, default=10.0, help="of each motion (10)")
    options = parser.parse_args()
    show_round_trips(options.trips)
    print()
    show_capture(options.seconds)


if __name__ == "__main__":
    main()
