"""Writes what the fuzzers begin with into firmware/fuzz/corpus: `python firmware/fuzz/seeds.py`."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Self

sys.path.insert(0, str(Path(__file__).parents[2]))  # the tests' configurations

from deltaviz import load_robot
from deltaviz.link.configuration import configure_from
from deltaviz.link.messages import (
    PROTOCOL_VERSION,
    Arm,
    CartesianSegment,
    Configure,
    Enable,
    EStop,
    Hello,
    Home,
    HostMessage,
    Keep,
    Reset,
    Segment,
    Stop,
    Tool,
)
from deltaviz.link.wire.codec import encode
from deltaviz.link.wire.commands import COMMANDS
from tests.link.board.bench import gantry

CORPUS = Path(__file__).parent / "corpus"
MS = 20  # ticks, of fuzz_board.c
START = 2**32 - 1 - 1000
EPOCH = 65531
OPEN, PRESSED, ESTOP = 0x0F, 0x00, 0x1F  # levels, of a gantry


class Session:
    """Steps of fuzz_board.c, and the tick that they have come to."""

    def __init__(self, configure: Configure) -> None:
        self.now = START
        self.steps = b""
        self.levels(OPEN).send(Hello(PROTOCOL_VERSION), configure, Enable(on=True))

    def send(self, *messages: HostMessage) -> Self:
        for message in messages:
            type_, payload = encode(message)
            head = bytes([4, type_]) if isinstance(message, COMMANDS) else bytes([1, type_, 0])
            self.steps += head + len(payload).to_bytes(2, "little") + payload
        return self

    def wait(self, ms: int) -> Self:
        for at in range(0, ms, 40):
            self.steps += bytes([2]) + (MS * min(40, ms - at)).to_bytes(2, "little")
        self.now = (self.now + MS * ms) & 0xFFFF_FFFF
        return self

    def levels(self, levels: int) -> Self:
        self.steps += bytes([3, levels])
        return self

    def home(self, pressed: int, released: int) -> Self:
        """By the inputs alone: nothing hangs on these pins."""
        self.send(Keep(self.now), Home()).levels(released).wait(10)
        for level, ms in ((pressed, 10), (released, 20), (pressed, 60)):
            self.levels(level).wait(ms)
        return self.send(Keep(self.now))

    def move(self, counts: tuple[int, ...], ways: Sequence[float]) -> Self:
        """Joint 0, in 10 ms each, to microsteps from its count; at rest at the last."""
        self.send(Keep(self.now), Arm(EPOCH, self.now, counts))
        t_end, at = self.now, 0.0
        for index, way in enumerate(ways):
            t_end = (t_end + 10 * MS) & 0xFFFF_FFFF
            p, v = [count * 1024 for count in counts], [0] * len(counts)
            p[0] += round(way * 1024)
            if index + 1 < len(ways):
                v[0] = round((ways[index + 1] - at) / 2 * 6553.6)
            knot = (tuple(p), tuple(v))
            self.send(Segment(EPOCH, index, t_end, 10 * MS, self.now, *knot))
            at = way
        return self

    def move_tip(self, counts: tuple[int, ...], z: float) -> Self:
        """To z mm, on the axis."""
        self.send(Arm(EPOCH, self.now, counts))
        when = (EPOCH, 0, (self.now + 50 * MS) & 0xFFFF_FFFF, 50 * MS, self.now)
        return self.send(CartesianSegment(*when, (0, 0, round(z * 256_000)), (0, 0, 0)))


def quick(configure: Configure) -> Configure:
    """Its switches are three microsteps from its ready pose, and it homes as fast as it can."""
    joints = len(configure.ready)
    return replace(
        configure,
        homing_fast=(60_000,) * joints,
        homing_slow=(60_000,) * joints,
        homing_backoff=(1,) * joints,
        homing_switch=tuple(ready - 3 for ready in configure.ready),
    )


def sessions() -> dict[str, Session]:
    two, four = gantry(2), gantry(4, homing_together=False)
    delta = quick(configure_from(load_robot("stm32")))  # its switches are pressed when open
    up = [0.1, 0.4, 0.8, 1.2, 1.6, 1.9, 2.0]
    far = [0.1, *(0.4 * step for step in range(1, 30))]

    def moving(ms: int) -> Session:
        return Session(two).move((0, 0), up).wait(ms)

    def homed_delta() -> Session:
        return Session(delta).home(OPEN, PRESSED)

    return {
        "moves": moving(100),
        "underruns": Session(two).move((0, 0), far[:4]).wait(60),
        "stops": moving(35).send(Stop()).wait(30),
        "disables": moving(35).send(Enable(on=False)).wait(30),
        "estops": moving(35).send(EStop(), Reset()),
        "lease": Session(two).move((0, 0), far).wait(200),
        "homes": Session(quick(two)).home(PRESSED, OPEN).move((0, 100), up).wait(80),
        "homes-in-turn": Session(quick(four)).home(PRESSED, OPEN).send(Keep(0)).wait(100),
        "switch": moving(20).levels(0x02).wait(30),
        "pressed": moving(20).levels(ESTOP).wait(30).send(Reset()),
        "delta": homed_delta().move((0, 0, 0), [0.1, 0.2, 0.1]).wait(50),
        "tip": homed_delta().move_tip((0, 0, 0), -295.2).wait(60),
        "tip-stops": homed_delta().move_tip((0, 0, 0), -295.2).wait(20).send(Stop()).wait(20),
        "tool": Session(two).send(Tool(on=True, servo_angle=0.5), Hello(2), Keep(0)),
    }


def frames() -> dict[str, bytes]:
    """Type, sequence, payload."""
    messages: list[HostMessage] = [
        Hello(PROTOCOL_VERSION), gantry(1), configure_from(load_robot("stm32")), Enable(on=True),
        Arm(1, 2, (3, -4)), Segment(1, 2, 3, 4, 5, (6,), (7,)), Keep(1), Tool(True, 0.5), Home(),
        CartesianSegment(1, 2, 3, 4, 5, (6, 7, 8), (9, 10, 11)),
    ]  # fmt: skip
    found: dict[str, bytes] = {}
    for message in messages:
        type_, payload = encode(message)
        found[f"{type(message).__name__.lower()}-{len(payload)}"] = bytes([type_, 1]) + payload
    return found


def main() -> None:
    for name, session in sessions().items():
        (CORPUS / "board" / name).write_bytes(session.steps)
    for name, data in frames().items():
        (CORPUS / "frames" / name).write_bytes(data)


if __name__ == "__main__":
    main()
