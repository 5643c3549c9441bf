"""The link while four browsers watch and one of them drags: segments, queue, periods.

    python -m benchmarks.dragged [--seconds S] [--browsers N]

The three that only watch have small windows: four large scenes drawn in software leave a page no
time to say that it lives, and its drags break off. What was sent is taken from a capture, what the
board had from its own telemetry.
"""

from __future__ import annotations

import argparse
import math
import statistics
import sys
import tempfile
import threading
import time
from collections import Counter
from itertools import pairwise
from pathlib import Path

from playwright.sync_api import Page

from benchmarks.hand import Hand
from benchmarks.served import Served, chromium, open_console, served
from deltaviz.link.capture.reader import read_capture
from deltaviz.link.capture.spoken import connections, of_kind, spoken
from deltaviz.link.messages import Segment
from deltaviz.machine.loop_stats import LoopStats
from deltaviz.machine.mode import Mode

PATIENCE = 60.0  # s
PAUSE = 0.1  # s: a longer one is a rest

RADIUS = 60.0  # pixels
TURN = 2.0  # s for one round of the pointer


class QueueWatch:
    """Looks at the queue every millisecond or two, while the robot moves."""

    def __init__(self, running: Served) -> None:
        self._running = running
        self._ended = threading.Event()
        self.depths: list[int] = []
        self.ahead: list[float] = []
        self._thread = threading.Thread(target=self._watch, daemon=True)

    def __enter__(self) -> QueueWatch:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._ended.set()
        self._thread.join()

    def _watch(self) -> None:
        shown = None
        while not self._ended.wait(0.002):
            snapshot = self._running.machine.snapshot
            if snapshot is not shown and snapshot.mode is Mode.JOGGING:
                self.depths.append(snapshot.link.queued)
                self.ahead.append(snapshot.link.ahead)
            shown = snapshot


def sent(capture: Path) -> list[float]:
    """When each segment was sent, s."""
    said = [item for part in connections(read_capture(capture)) for item in spoken(part)]
    return [segment.at for segment in of_kind(Segment, said)]


def drag(page: Page, running: Served, seconds: float) -> QueueWatch:
    """Round and round, as fast as the browser takes it."""
    with Hand(page, running) as hand:
        running.machine.stats().result(PATIENCE)  # begin anew
        end = time.monotonic() + seconds
        with QueueWatch(running) as queue:
            while (left := end - time.monotonic()) > 0:
                hand.hold()
                angle = 2 * math.pi * left / TURN
                hand.move(RADIUS * math.cos(angle), RADIUS * math.sin(angle))
    return queue


def report(times: list[float], queue: QueueWatch, stats: LoopStats) -> None:
    busiest = max(Counter(int(at) for at in times).values())
    moving = sum(gap for a, b in pairwise(times) if (gap := b - a) < PAUSE)
    print(f"{'seconds of motion':28}{moving:8.1f}")
    print(f"{'segments a second of it':28}{len(times) / moving:8.0f}  at most {busiest}")
    print(f"{'':28}{'p50':>8}{'p1':>8}{'p99':>8}")
    for name, values in (
        ("segments in the queue", queue.depths),
        ("motion ahead, ms", [1e3 * s for s in queue.ahead]),
    ):
        low, *_, high = statistics.quantiles(values, n=100)
        print(f"{name:28}{statistics.median(values):8.0f}{low:8.0f}{high:8.0f}")
    print(f"{'control loop, ms':28}{1e3 * stats.p50:8.1f}{'':8}{1e3 * stats.p99:8.1f}")
    print(f"{'underruns':28}{stats.underruns:8}")


def main() -> None:
    parser = argparse.ArgumentParser(description="The link while browsers watch and one drags.")
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--browsers", type=int, default=4)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        capture = Path(folder) / "capture"
        with served(capture=capture) as running, chromium() as browser:
            for _ in range(options.browsers - 1):
                open_console(browser, running.url, width=760, height=600)
            page = open_console(browser, running.url)
            queue = drag(page, running, options.seconds)
            stats = running.machine.stats().result(PATIENCE)
            if (reason := running.machine.snapshot.stop_reason) is not None:
                print(reason, file=sys.stderr)
        times = sent(capture)
    print(f"{options.browsers} browsers watch, one of them drags for {options.seconds:g} s")
    report(times, queue, stats)


if __name__ == "__main__":
    main()
