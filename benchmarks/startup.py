"""How long until something happens: import, one inverse, the first robot on the screen.

    python -m benchmarks.startup [--rounds N]

Whole processes, wall time, medians. "Cold" is with an empty cache of compiled kernels, as after
an installation; "warm" is every start after that.
"""

from __future__ import annotations

import argparse
import os
import re
import statistics
import subprocess
import sys
import tempfile
import time

from benchmarks.served import chromium, open_console


def command(*arguments: str, rounds: int) -> float:
    """Median wall time of a command, s."""
    times: list[float] = []
    for _ in range(rounds):
        start = time.perf_counter()
        subprocess.run([sys.executable, *arguments], check=True, stdout=subprocess.DEVNULL)
        times.append(time.perf_counter() - start)
    return statistics.median(times)


def first_robot(kernel_cache: str) -> tuple[float, float]:
    """From the command until the URL is printed, and until a page shows the robot, s.

    The browser runs already, as a person's does.
    """
    with chromium() as browser:
        start = time.perf_counter()
        server = subprocess.Popen(
            [sys.executable, "-m", "deltaviz", "serve", "--port", "0", "--no-browser"],
            stdout=subprocess.PIPE,
            text=True,
            env=os.environ | {"NUMBA_CACHE_DIR": kernel_cache},
        )
        try:
            assert server.stdout is not None
            urls = (re.search(r"http://[\d.:]+", line) for line in server.stdout)
            url = next(found[0] for found in urls if found)
            answered = time.perf_counter() - start
            open_console(browser, url)
            return answered, time.perf_counter() - start
        finally:
            server.terminate()
            server.wait(timeout=30)


def main() -> None:
    parser = argparse.ArgumentParser(description="How long until something happens.")
    parser.add_argument("--rounds", type=int, default=5)
    rounds = parser.parse_args().rounds
    nothing = command("-c", "pass", rounds=rounds)
    imported = command("-c", "import deltaviz", rounds=rounds)
    inverse = command("-m", "deltaviz", "ik", "0", "0", "-300", rounds=rounds)
    print(f"{'start-up, s':44}{'median':>8}")
    print(f"{'python, doing nothing':44}{nothing:8.2f}")
    print(f"{'import deltaviz (beyond that)':44}{imported - nothing:8.2f}")
    print(f"{'deltaviz ik':44}{inverse:8.2f}")
    with tempfile.TemporaryDirectory() as cache:
        cold = first_robot(cache)
        warm = [first_robot(cache) for _ in range(rounds)]
    print(f"{'deltaviz serve: address printed, cold':44}{cold[0]:8.2f}")
    print(f"{'first robot on the screen, cold':44}{cold[1]:8.2f}")
    print(
        f"{'deltaviz serve: address printed, warm':44}{statistics.median(w[0] for w in warm):8.2f}"
    )
    print(f"{'first robot on the screen, warm':44}{statistics.median(w[1] for w in warm):8.2f}")


if __name__ == "__main__":
    main()
