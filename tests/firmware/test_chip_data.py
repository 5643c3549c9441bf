"""What the port says of the chip (registers, interrupts, pins, memory), against published data."""

from __future__ import annotations

import re
import subprocess
from collections.abc import Sequence
from functools import cache
from pathlib import Path

import pytest

from tests.firmware import chip_data
from tests.firmware.c_library import STRICT_C

PORT = Path(__file__).parents[2] / "firmware" / "port" / "stm32f407"
BOARDS = ("disc1", "f407vet6", "emulator")
GPIO = range(5)  # ports A to E

# Where the STM32F407 has less than the STM32F429, or the SVD file another name: RM0090.
FIELDS_OTHERWISE = {
    "PWR_CR_VOS": 1 << 14,
    "TIM11_CCMR1_IC1PSC": 3 << 2,
    "TIM11_OR_TI1_RMP": 3 << 0,
}


def evaluate(header: str, expressions: Sequence[str], folder: Path) -> list[int]:
    """What a C compiler makes of expressions that use what `header` defines."""
    prints = "".join(f'printf("%llu\\n", (unsigned long long)({e}));' for e in expressions)
    program = f'#include <stdio.h>\n#include "{header}"\nint main(void) {{ {prints} return 0; }}\n'
    source, binary = folder / "values.c", folder / "values"
    source.write_text(program)
    subprocess.run(["gcc", *STRICT_C, f"-I{PORT}", "-o", binary, source], check=True)
    return [int(line) for line in subprocess.check_output([binary], text=True).split()]


@cache
def defined(header: str) -> dict[str, str]:
    """Name (with its parameter) and body of each definition."""
    pattern = r"^#define (\w+(?:\(\w+\))?) (.+)$"
    return dict(re.findall(pattern, (PORT / header).read_text(), re.MULTILINE))


def registers() -> list[str]:
    return [n for n, body in defined("regs.h").items() if "volatile" in body or "REGISTER(" in body]


def fields() -> list[str]:
    return [n for n, body in defined("regs.h").items() if re.match(r"\(\d+u << \d+\)", body)]


def published(name: str) -> tuple[int, dict[str, int]]:
    """A register's address and the masks of its fields."""
    peripheral, register = name.split("_", 1)
    return chip_data.registers(peripheral)[register]


def test_registers_stand_where_they_are_published(tmp_path):
    plain = [name for name in registers() if "(" not in name]
    addresses = evaluate("regs.h", [f"(uintptr_t)&{name}" for name in plain], tmp_path)
    assert dict(zip(plain, addresses, strict=True)) == {n: published(n)[0] for n in plain}
    assert len(plain) > 30


def test_registers_of_every_port(tmp_path):
    kinds = [name.split("(")[0] for name in registers() if name.startswith("GPIO_")]
    cases = [(kind, port) for kind in kinds for port in GPIO]
    addresses = evaluate("regs.h", [f"(uintptr_t)&{k}({p}u)" for k, p in cases], tmp_path)
    for (kind, port), address in zip(cases, addresses, strict=True):
        assert address == published(kind.replace("GPIO", f"GPIO{'ABCDE'[port]}"))[0], (kind, port)
    assert len(kinds) == 5


def test_registers_of_every_interrupt(tmp_path):
    numbers = range(82)
    for kind, per_register, step in (("ISER", 32, 0), ("ISPR", 32, 0), ("IPR", 4, 1)):
        found = evaluate("regs.h", [f"(uintptr_t)&NVIC_{kind}({n}u)" for n in numbers], tmp_path)
        assert found == [
            published(f"NVIC_{kind}{n // per_register}")[0] + n % per_register * step
            for n in numbers
        ]
    bits = evaluate("regs.h", [f"NVIC_IRQ_BIT({n}u)" for n in numbers], tmp_path)
    assert bits == [1 << n % 32 for n in numbers]


def test_fields_are_the_published_bits(tmp_path):
    masks = dict(zip(fields(), evaluate("regs.h", fields(), tmp_path), strict=True))
    for name, mask in masks.items():
        register = max((r for r in registers() if name.startswith(f"{r}_")), key=len)
        field = name.removeprefix(f"{register}_")
        right = FIELDS_OTHERWISE.get(name) or published(register)[1][field]
        assert mask == right, name
    assert len(masks) > 40


def test_the_ports_clocks_are_enabled_by_neighbouring_bits(tmp_path):
    (first,) = evaluate("regs.h", ["RCC_AHB1ENR_GPIOAEN"], tmp_path)
    _, bits = published("RCC_AHB1ENR")
    assert [first << port for port in GPIO] == [bits[f"GPIO{'ABCDE'[port]}EN"] for port in GPIO]


def test_interrupts_have_their_places(tmp_path):
    names = [n for n in defined("regs.h") if n.startswith("IRQ_") and n != "IRQ_COUNT"]
    numbers = evaluate("regs.h", [*names, "IRQ_COUNT"], tmp_path)
    published = chip_data.interrupts()
    assert numbers == [
        *(published[name.removeprefix("IRQ_")] for name in names),
        max(published.values()) + 1,
    ]


@pytest.mark.parametrize("board", BOARDS)
def test_every_pin_can_do_what_it_is_for_and_does_nothing_else(tmp_path, board):
    header = f"boards/{board}.h"
    names = [n for h in ("boards/pins.h", header) for n in defined(h) if n.startswith("PIN_")]
    values = dict(zip(names, evaluate(header, names, tmp_path), strict=True))
    pins = {n: f"{'ABCDE'[v >> 4]}{v & 15}" for n, v in values.items() if "FUNCTION" not in n}
    assert len(set(pins.values())) == len(pins)
    assert {"A13", "A14"}.isdisjoint(pins.values())  # the debugger's
    for pin, number, purpose in (
        ("PIN_SERIAL_TX", "PIN_SERIAL_FUNCTION", "usart2 tx"),
        ("PIN_SERIAL_RX", "PIN_SERIAL_FUNCTION", "usart2 rx"),
        ("PIN_SERVO", "PIN_SERVO_FUNCTION", "tim3 ch1"),
    ):
        assert chip_data.pin_functions(pins[pin])[purpose] == values[number]
        assert values[pin] & 15 < 8, "GPIO_AFRL has pins 0 to 7"


def test_the_linker_uses_memory_that_every_chip_has():
    pattern = r"(\w+) +\(\w+\) *: ORIGIN = (\w+), LENGTH = (\d+)K"
    script = (PORT / "stm32f407.ld").read_text()
    used = {name: (int(at, 0), int(size) << 10) for name, at, size in re.findall(pattern, script)}
    there = chip_data.memories()
    (sram1, first), (sram2, second) = there["sram1"], there["sram2"]
    assert sram1 + first == sram2
    assert used == {"FLASH": there["flash"], "RAM": (sram1, first + second)}
