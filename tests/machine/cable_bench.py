"""A bench whose board hangs at a real (pseudo-)terminal, on a clock that tests turn.

The bytes go through the operating system, the serial link and the machine's own keeper of links.
"""

from __future__ import annotations

from deltaviz.link.board import SimulatedBoard
from deltaviz.link.board.port import BoardPort
from deltaviz.link.rules import TICK_HZ
from deltaviz.link.serial_link import open_serial
from deltaviz.link.transport import Transport
from deltaviz.robots import Robot
from tests.link.cable import Cable, Counted, SocketCable, wait_for_bytes
from tests.machine.kept_bench import KeptBench

LINK = "ttyusb0"


class CableBench(KeptBench):
    """`unplug` pulls the plug; `plug_in` gives the same board, or a new one, a new cable."""

    def __init__(
        self, robot: Robot, *, homed: bool = True, cable: type[Cable] | type[SocketCable] = Cable
    ) -> None:
        self._new_cable = cable
        self.cable = cable()
        self.port: BoardPort | None = None
        self._host: Counted | None = None
        self._told = 0  # bytes, since the host opened the port
        self._heard = 0
        super().__init__(robot, homed=homed, link=LINK)

    def plug_in(self, board: SimulatedBoard | None = None, *, homed: bool = False) -> None:
        self.cable.unplug()
        self.cable = self._new_cable()
        self._host = None
        self._set_board(board or SimulatedBoard(start_homed=homed, boot=len(self.boards) + 1))

    def unplug(self) -> None:
        self.cable.unplug()

    def close(self) -> None:
        super().close()
        self.cable.unplug()

    def _set_board(self, board: SimulatedBoard) -> None:
        if board is not self.board:
            self.boards.append(board)
            self.path.clear()
        self.board = board
        self.port = BoardPort(board)
        self._ticks = round(self.now * TICK_HZ)

    def _open(self, _link: str, _robot: Robot) -> Transport:
        def counted(stream):
            self._host = Counted(stream)
            self._told = self._heard = 0
            return self._host

        return open_serial(self.cable.device, tap=counted, clock=lambda: self.now)

    def _advance_board(self) -> None:
        if self.board is None:
            self._set_board(SimulatedBoard(start_homed=self.homed, boot=1, now=0xFFFF_FFFF - 1000))
        self._carry_to_board()
        super()._advance_board()
        self._carry_to_host()

    def _carry_to_board(self) -> None:
        if self.cable.plugged and self._host is not None and self.port is not None:
            data = self.cable.hear_bytes(self._host.written - self._heard)
            self._heard += len(data)
            self.port.feed(data)

    def _carry_to_host(self) -> None:
        data = b"" if self.port is None else b"".join(self.port.take())
        transport = self.transport
        if not self.cable.plugged or self._host is None or transport is None or transport.closed:
            return
        self._tell(data)

    def _tell(self, data: bytes) -> None:
        if self._host is None or self.transport is None:
            return
        self.cable.say(data)
        self._told += len(data)
        wait_for_bytes(self.transport.fileno(), self._told - self._host.read_)
