"""What left the pins: QEMU's trace of every write to a register, reduced on the fly.

It shares nothing with the firmware, nor with what the host believes: where the pins are is taken
from the wiring (docs/hardware.md), and time is counted in interrupts of the tick's timer.
"""

from __future__ import annotations

import os
import re
import struct
import subprocess
import sys
import time
from tempfile import TemporaryFile

STEP_PINS = 8  # PE8 to PE11: STEP of joints 1 to 4; PE12 to PE15: their DIR
_TIMER_FLAG = b"40000010"  # TIM2_SR, cleared once in each interrupt
_PINS = b"40021018"  # GPIOE_BSRR
_CHANGE = struct.Struct("<QB")
_AT_ONCE = 1 << 16  # bytes
_LOOK = 0.02  # s
PATIENCE = 60.0  # s, of a loaded machine
_WRITE = re.compile(b"addr 0x(" + _TIMER_FLAG + b"|" + _PINS + b") value 0x([0-9a-f]+) ")


class Reduction:
    """Bytes of the trace in; `changes` are (tick, levels of PE8 to PE15), whenever those differ
    from before. A tick is the number of timer interrupts since the start.
    """

    def __init__(self) -> None:
        self.tick = 0
        self.levels = 0
        self._partial = b""

    def feed(self, data: bytes) -> list[tuple[int, int]]:
        """The changes in `data`."""
        whole, end, self._partial = (self._partial + data).rpartition(b"\n")
        changes: list[tuple[int, int]] = []
        for address, value in _WRITE.findall(whole + end):
            if address == _TIMER_FLAG:
                self.tick += 1
                continue
            bits = int(value, 16)
            levels = (self.levels & ~(bits >> 16 + STEP_PINS) | bits >> STEP_PINS) & 0xFF
            if levels != self.levels:
                self.levels = levels
                changes.append((self.tick, levels))
        return changes


class PinTrace:
    """A process of its own reads the trace, so that nobody waits for it."""

    def __init__(self) -> None:
        read, self.descriptor = os.pipe()  # `descriptor` is for QEMU
        self._reduced = TemporaryFile()  # noqa: SIM115
        command = [sys.executable, "-m", "tests.emulator.pin_trace"]
        self._reader = subprocess.Popen(command, stdin=read, stdout=self._reduced)
        os.close(read)

    def started(self) -> None:
        """QEMU has its end: ours is closed, so that reading ends when QEMU does."""
        os.close(self.descriptor)

    def finish(self) -> tuple[list[tuple[int, int]], int]:
        """After QEMU has ended: all changes, and the last tick."""
        assert self._reader.wait() == 0
        changes = self._read()
        self._reduced.close()
        return changes, changes[-1][0]

    def until(self, tick: int) -> list[tuple[int, int]]:
        """All changes so far, as soon as they reach `tick`."""
        end = time.monotonic() + PATIENCE
        while not (changes := self._read()) or changes[-1][0] < tick:
            assert self._reader.poll() is None, "the trace has ended"
            assert time.monotonic() < end, f"the trace does not come to tick {tick}"
            time.sleep(_LOOK)
        return changes

    def _read(self) -> list[tuple[int, int]]:
        """Besides the changes, how far each reading came, with the levels as they were."""
        size = os.fstat(self._reduced.fileno()).st_size // _CHANGE.size * _CHANGE.size
        return list(_CHANGE.iter_unpack(os.pread(self._reduced.fileno(), size, 0)))


def main() -> None:
    reduction = Reduction()
    while data := os.read(0, _AT_ONCE):
        told = [*reduction.feed(data), (reduction.tick, reduction.levels)]
        sys.stdout.buffer.write(b"".join(_CHANGE.pack(*each) for each in told))
        sys.stdout.buffer.flush()


if __name__ == "__main__":
    main()
