"""A host's stream to the emulated board, with a faulty line each way."""

from __future__ import annotations

from random import Random

from deltaviz.link.wire.stream import ByteStream
from tests.faults.faulty_line import FRAME_END, Fault, FaultyLine


class FaultyStream:
    """Its clock goes on by `turn` (s) whenever the host reads. A fault may be set while it is in
    use; `cut` lets nothing pass.
    """

    def __init__(self, stream: ByteStream, *, turn: float, seed: int) -> None:
        self._stream = stream
        self._turn = turn
        self._now = 0.0
        self._to_board, self._to_host = FaultyLine(Random(seed)), FaultyLine(Random(seed + 1))
        self.cut = False
        self.missed = 0  # frames of the board, while it was cut
        self.said = b""  # all by the board, before it was hurt

    def hurt(self, fault: Fault | None) -> None:
        self._to_board.fault = self._to_host.fault = fault

    @property
    def injected(self) -> int:
        return self._to_board.injected + self._to_host.injected

    @property
    def ended(self) -> str | None:
        return self._stream.ended

    def write(self, data: bytes) -> int:
        if not self.cut:
            self._to_board.put(data, self._now)
            self._pass_on()
        return len(data)

    def read(self) -> bytes:
        self._now += self._turn
        heard = self._stream.read()
        self.said += heard
        self._pass_on()
        if self.cut:
            self.missed += heard.count(FRAME_END)
        else:
            self._to_host.put(heard, self._now)
        return self._to_host.take(self._now)

    def fileno(self) -> int:
        return self._stream.fileno()

    def close(self) -> None:
        self._stream.close()

    def _pass_on(self) -> None:
        data = self._to_board.take(self._now)
        while data:
            data = data[self._stream.write(data) :]
