"""Live editing: how often the boundary is drawn anew while a length is dragged, per preset.

    python -m benchmarks.geometry [--seconds S] [ROBOT ..]

A viser client behind the gateway moves the slider of the forearm to and fro, one value each 50 ms
as viser's page sends them, and counts the boundaries that arrive: alone, and while another process
keeps one core busy. Then the hand rests, and the wait for the refined boundary is taken.
"""

from __future__ import annotations

import argparse
import contextlib
import itertools
import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import msgspec
import viser
import zstandard
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Subprotocol

from benchmarks.served import served
from deltaviz import load_robot
from deltaviz.robots import preset_names

EVERY = 0.05  # s, between two values
SWING = 0.1  # of the forearm's length, to either side
STEPS = 20  # of a swing
PATIENCE = 120.0  # s
BOUNDARY, LENGTH = "/reach/boundary", "Forearm"
CAMERA: dict[str, Any] = {
    "type": "ViewerCameraMessage",
    "wxyz": [1, 0, 0, 0],
    "position": [0.9, -1.1, 0.3],
    "fov": 0.7,
    "near": 0.01,
    "far": 1000,
    "image_height": 752,
    "image_width": 648,
    "look_at": [0, 0, -0.2],
    "up_direction": [0, 0, 1],
}


class Client:
    """A browser's side of the scene."""

    def __init__(self, url: str) -> None:
        self._socket: ClientConnection = connect(
            f"ws{url.removeprefix('http')}/scene",
            subprotocols=[Subprotocol(f"viser-v{viser.__version__}")],
            compression=None,
            max_size=None,
        )
        self._send(CAMERA)
        self._slider = self._wait(lambda m: m.get("props", {}).get("label") == LENGTH)["uuid"]

    def drag_to(self, value: float) -> None:
        self._send({"type": "GuiUpdateMessage", "uuid": self._slider, "updates": {"value": value}})

    def boundaries(self, until: float) -> Iterator[float]:
        """When each boundary came."""
        for message in self._messages(until):
            if message.get("name") == BOUNDARY and "props" in message:
                yield time.monotonic()

    def refined(self) -> None:
        """Wait until the readout says so."""
        self._wait(lambda m: "drawn within" in str(m.get("updates", {}).get("content")))

    def close(self) -> None:
        self._socket.close()

    def _send(self, message: dict[str, Any]) -> None:
        self._socket.send(msgspec.msgpack.encode(message))

    def _wait(self, holds: Callable[[dict[str, Any]], bool]) -> dict[str, Any]:
        return next(m for m in self._messages(time.monotonic() + PATIENCE) if holds(m))

    def _messages(self, until: float) -> Iterator[dict[str, Any]]:
        with contextlib.suppress(TimeoutError):
            while (left := until - time.monotonic()) > 0:
                data = self._socket.recv(timeout=left)
                assert isinstance(data, bytes)
                size = int.from_bytes(data[8:16], "little")
                plain = zstandard.ZstdDecompressor().decompress(data[16 : 16 + size])
                yield from msgspec.msgpack.decode(plain)["messages"]


@dataclass(frozen=True)
class Followed:
    """Refreshes a second, and the times between them (ms)."""

    rate: float
    median: float
    p95: float
    worst: float


def swing(length: float) -> Iterator[float]:
    """To and fro in whole mm, for ever; no two alike in turn."""
    out = [round(length * (1 + SWING * k / STEPS)) for k in range(-STEPS, STEPS + 1)]
    return itertools.cycle(value for value, _ in itertools.groupby(out + out[-2:0:-1]))


def followed(client: Client, values: Iterator[float], seconds: float) -> Followed:
    came: list[float] = []
    start = due = time.monotonic()
    while due < start + seconds:
        client.drag_to(next(values))
        due += EVERY
        came += client.boundaries(due)
    gaps = [1000 * (b - a) for a, b in pairwise([start, *came])]
    p95 = statistics.quantiles(gaps, n=20)[-1]
    return Followed(len(came) / seconds, statistics.median(gaps), p95, max(gaps))


@contextlib.contextmanager
def busy_core() -> Iterator[None]:
    with subprocess.Popen([sys.executable, "-c", "while True: pass"]) as process:
        try:
            yield
        finally:
            process.kill()


def measure(robot: str, seconds: float) -> None:
    length = float(load_robot(robot).mechanism.forearm[0])  # type: ignore[attr-defined]
    with served(robot) as running:
        client = Client(running.url)
        values = swing(length)
        client.drag_to(next(values))
        client.refined()  # all processes have loaded
        alone = followed(client, values, seconds)
        rested = time.monotonic()
        client.refined()
        refined = time.monotonic() - rested
        with busy_core():
            busy = followed(client, values, seconds)
        client.close()
    columns = "".join(
        f"{f.rate:10.1f}{f.median:7.0f}{f.p95:7.0f}{f.worst:7.0f}" for f in (alone, busy)
    )
    print(f"{robot:12}{columns}{refined:12.2f}", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description="How often a dragged boundary is drawn anew.")
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("robots", nargs="*", metavar="ROBOT")
    options = parser.parse_args()
    print(f"{'':12}{'alone: 1/s':>10}{'p50':>7}{'p95':>7}{'worst':>7}"
          f"{'busy: 1/s':>10}{'p50':>7}{'p95':>7}{'worst ms':>9}{'refined s':>10}")  # fmt: skip
    for robot in options.robots or preset_names():
        measure(robot, options.seconds)


if __name__ == "__main__":
    main()
