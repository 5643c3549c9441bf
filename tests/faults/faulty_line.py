"""One direction of a wire that does to what passes what wires do to it, by chance, from a seed."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from random import Random

FRAME_END = b"\0"


class Unit(StrEnum):
    BYTE = "byte"
    FRAME = "frame"


HELD_UP = {Unit.BYTE: (0.0005, 0.003), Unit.FRAME: (0.005, 0.060)}  # s, with all that is behind


class Kind(StrEnum):
    FLIPPED = "flipped"  # one bit of a byte; one to eight bits of a frame
    LOST = "lost"
    DOUBLED = "doubled"
    DELAYED = "delayed"  # by HELD_UP, with all that follows
    REORDERED = "reordered"  # comes after what follows it


@dataclass(frozen=True)
class Fault:
    kind: Kind
    unit: Unit
    rate: float  # of the bytes, or of the frames

    def __str__(self) -> str:
        return f"{self.unit}s {self.kind}"


class FaultyLine:
    """What is put in at a time comes out at that time or later. Without a fault it is a wire."""

    def __init__(self, random: Random, fault: Fault | None = None) -> None:
        self.fault = fault
        self.injected = 0
        self.frames = 0  # that were put in
        self._random = random
        self._begun = b""  # a frame that has no end yet
        self._held = b""  # what is to come after what follows it
        self._free = 0.0  # when the line lets the next byte out
        self._waiting: list[tuple[float, bytes]] = []

    def put(self, data: bytes, now: float) -> None:
        self._free = max(self._free, now)
        *frames, self._begun = (self._begun + data).split(FRAME_END)
        for frame in frames:
            self.frames += 1
            self._pass_on(frame + FRAME_END)

    def take(self, now: float) -> bytes:
        """What has arrived."""
        arrived = b"".join(data for due, data in self._waiting if due <= now)
        self._waiting = [(due, data) for due, data in self._waiting if due > now]
        return arrived

    def clear(self) -> None:
        """What is on its way is lost."""
        self._waiting.clear()
        self._begun = self._held = b""

    def _pass_on(self, frame: bytes) -> None:
        if self.fault is None:
            self._let_out(frame)
        elif self.fault.unit is Unit.FRAME:
            self._spoil(frame, self.fault)
        else:
            for byte in frame:
                self._spoil(bytes((byte,)), self.fault)

    def _spoil(self, piece: bytes, fault: Fault) -> None:
        held, self._held = self._held, b""
        if self._random.random() < fault.rate:
            self.injected += 1
            self._hurt(piece, fault)
        else:
            self._let_out(piece)
        self._let_out(held)

    def _hurt(self, piece: bytes, fault: Fault) -> None:
        match fault.kind:
            case Kind.FLIPPED:
                self._let_out(self._flipped(piece))
            case Kind.LOST:
                pass
            case Kind.DOUBLED:
                self._let_out(piece + piece)
            case Kind.DELAYED:
                self._free += self._random.uniform(*HELD_UP[fault.unit])
                self._let_out(piece)
            case Kind.REORDERED:
                self._held = piece

    def _flipped(self, piece: bytes) -> bytes:
        spoilt, bits = int.from_bytes(piece, "little"), 8 * len(piece)
        for bit in self._random.sample(range(bits), self._random.randint(1, 1 + bits // 50)):
            spoilt ^= 1 << bit
        return spoilt.to_bytes(len(piece), "little")

    def _let_out(self, data: bytes) -> None:
        if data:
            self._waiting.append((self._free, data))
