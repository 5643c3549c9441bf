"""A board in Unicorn: the real image, its interrupts taken one by one, each at its price.

Ticks, control and the main loop run in the order in which silicon would run them if each was done
before the next interrupt; what interrupts what is the emulator's to show.
"""

from __future__ import annotations

from collections import deque
from pathlib import Path
from random import Random

from deltaviz.link.messages import BoardMessage, BoardState, HostMessage, Telemetry
from deltaviz.link.wire.codec import decode_board, encode
from deltaviz.link.wire.commands import COMMANDS
from deltaviz.link.wire.frames import FrameReader, write_frame
from tests.firmware.clock_tree import ClockTree
from tests.firmware.processor import Cost, Processor, Registers

USART2, GPIOD, SYSTEM_CONTROL = 0x4000_4400, 0x4002_0C00, 0xE000_EC00
_IDR, _SWITCHES = 0x10, 1 << 0 | 1 << 1 | 1 << 3 | 1 << 6  # PD0, PD1, PD3, PD6
_SR, _DR = 0x00, 0x04
_RXNE, _TXE = 1 << 5, 1 << 7
_ICSR, _PENDSVSET = 0x104, 1 << 28


IDLE_ROUND = 150  # instructions of the main loop that finds nothing to do, at most


class Serial(Registers):
    """USART2: one byte in, any number out."""

    def __init__(self) -> None:
        super().__init__()
        self.incoming: deque[int] = deque()
        self.sent = bytearray()

    def read(self, offset: int) -> int:
        if offset == _SR:
            return _TXE | (_RXNE if self.incoming else 0)
        if offset == _DR:
            return self.incoming.popleft()
        return super().read(offset)

    def write(self, offset: int, value: int) -> None:
        if offset == _DR:
            self.sent.append(value & 0xFF)
        else:
            super().write(offset, value)


class SteppedBoard:
    def __init__(self, image: Path, tree: ClockTree) -> None:
        self._serial, self._system = Serial(), Registers()
        self._switch_port = Registers()
        self.processor = Processor(
            image,
            {
                **tree.devices,
                USART2: self._serial,
                SYSTEM_CONTROL: self._system,
                GPIOD: self._switch_port,
            },
        )
        self.locks = self.processor.watch_between("lock_control", "unlock_control")
        self.processor.reset(until="dv_board_poll")
        self._board = self.processor.symbols["board"]
        self._reader = FrameReader()
        self._sequence = Random(1).randint(1, 100)
        self.now = 0
        self._ticks_per_ms = 200
        self.telemetry: Telemetry | None = None

    def tick(self) -> tuple[Cost, Cost | None]:
        """The step interrupt, and control's if the tick has asked for it."""
        self._system.values[_ICSR] = 0
        self.now += 1
        step = self.processor.cost("TIM2_IRQHandler")
        if not self._system.values[_ICSR] & _PENDSVSET:
            return step, None
        return step, self.processor.cost("PendSV_Handler")

    def run(self, ms: int) -> None:
        """Time passes, unmetered."""
        for _ in range(ms * self._ticks_per_ms):
            self._system.values[_ICSR] = 0
            self.now += 1
            self.processor.call("TIM2_IRQHandler")
            if self._system.values[_ICSR] & _PENDSVSET:
                self.processor.call("PendSV_Handler")
                self.processor.call("dv_board_poll", self._board)

    def press_switches(self, pressed: bool) -> None:
        """Of all joints; pressed, they are open circuits."""
        self._switch_port.values[_IDR] = _SWITCHES if pressed else 0

    def state(self) -> BoardState | None:
        self.said()
        return None if self.telemetry is None else self.telemetry.state

    def send(self, message: HostMessage) -> Cost:
        """Received, carried out and answered by the main loop: what that costs, without the
        interrupts of the serial port.
        """
        type_, payload = encode(message)
        sequence = 0
        if isinstance(message, COMMANDS):
            self._sequence += 1
            sequence = self._sequence
        self._serial.incoming.extend(write_frame(type_, sequence, payload))
        while self._serial.incoming:
            self.processor.call("USART2_IRQHandler")
        return self.poll()

    def poll(self) -> Cost:
        """The main loop, until it has nothing to do."""
        instructions = cycles = 0
        while True:
            once = self.processor.cost("dv_board_poll", self._board)
            if once.instructions <= IDLE_ROUND:
                return Cost(instructions, cycles)
            instructions, cycles = instructions + once.instructions, cycles + once.cycles

    def byte(self) -> Cost:
        """The serial port's interrupt for a byte that has come, and means nothing."""
        self._serial.incoming.append(0)
        return self.processor.cost("USART2_IRQHandler")

    def said(self) -> list[BoardMessage]:
        """What the board has sent since the last call."""
        before = -1
        while before != len(self._serial.sent):
            before = len(self._serial.sent)
            self.processor.call("USART2_IRQHandler")
        data, self._serial.sent = bytes(self._serial.sent), bytearray()
        messages = [decode_board(f.type, f.payload) for f in self._reader.feed(data)]
        for message in messages:
            if isinstance(message, Telemetry):
                self.telemetry = message
        return messages
