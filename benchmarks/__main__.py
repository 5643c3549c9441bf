"""Runs every benchmark, or those named, in turn; what they print goes to docs/measurements.md.

Short runs; each benchmark can be called by itself for longer ones.
"""

from __future__ import annotations

import os
import platform
import subprocess
import sys
from datetime import date
from pathlib import Path

PAGE = Path(__file__).parents[1] / "docs" / "measurements.md"
BENCHMARKS = {
    "startup": ("Start-up", ["--rounds", "2"]),
    "kinematics": ("Inverse and forward for a million poses, against scalar C", ["--rounds", "3"]),
    "follower": ("One tick of the follower", ["--ticks", "200"]),
    "loop": ("The control loop, alone and on busy cores", ["--seconds", "5"]),
    "watched_loop": ("The control loop while browsers watch", ["--seconds", "5"]),
    "link": ("The link: round trip, and the cost of a capture", ["--seconds", "5"]),
    "latency": ("Pointer to step", ["--moves", "10"]),
}


def processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return platform.processor()
    return next((s.split(":", 1)[1].strip() for s in lines if s.startswith("model name")), "?")


def main() -> int:
    chosen = sys.argv[1:] or list(BENCHMARKS)
    parts = [
        "# Measurements",
        "",
        f"Made by `python -m benchmarks` on {date.today()}: {os.cpu_count()} cores "
        f"({processor()}), Python {platform.python_version()}, no graphics card. Browsers draw in "
        "software there and share the cores with everything else.",
    ]
    failed = False
    for name in chosen:
        title, arguments = BENCHMARKS[name]
        command = [sys.executable, "-m", f"benchmarks.{name}", *arguments]
        done = subprocess.run(command, stdout=subprocess.PIPE, text=True, cwd=PAGE.parents[1])
        if done.returncode:
            print(f"benchmarks.{name} failed", file=sys.stderr)
            failed = True
            continue
        print(done.stdout)
        parts += ["", f"## {title}", "", "```text", done.stdout.strip("\n"), "```"]
        PAGE.write_text("\n".join(parts) + "\n")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
