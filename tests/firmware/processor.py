"""The firmware's image in Unicorn, instruction by instruction, and models of its peripherals."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

from capstone import CS_ARCH_ARM, CS_MODE_MCLASS, CS_MODE_THUMB, Cs
from elftools.elf.elffile import ELFFile
from unicorn import UC_ARCH_ARM, UC_HOOK_BLOCK, UC_HOOK_CODE, UC_MODE_MCLASS, UC_MODE_THUMB
from unicorn.arm_const import (
    UC_ARM_REG_LR,
    UC_ARM_REG_PC,
    UC_ARM_REG_R0,
    UC_ARM_REG_R1,
    UC_ARM_REG_R2,
    UC_ARM_REG_R3,
    UC_ARM_REG_SP,
    UC_CPU_ARM_CORTEX_M4,
)
from unicorn.unicorn import Uc

FLASH, RAM = 0x0800_0000, 0x2000_0000
PERIPHERALS = ((0x4000_0000, 0x30000), (0x5006_0000, 0x1000), (0xE000_E000, 0x1000))
BLOCK = 0x400  # bytes of addresses that one peripheral has
NOWHERE = FLASH + 0xF_FF00  # where calls return to: flash that no image fills
ARGUMENTS = (UC_ARM_REG_R0, UC_ARM_REG_R1, UC_ARM_REG_R2, UC_ARM_REG_R3)


class Peripheral(Protocol):
    """Registers by their offset in the peripheral."""

    def read(self, offset: int) -> int: ...
    def write(self, offset: int, value: int) -> None: ...


class Registers:
    """A peripheral that keeps what is written to it, and does nothing."""

    def __init__(self) -> None:
        self.values: Counter[int] = Counter()

    def read(self, offset: int) -> int:
        return self.values[offset]

    def write(self, offset: int, value: int) -> None:
        self.values[offset] = value


@dataclass(frozen=True, slots=True)
class Access:
    """Of a peripheral's register: how far the processor had come by then."""

    address: int
    written: int | None  # None: it was read
    cycles: int  # ever, estimated
    barriers: int  # ever: DSB


@dataclass(frozen=True, slots=True)
class Cost:
    instructions: int
    cycles: int  # estimated, without wait states


class Processor:
    """`peripherals` by their first address; those that are not given keep what is written."""

    def __init__(self, image: Path, peripherals: Mapping[int, Peripheral]) -> None:
        with image.open("rb") as file:
            elf = ELFFile(file)
            table: Any = elf.get_section_by_name(".symtab")
            self.symbols = {s.name: s["st_value"] & ~1 for s in table.iter_symbols() if s.name}
            segments = [
                (s["p_paddr"], s.data())
                for s in elf.iter_segments()
                if s["p_type"] == "PT_LOAD" and s["p_filesz"]
            ]
        self._uc = Uc(UC_ARCH_ARM, UC_MODE_THUMB | UC_MODE_MCLASS)
        self._uc.ctl_set_cpu_model(UC_CPU_ARM_CORTEX_M4)
        self._uc.mem_map(FLASH, 1 << 20)
        self._uc.mem_map(RAM, 128 << 10)
        for address, data in segments:
            self._uc.mem_write(address, data)
        self._peripherals = dict(peripherals)
        for start, size in PERIPHERALS:
            self._uc.mmio_map(start, size, self._read, start, self._write, start)
        self._meter = _Meter(self._uc)
        self._accesses: list[Access] | None = None
        self._cycles = self._barriers = 0

    def _peripheral(self, address: int) -> Peripheral:
        return self._peripherals.setdefault(address - address % BLOCK, Registers())

    def _read(self, _uc: Uc, offset: int, _size: int, start: Any) -> int:
        self._accessed(start + offset, None)
        return self._peripheral(start + offset).read(offset % BLOCK)

    def _write(self, _uc: Uc, offset: int, _size: int, value: int, start: Any) -> None:
        self._accessed(start + offset, value)
        self._peripheral(start + offset).write(offset % BLOCK, value)

    def _accessed(self, address: int, written: int | None) -> None:
        if self._accesses is not None:
            self._accesses.append(Access(address, written, self._cycles, self._barriers))

    def log_accesses(self) -> list[Access]:
        """Of peripherals, from now on, in their order."""
        self._accesses = []
        decoder = Cs(CS_ARCH_ARM, CS_MODE_THUMB | CS_MODE_MCLASS)

        def step(uc: Uc, address: int, size: int, _data: Any) -> None:
            code = bytes(uc.mem_read(address, size))
            _, _, name, operands = next(decoder.disasm_lite(code, address))
            self._cycles += _cycles(name, operands)
            self._barriers += name == "dsb"

        self._uc.hook_add(UC_HOOK_CODE, step)
        return self._accesses

    def reset(self, until: str) -> None:
        """From reset to the first call of the function `until`."""
        stack, entry = (self.word(FLASH + 4 * i) for i in range(2))
        self._uc.reg_write(UC_ARM_REG_SP, stack)
        self._run(entry, self.symbols[until])

    def call(self, function: str | int, *arguments: int) -> int:
        """What it returns. From where `reset` has stopped; as an interrupt is called, too."""
        for register, value in zip(ARGUMENTS, arguments, strict=False):
            self._uc.reg_write(register, value)
        self._uc.reg_write(UC_ARM_REG_LR, NOWHERE | 1)
        entry = self.symbols[function] if isinstance(function, str) else function
        self._run(entry, NOWHERE)
        return self._uc.reg_read(UC_ARM_REG_R0)

    def run_for(self, entry: int, *, instructions: int) -> None:
        """From an address, for what does not end by itself."""
        self._uc.emu_start(entry | 1, NOWHERE, count=instructions)

    def cost(self, function: str | int, *arguments: int) -> Cost:
        """Of a call, from its first instruction to its last."""
        with self._meter:
            self.call(function, *arguments)
        return Cost(self._meter.instructions, self._meter.cycles)

    def watch(self, *functions: str) -> None:
        """What calls of these cost while `cost` is measured is kept in `watched`."""
        self._meter.watch({self.symbols[name]: name for name in functions})

    def watch_between(self, begin: str, end: str) -> list[Cost]:
        """What passes from each call of `begin` to the next of `end`, while `cost` is measured."""
        return self._meter.watch_between(self.symbols[begin], self.symbols[end])

    @property
    def watched(self) -> dict[str, list[Cost]]:
        return self._meter.watched

    def _run(self, start: int, until: int) -> None:
        self._uc.emu_start(start | 1, until)
        at = self._uc.reg_read(UC_ARM_REG_PC)
        assert at == until, f"it hangs at {self._where(at)}"

    def _where(self, address: int) -> str:
        before = {n: a for n, a in self.symbols.items() if a <= address}
        return max(before, key=lambda name: before[name], default=hex(address))

    def word(self, address: int) -> int:
        return int.from_bytes(self.memory(address, 4), "little")

    def memory(self, address: int, size: int) -> bytes:
        return bytes(self._uc.mem_read(address, size))

    def text(self, address: int) -> str:
        """A string up to its NUL."""
        return self.memory(address, 128).split(b"\0")[0].decode("ascii")

    def store(self, address: int, data: bytes) -> None:
        self._uc.mem_write(address, data)


