"""How regular the control loop is while four browsers watch and both cores are busy.

python -m benchmarks.watched_loop [--seconds S] [--browsers N] [--busy N]
"""

from __future__ import annotations

import argparse
import os

from benchmarks.loop import busy, measure
from benchmarks.served import chromium, open_console, served


def main() -> None:
    cores = os.cpu_count() or 1
    parser = argparse.ArgumentParser(description="The control loop while browsers watch.")
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--browsers", type=int, default=4)
    parser.add_argument("--busy", type=int, default=cores)
    options = parser.parse_args()
    with served() as running, chromium() as browser:
        for _ in range(options.browsers):
            open_console(browser, running.url)
        watched = measure(running.machine, options.seconds)
        with busy(options.busy):
            loaded = measure(running.machine, options.seconds)
    print(f"{'control loop, ms':40}{'p50':>8}{'p99':>8}{'worst':>8}{'underruns':>11}")
    for name, stats in (
        (f"{options.browsers} browsers watch", watched),
        (f"and {options.busy} processes keep {cores} cores busy", loaded),
    ):
        times = "".join(f"{1000 * t:8.1f}" for t in (stats.p50, stats.p99, stats.worst))
        print(f"{name:40}{times}{stats.underruns:11}")


if __name__ == "__main__":
    main()
