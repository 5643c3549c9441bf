"""The emulator's keeper: `python -m deltaviz.link.emulator.launch --image FILE --link FD ...`.

Runs QEMU until its own standard input ends, which it does when whoever started it is gone, however
that came about.
"""

from __future__ import annotations

import argparse
import ctypes
import os
import signal
import subprocess
import sys
import threading
from pathlib import Path

from deltaviz.link.emulator import qemu
from deltaviz.link.emulator.pace import Pace, keep_to_our_time

_PR_SET_PDEATHSIG = 1  # linux/prctl.h


def main() -> int:
    options = _options()
    _step_back()
    pace, paced = Pace.pair()
    descriptors = {
        "link": options.link,
        "bench": options.bench,
        "setup": options.setup,
        "pace": paced.detach() if options.pace is None else options.pace,
    }
    command = qemu.command(
        options.image, **descriptors, listens=options.listens, trace=options.trace
    )
    keep = [*descriptors.values(), *([] if options.trace is None else [options.trace])]
    emulator = subprocess.Popen(
        command, pass_fds=keep, stdin=subprocess.DEVNULL, preexec_fn=_die_with_keeper
    )
    for descriptor in keep:
        os.close(descriptor)
    threading.Thread(target=_end_with_input, args=(emulator,), daemon=True).start()
    if options.pace is None:
        keep_to_our_time(pace, running=lambda: emulator.poll() is None)
    return emulator.wait()


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser()
    parser.add_argument("--image", type=Path, required=True)
    parser.add_argument("--link", type=int, required=True)
    parser.add_argument("--bench", type=int, required=True)
    parser.add_argument("--setup", type=int, required=True)
    parser.add_argument("--pace", type=int, help="our time, unless somebody grants another")
    parser.add_argument("--trace", type=int)
    parser.add_argument("--listens", action="store_true")
    return parser.parse_args()


def _end_with_input(emulator: subprocess.Popen[bytes]) -> None:
    while os.read(0, 1):
        pass
    emulator.kill()


def _step_back() -> None:
    """Whoever starts this may come before all others. An emulator must not: it never rests."""
    if hasattr(os, "sched_setscheduler"):
        os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))
    os.setpriority(os.PRIO_PROCESS, 0, max(0, os.getpriority(os.PRIO_PROCESS, 0)))


def _die_with_keeper() -> None:
    """Linux would also let an emulator live on whose keeper was killed."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)


if __name__ == "__main__":
    sys.exit(main())
