"""Both boards on the same wire: the same bytes, the same pauses, the same inputs.

What they say is compared byte for byte. Kept apart are the names in HelloReply; and scripts send no
segment whose judgement is a matter of single precision (two_judges).
"""

from __future__ import annotations

from dataclasses import replace
from itertools import zip_longest
from typing import Any

from deltaviz import load_robot
from deltaviz.link.configuration import configure_from
from deltaviz.link.messages import PROTOCOL_VERSION, Configure, Hello, HelloReply, HostMessage
from deltaviz.link.wire.codec import decode_board, encode
from deltaviz.link.wire.frames import FrameReader
from tests.firmware.c_board import CBoard
from tests.firmware.two_judges import Both
from tests.link.board.bench import Host, PythonBoard, gantry

CONFIGURATIONS: list[Configure] = [
    gantry(2, joint_min=(-0.3,) * 2, joint_max=(0.4,) * 2, homing_switch=(-0.35, -0.36)),
    gantry(
        4,
        joint_min=(-0.3,) * 4,
        joint_max=(0.5,) * 4,
        homing_direction=1,
        homing_switch=(0.52,) * 4,
        homing_together=False,
    ),
    configure_from(load_robot("stm32")),
]
JUDGES = [Both(CONFIGURATIONS[0]), Both(CONFIGURATIONS[1])]
JUDGES.append(Both(CONFIGURATIONS[2], load_robot("stm32").mechanism))  # type: ignore[arg-type]


class Pair:
    """The two boards, and the numbers of a host's commands."""

    def __init__(self, *, homed: bool, configuration: int, now: int, tick_hz: int) -> None:
        self.start = now
        self.ms = tick_hz // 1000  # ticks
        self.configure = CONFIGURATIONS[configuration]
        self.judge = JUDGES[configuration]
        options: dict[str, Any] = {
            "start_homed": homed,
            "now": now,
            "last_epoch": 65530,
            "tick_hz": tick_hz,
        }
        self.boards = (PythonBoard(**options), CBoard(**options))
        self.host = Host(self.boards[0])
        self._readers = (FrameReader(), FrameReader())
        self.feed(self.host.frame(Hello(PROTOCOL_VERSION)))
        self._set_up()

    @property
    def simulated(self) -> PythonBoard:
        return self.boards[0]

    def _set_up(self) -> None:
        """Configured; with `homed`, the two say so in other words, which are passed over."""
        frame = self.host.frame(self.configure)
        for board, reader in zip(self.boards, self._readers, strict=True):
            board.feed(frame)
            reader.feed(b"".join(board.take()))
        self.compare()

    def feed(self, data: bytes) -> None:
        for board in self.boards:
            board.feed(data)
        self.compare()

    def send(self, message: HostMessage) -> bytes:
        frame = self.host.frame(message)
        self.feed(frame)
        return frame

    def advance(self, ticks: int) -> None:
        for board in self.boards:
            board.advance(ticks)
        self.compare()

    def compare(self) -> None:
        said = [
            [_without_names(frame) for frame in reader.feed(b"".join(board.take()))]
            for board, reader in zip(self.boards, self._readers, strict=True)
        ]
        assert said[0] == said[1], _told(said)
        simulated, firmware = self.boards
        assert simulated.positions == firmware.positions
        assert simulated.now == firmware.now
        assert simulated.state is firmware.state
        assert simulated.moving == firmware.moving


def _without_names(frame: Any) -> Any:
    message = decode_board(frame.type, frame.payload)
    if isinstance(message, HelloReply):
        return frame._replace(payload=encode(replace(message, board="", build=""))[1])
    return frame


def _told(said: list[list[Any]]) -> str:
    """The first difference, and what came before."""
    pairs = list(zip_longest(*said))
    at = next(i for i, (simulated, firmware) in enumerate(pairs) if simulated != firmware)
    before = [f"both       {_read(frame)}" for frame, _ in pairs[max(0, at - 3) : at]]
    simulated, firmware = pairs[at]
    lines = ["", *before, f"simulated  {_read(simulated)}", f"firmware   {_read(firmware)}"]
    return "\n".join(lines)


def _read(frame: Any) -> str:
    if frame is None:
        return "nothing"
    return f"{frame.sequence} {decode_board(frame.type, frame.payload)}"
