"""How regular the control loop is while this computer is busy.

    python benchmarks/loop.py [--seconds S] [--busy N] [--json]

Moves a simulated robot to and fro, first with nothing else to do, then with one process (or N)
keeping each core busy, and prints the loop's period while it moves, and the underruns. Elsewhere
`measure` does the same with a machine that pages are watching.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import asdict

from deltaviz.machine import intent as i
from deltaviz.machine.client import MachineClient
from deltaviz.machine.loop_stats import LoopStats
from deltaviz.machine.mode import Mode

CLIENT = "benchmark"
PATIENCE = 60.0  # s
SWING = 40.0  # mm to each side of the ready pose


@contextlib.contextmanager
def busy(processes: int) -> Iterator[None]:
    """`processes` that do nothing but use up time."""
    spinners = [
        subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(processes)
    ]
    try:
        yield
    finally:
        for spinner in spinners:
            spinner.kill()
            spinner.wait()


def measure(machine: MachineClient, seconds: float) -> LoopStats:
    """Move to and fro for `seconds`; the loop's periods (s) while it moved.

    The underruns are those of this measurement. What stopped the robot is told on stderr, and it
    is set going again.
    """
    home = _ready(machine)
    machine.stats().result(PATIENCE)
    before = machine.snapshot.underruns
    side, end = 1.0, time.monotonic() + seconds
    while time.monotonic() < end:
        target = (home[0] + side * SWING, *home[1:])
        answer = machine.post(i.MoveToPoint(CLIENT, target, 1.0)).result(PATIENCE)
        if isinstance(answer, i.Accepted):
            side = -side
            _wait_until_idle(machine)
            if machine.snapshot.stop_reason is not None:
                print(machine.snapshot.stop_reason, file=sys.stderr)
        else:
            time.sleep(0.01)
    stats = machine.stats().result(PATIENCE)
    machine.post(i.MoveToPoint(CLIENT, home, 1.0)).result(PATIENCE)
    _wait_until_idle(machine)
    return LoopStats(**{**asdict(stats), "underruns": stats.underruns - before})


def _ready(machine: MachineClient) -> tuple[float, ...]:
    if not machine.ready(PATIENCE):
        raise SystemExit(f"no board: {machine.snapshot.link.problem}")
    _wait_until_idle(machine)
    xyz = machine.snapshot.xyz
    if xyz is None:
        raise SystemExit("the robot does not know its pose")
    return xyz


def _wait_until_idle(machine: MachineClient) -> None:
    end = time.monotonic() + PATIENCE
    time.sleep(0.05)  # for the snapshot that shows what was just accepted
    while machine.snapshot.mode is not Mode.IDLE:
        if time.monotonic() > end:
            raise SystemExit(f"not idle after {PATIENCE:g} s: {machine.snapshot}")
        time.sleep(0.005)


def main() -> None:
    cores = os.cpu_count() or 1
    parser = argparse.ArgumentParser(description="How regular the control loop is.")
    parser.add_argument("--seconds", type=float, default=10.0, help="of each measurement (10)")
    parser.add_argument("--busy", type=int, default=cores, help=f"busy processes ({cores})")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    options = parser.parse_args()
    with MachineClient.start() as machine:
        _ready(machine)
        results = {"quiet": measure(machine, options.seconds)}
        with busy(options.busy):
            results[f"{options.busy} busy on {cores} cores"] = measure(machine, options.seconds)
    if options.json:
        print(json.dumps({name: asdict(stats) for name, stats in results.items()}))
        return
    print(f"{'control loop, ms':28}{'p50':>8}{'p99':>8}{'worst':>8}{'turns':>8}{'underruns':>11}")
    for name, stats in results.items():
        times = "".join(f"{1000 * t:8.1f}" for t in (stats.p50, stats.p99, stats.worst))
        print(f"{name:28}{times}{stats.count:8}{stats.underruns:11}")


if __name__ == "__main__":
    main()
