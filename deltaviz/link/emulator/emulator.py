"""A running emulator: its keeper's process and its bench."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
from functools import cached_property
from pathlib import Path
from random import randint
from tempfile import TemporaryFile
from typing import Self

from deltaviz.link.emulator.arms import arms_of
from deltaviz.link.emulator.bench import Bench, power_on
from deltaviz.link.messages import Configure


class Emulator:
    """It ends with the process that started it, if not before."""

    def __init__(self, keeper: subprocess.Popen[bytes], bench: Bench) -> None:
        self.bench = bench
        self._keeper = keeper

    @classmethod
    def start(
        cls,
        configure: Configure,
        *,
        image: Path,
        link: socket.socket,
        listens: bool = False,
        trace: int | None = None,
        pace: socket.socket | None = None,
    ) -> Self:
        """A board that is switched on, with the arms of the robot that `configure` describes, whose
        serial port is the socket `link` (which waits for connections, if it `listens`).

        `pace` is the board's end of what grants its time, if it is not to keep to ours; `trace` as
        for `qemu.command`.
        """
        ours, theirs = socket.socketpair()
        with theirs, TemporaryFile() as setup:
            boot = randint(1, 0xFFFF_FFFF)
            setup.write(power_on(configure, arms_of(configure), boot=boot))
            setup.flush()
            descriptors = {"link": link.fileno(), "bench": theirs.fileno(), "setup": setup.fileno()}
            if pace is not None:
                descriptors["pace"] = pace.fileno()
            if trace is not None:
                descriptors["trace"] = trace
            arguments = [f"--{name}={descriptor}" for name, descriptor in descriptors.items()]
            arguments += [f"--image={image}", *(["--listens"] if listens else [])]
            keeper = _start_keeper(arguments, keep=tuple(descriptors.values()))
        return cls(keeper, Bench(ours))

    @property
    def ended(self) -> bool:
        return self._keeper.poll() is not None

    @property
    def last_words(self) -> str:
        """Of one that has ended by itself: why, for a person."""
        if self._errors:
            return self._errors[-1]
        return f"QEMU was ended from outside (status {self._keeper.returncode})"

    @cached_property
    def _errors(self) -> list[str]:
        """What it and its keeper had to say, in lines; it is over then."""
        _, told = self._keeper.communicate()  # ends its input, and with that the emulator
        lines = told.decode(errors="replace").strip().splitlines()
        return [line for line in lines if "warning:" not in line]

    def close(self) -> None:
        """Ends it at once, as if its power were cut."""
        _ = self._errors
        self.bench.close()


def _start_keeper(arguments: list[str], *, keep: tuple[int, ...]) -> subprocess.Popen[bytes]:
    here = str(Path(__file__).resolve().parents[3])
    inherited = os.environ.get("PYTHONPATH")
    path = f"{here}{os.pathsep}{inherited}" if inherited else here
    return subprocess.Popen(
        [sys.executable, "-P", "-m", "deltaviz.link.emulator.launch", *arguments],
        pass_fds=keep,
        stdin=subprocess.PIPE,
        stderr=subprocess.PIPE,
        start_new_session=True,  # a Ctrl-C in the terminal is for the host to judge
        env=os.environ | {"PYTHONPATH": path},
    )