# Cycles of a Cortex-M4 without wait states (its technical reference manual, 3.3 and 7.2.3), the
# worse one where it says several; what is not named takes one.
_CYCLES: tuple[tuple[str, Callable[[str], int]], ...] = (
    (r"v(div|sqrt)", lambda _: 14),
    (r"v(f?n?ml[as]|fn?m[as])", lambda _: 3),
    (r"v(push|pop|ldm|stm)", lambda operands: 1 + _registers(operands)),
    (r"push|pop|ldm|stm", lambda operands: 1 + _registers(operands)),
    (r"ldrd|strd", lambda _: 3),
    (r"v?(ldr|str)", lambda _: 2),
    (r"[us]div", lambda _: 12),
)
_TAKEN = 3  # more for a branch that is taken: the pipeline fills again


def _registers(operands: str) -> int:
    return operands.count(",") + 1


class _Meter:
    """Counts instructions and adds up their cycles, block by block, while it is entered."""

    def __init__(self, uc: Uc) -> None:
        self._uc = uc
        self._decoder = Cs(CS_ARCH_ARM, CS_MODE_THUMB | CS_MODE_MCLASS)
        self._blocks: dict[tuple[int, int], Cost] = {}
        self._on = False
        self._next = 0
        self._names: dict[int, str] = {}
        self._open: list[tuple[str, int, int, int]] = []  # name, return address, and so far
        self.watched: dict[str, list[Cost]] = {}
        self._ends: tuple[int, int] | None = None
        self._began = Cost(0, 0)
        self._between: list[Cost] = []
        self.instructions = self.cycles = 0
        # From the first block on: code that has run without a hook never meets one.
        uc.hook_add(UC_HOOK_BLOCK, self._block)

    def watch(self, names: dict[int, str]) -> None:
        self._names = names
        self.watched = {name: [] for name in names.values()}

    def watch_between(self, begin: int, end: int) -> list[Cost]:
        self._ends = begin, end
        return self._between

    def _note_between(self, address: int) -> None:
        begin, end = self._ends or (None, None)
        if address == begin:
            self._began = Cost(self.instructions, self.cycles)
        elif address == end:
            self._between.append(
                Cost(self.instructions - self._began.instructions, self.cycles - self._began.cycles)
            )

    def __enter__(self) -> None:
        self.instructions = self.cycles = self._next = 0
        self._open.clear()
        self._on = True

    def __exit__(self, *_: object) -> None:
        self._on = False

    def _block(self, _uc: Uc, address: int, size: int, _data: Any) -> None:
        if not self._on:
            return
        if self._open and address == self._open[-1][1]:
            name, _, instructions, cycles = self._open.pop()
            self.watched[name].append(Cost(self.instructions - instructions, self.cycles - cycles))
        self._note_between(address)
        if address in self._names:
            back = self._uc.reg_read(UC_ARM_REG_LR) & ~1
            self._open.append((self._names[address], back, self.instructions, self.cycles))
        cost = self._blocks.get((address, size)) or self._decode(address, size)
        self.instructions += cost.instructions
        self.cycles += cost.cycles + (_TAKEN if self._next not in (0, address) else 0)
        self._next = address + size

    def _decode(self, address: int, size: int) -> Cost:
        code = bytes(self._uc.mem_read(address, size))
        lines = list(self._decoder.disasm_lite(code, address))
        assert sum(length for _, length, _, _ in lines) == size
        cost = Cost(len(lines), sum(_cycles(name, operands) for _, _, name, operands in lines))
        self._blocks[address, size] = cost
        return cost


def _cycles(mnemonic: str, operands: str) -> int:
    return next((cycles(operands) for name, cycles in _CYCLES if re.match(name, mnemonic)), 1)
