"""A machine and its board at the two ends of a faulty wire, on a clock that tests turn.

Whatever passes is bytes, by the machine's own keeper of links and the board's own port. All that
the board executed is kept, for the judge.
"""

from __future__ import annotations

import random
from random import Random

from deltaviz.link.board import SimulatedBoard
from deltaviz.link.board.port import BoardPort
from deltaviz.link.messages import HostMessage, Stop
from deltaviz.link.rules import TICK_HZ, since
from deltaviz.link.stream_transport import StreamTransport
from deltaviz.link.transport import Transport
from deltaviz.link.wire.codec import decode_board, encode
from deltaviz.link.wire.frames import FrameReader, write_frame
from deltaviz.robots import Robot
from tests.faults.executed import Executed, Sample
from tests.faults.faulty_line import FRAME_END, Fault, FaultyLine
from tests.machine.kept_bench import KeptBench

LINK = "ttyusb0"
MS = TICK_HZ // 1000
STOP = write_frame(encode(Stop())[0], 0, b"").removesuffix(FRAME_END)
BROKE = "The link broke: {}. A moving board brakes by itself. Check its cable, then connect."


class WireBench(KeptBench):
    """`to_board` and `to_host` are the wire. `cut` lets nothing pass, unnoticed by either end;
    `unplug` is a cut that the host's end notices.
    """

    def __init__(
        self, robot: Robot, *, seed: int, fault: Fault | None = None, homed: bool = True
    ) -> None:
        source = Random(seed)
        self.to_board = FaultyLine(Random(source.random()), fault)
        self.to_host = FaultyLine(Random(source.random()), fault)
        self.unplugged = False
        self.deaf = False  # the board hears nothing
        self.withheld: int | None = None  # type of messages that get lost to the board
        self.executed: list[Executed] = []  # by each board that there was
        self._seed = seed
        self.told: list[bytes] = []  # all frames that the host has sent
        self.heard_bytes: list[bytes] = []  # and the board
        self._port: BoardPort | None = None
        super().__init__(robot, homed=homed, link=LINK)

    @property
    def injected(self) -> int:
        return self.to_board.injected + self.to_host.injected

    def reset_board(self) -> None:
        """Its power was gone for a moment: a new life, which knows nothing of the last one."""
        self.to_host.clear()
        self.executed[-1].lost_power = True
        self._power_up(SimulatedBoard(boot=len(self.boards) + 1, now=12_345))

    def unplug(self) -> None:
        self.unplugged = True
        self.to_board.clear()
        self.to_host.clear()

    def plug_in(self) -> None:
        self.unplugged = self.cut = self.deaf = False

    def flood(self, data: bytes) -> None:
        """Bytes to the board that no host of ours has sent."""
        if self._port is not None:
            self._note_stop(data)
            self._port.feed(data)

    def flood_host(self, data: bytes) -> None:
        """Bytes to the host that its board has not sent, or not now."""
        self.to_host.put(data, self.now)

    def stall(self, seconds: float) -> None:
        """The host does nothing for so long; the board and the wire go on."""
        for _ in range(round(seconds / 0.002)):
            self.now += 0.002
            self._advance_board()

    # The board's end.

    def _power_up(self, board: SimulatedBoard) -> None:
        self.boards.append(board)
        self.board = board
        self._port = BoardPort(board)
        self._told = FrameReader()
        self._begun = b""  # of a frame to the board
        self.executed.append(Executed())
        self._ticks = round(self.now * TICK_HZ)

    def _advance_board(self) -> None:
        if self._port is None:
            homed = SimulatedBoard(start_homed=self.homed, boot=1, now=0xFFFF_FFFF - 1_000_000)
            self._power_up(homed)
        due = round(self.now * TICK_HZ)
        while self._ticks < due:
            self._ticks += MS
            self._feed(self.to_board.take(self._ticks / TICK_HZ))
            self.board.advance(MS)
            self._listen(self._ticks / TICK_HZ)
            self._keep_sample()

    def _feed(self, data: bytes) -> None:
        if data and not (self.cut or self.unplugged or self.deaf) and self._port is not None:
            self._note_stop(data)
            self._port.feed(data)

    def _note_stop(self, data: bytes) -> None:
        *frames, self._begun = (self._begun + data).split(FRAME_END)
        if STOP in frames:
            self.executed[-1].stops.append(self.board.now)

    def _listen(self, now: float) -> None:
        assert self._port is not None
        frames = self._port.take()
        self.heard_bytes += frames
        data = b"".join(frames)
        for frame in self._told.feed(data):
            self.executed[-1].note(decode_board(frame.type, frame.payload))
        if not self.cut and not self.unplugged:
            self.to_host.put(data, now)

    def _keep_sample(self) -> None:
        board, executed = self.board, self.executed[-1]
        seen = executed.seen
        executed.samples.append(
            Sample(
                tick=board.now,
                state=board.state,
                epoch=executed.epoch,
                positions=tuple(board.positions),
                counts=board.counts,
                arms=board.plant.theta if board.counts else (),
                moving=board.moving,
                unheard=0 if seen is None else since(board.now, seen),
            )
        )

    # The host's end.

    def _open(self, _link: str, _robot: Robot) -> Transport:
        random.seed(self._seed + len(self.sent))  # the first sequence of a session is by chance
        self.to_board.clear()
        self.to_host.clear()
        return StreamTransport(_HostEnd(self), broke=BROKE.format, clock=lambda: self.now)

    def _send(self, messages: list[HostMessage]) -> None:
        for message in messages:
            if self.executed:
                self.executed[-1].command(message)
        super()._send(messages)


class _HostEnd:
    """The stream that the host has open."""

    def __init__(self, bench: WireBench) -> None:
        self._bench = bench
        self._closed = False

    @property
    def ended(self) -> str | None:
        if self._closed:
            return "it was closed"
        return "it was unplugged" if self._bench.unplugged else None

    def write(self, data: bytes) -> int:
        self._bench.told.append(data)
        withheld = data[1] == self._bench.withheld  # behind COBS's first byte, as no type is 0
        if self.ended is None and not self._bench.cut and not withheld:
            self._bench.to_board.put(data, self._bench.now)
        return len(data)

    def read(self) -> bytes:
        return b"" if self.ended is not None else self._bench.to_host.take(self._bench.now)

    def fileno(self) -> int:
        return -1

    def close(self) -> None:
        self._closed = True
