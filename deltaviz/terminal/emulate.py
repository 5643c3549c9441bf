"""`deltaviz emulate`: the real firmware in QEMU as a board to connect to, and who stands by it."""

from __future__ import annotations

import contextlib
import socket
import threading
import time
from collections.abc import Callable, Iterable
from math import radians
from typing import TextIO

from deltaviz.link.configuration import configure_from
from deltaviz.link.emulator import firmware
from deltaviz.link.emulator.bench import Bench, Circuit
from deltaviz.link.emulator.emulator import Emulator
from deltaviz.link.emulator.transport import check_emulator
from deltaviz.link.messages import Configure, Options
from deltaviz.link.transport import LinkError
from deltaviz.robots import Robot

HOST = "127.0.0.1"
_LOOK = 0.2  # s between looks at whether it still runs
HELP = (
    "estop, release: the e-stop button; press N, free N: the end stop of joint N; "
    "arms: where they are. Ctrl-C ends it."
)


def emulate(robot: Robot, *, name: str, port: int, out: TextIO, commands: Iterable[str]) -> None:
    """Runs until it is interrupted. `name` is what the command line called the robot. Raises
    LinkError when it cannot start, or has ended by itself.
    """
    check_emulator()
    configure = configure_from(robot)
    with _server(port) as server:
        address = f"socket://{HOST}:{server.getsockname()[1]}"
        emulator = Emulator.start(configure, image=firmware.built(), link=server, listens=True)
    try:
        print(f"Emulated board with the arms of '{name}': {address}", file=out)
        print(f"Connect with: deltaviz --robot {name} --link {address}", file=out)
        print(HELP, file=out, flush=True)
        hand = BenchHand(emulator.bench, configure)
        threading.Thread(target=_obey, args=(commands, hand, out), daemon=True).start()
        while not emulator.ended:
            time.sleep(_LOOK)
        raise LinkError(f"The emulated board has ended: {emulator.last_words}")
    finally:
        emulator.close()


def _server(port: int) -> socket.socket:
    try:
        return socket.create_server((HOST, port), backlog=1)
    except OSError as error:
        raise LinkError(
            f"Port {port} cannot be used: {error.strerror}. Choose another with --port, or 0 for "
            "any free one."
        ) from None


def _obey(commands: Iterable[str], hand: BenchHand, out: TextIO) -> None:
    with contextlib.suppress(OSError):  # the board is gone, which the other thread tells
        for line in commands:
            if line.strip():
                print(hand.do(line), file=out, flush=True)


class BenchHand:
    """Does what a line of text says, and says what came of it."""

    def __init__(self, bench: Bench, configure: Configure) -> None:
        self._bench = bench
        self._per_deg = [radians(per_rad) for per_rad in configure.microsteps_per_rad]
        pressed_is_open = Options.SWITCH_ACTIVE_OPEN in configure.options
        self._pressed = Circuit.OPEN if pressed_is_open else Circuit.CLOSED
        self._plain: dict[str, Callable[[], str]] = {
            "estop": self._estop,
            "release": self._release,
            "arms": self._arms,
        }
        self._of_joint: dict[str, Callable[[int], str]] = {"press": self._press, "free": self._free}

    def do(self, line: str) -> str:
        command, *rest = line.lower().split()
        if command in self._plain and not rest:
            return self._plain[command]()
        joints = [str(joint) for joint in range(1, len(self._per_deg) + 1)]
        if command in self._of_joint and len(rest) == 1 and rest[0] in joints:
            return self._of_joint[command](int(rest[0]))
        return HELP

    def _estop(self) -> str:
        self._bench.estop(pressed=True)
        return "The e-stop button is pressed."

    def _release(self) -> str:
        self._bench.estop(pressed=False)
        return "The e-stop button is released."

    def _press(self, joint: int) -> str:
        self._bench.hold(joint - 1, self._pressed)
        return f"The end stop of joint {joint} is held pressed."

    def _free(self, joint: int) -> str:
        self._bench.hold(joint - 1, Circuit.FREE)
        return f"The end stop of joint {joint} is its arm's again."

    def _arms(self) -> str:
        state = self._bench.state()
        angles = zip(state.arms, self._per_deg, strict=False)
        degrees = "  ".join(f"{arm / per_deg:.2f}°" for arm, per_deg in angles)
        return f"Arms at {degrees}; drivers {'on' if state.drivers_on else 'off'}."
