"""How the board stands when its main loop begins: drivers off, pins safe, priorities in order."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest

from deltaviz.link.emulator.firmware import built
from tests.firmware.clock_tree import RCC, ClockTree
from tests.firmware.processor import Processor, Registers

GPIO = {port: 0x4002_0000 + 0x400 * number for number, port in enumerate("ABCDE")}
MODER, PUPDR, AFRL, BSRR = 0x00, 0x0C, 0x20, 0x18
IWDG, RNG, PRIORITIES, SYSTEM_CONTROL = 0x4000_3000, 0x5006_0800, 0xE000_E400, 0xE000_EC00
USART2, CR1, TE, UE = 0x4000_4400, 0x0C, 1 << 3, 1 << 13
CORE = 0xE000_0000
TIM2_IRQ, USART2_IRQ, SHPR3 = 28, 38, 0x120
INPUT, OUTPUT, FUNCTION, FLOATING, PULLED_UP = 0, 1, 2, 0, 1
BOARDS = Path(__file__).parents[2] / "firmware" / "port" / "stm32f407" / "boards"
SILICON = ("disc1", "f407vet6")

# What each pin of the headers is when the main loop begins: mode, pull, function (TIM3, USART2).
CONFIGURED = {
    "STEP": (OUTPUT, FLOATING, 0),
    "DIR": (OUTPUT, FLOATING, 0),
    "ENABLE": (INPUT, FLOATING, 0),  # until a host says which level it is
    "SWITCH": (INPUT, PULLED_UP, 0),
    "ESTOP": (INPUT, PULLED_UP, 0),
    "TOOL": (OUTPUT, FLOATING, 0),
    "SERVO": (FUNCTION, FLOATING, 2),
    "SERIAL_TX": (FUNCTION, FLOATING, 7),
    "SERIAL_RX": (FUNCTION, PULLED_UP, 7),
    "LED": (OUTPUT, FLOATING, 0),
}
OSCILLATOR = (17_000, 47_000)  # Hz, of the watchdog: data sheet of the STM32F407


class Pins(Registers):
    """A port, and the levels that were written to it last."""

    def __init__(self) -> None:
        super().__init__()
        self.levels: dict[int, bool] = {}

    def write(self, offset: int, value: int) -> None:
        super().write(offset, value)
        if offset == BSRR:
            for pin in range(16):
                if value >> pin & 1 or value >> pin + 16 & 1:
                    self.levels[pin] = bool(value >> pin & 1)

    def two_bits(self, offset: int, pin: int) -> int:
        return self.values[offset] >> 2 * pin & 3

    def configuration(self, pin: int) -> tuple[int, int, int]:
        """Mode, pull, and the function that it has (0 to 7 only)."""
        function = self.values[AFRL] >> 4 * pin & 15 if pin < 8 else 0
        return self.two_bits(MODER, pin), self.two_bits(PUPDR, pin), function


class LinkPort(Pins):
    """Port A, which sees what the USART is at when TX becomes its pin."""

    def __init__(self, usart: Registers) -> None:
        super().__init__()
        self._usart = usart
        self.transmitter: int | None = None

    def write(self, offset: int, value: int) -> None:
        super().write(offset, value)
        if self.transmitter is None and self.two_bits(MODER, 2) == FUNCTION:
            self.transmitter = self._usart.values[CR1]


class Watchdog(Registers):
    def __init__(self) -> None:
        super().__init__()
        self.keys: list[int] = []

    def write(self, offset: int, value: int) -> None:
        super().write(offset, value)
        if offset == 0:
            self.keys.append(value)


class RandomNumbers(Registers):
    def read(self, offset: int) -> int:
        return {0x04: 1, 0x08: 0x1234_5678}.get(offset, 0)


def powered(board: str) -> tuple[Processor, dict[int, Any]]:
    tree, usart = ClockTree(8_000_000), Registers()
    devices: dict[int, Any] = {base: Pins() for base in GPIO.values()}
    devices |= {GPIO["A"]: LinkPort(usart), USART2: usart}
    devices |= tree.devices | {IWDG: Watchdog(), RNG: RandomNumbers()}
    devices |= {PRIORITIES: Registers(), SYSTEM_CONTROL: Registers()}
    return Processor(built(f"{board}.elf"), devices), devices


def start(board: str) -> tuple[Processor, dict[int, Any]]:
    processor, devices = powered(board)
    processor.reset(until="dv_board_poll")
    return processor, devices


@pytest.fixture(scope="module", params=SILICON)
def started(request):
    return start(request.param)


@pytest.mark.parametrize("board", SILICON)
def test_no_peripheral_is_spoken_to_before_its_clock_has_come(board):
    """ES0182: two cycles of AHB, or one and its divisor of APB, 4, after RCC was told."""
    processor, _ = powered(board)
    accesses = processor.log_accesses()
    processor.reset(until="dv_board_poll")
    enabled = dict.fromkeys(range(RCC + 0x30, RCC + 0x48, 4), 0)
    waits: list[tuple[int, int]] = []
    for at, told in enumerate(accesses):
        if told.written is None or told.address not in enabled:
            continue
        before, enabled[told.address] = enabled[told.address], told.written
        if told.written & ~before:
            there = (a for a in accesses[at:] if a.address & ~0x3FF != RCC and a.address < CORE)
            first = next(there)
            assert first.barriers > told.barriers, hex(first.address)
            waits.append((first.cycles - told.cycles, first.address))
    own = 2  # cycles of the access itself
    assert min(waits) >= (1 + 4 + own, 0), [(wait, hex(address)) for wait, address in waits]
    assert len(waits) == 7  # power, TIM11, ports, TIM3, random numbers, USART2, TIM2


def pins_of(board: str) -> dict[str, tuple[str, int]]:
    """Port and number of each pin that the board's headers name."""
    text = "".join((BOARDS / f"{header}.h").read_text() for header in ("pins", board))
    found = re.findall(r"#define PIN_(\w+) \(PORT_(\w) \| (\d+)u\)", text)
    return {name: (port, int(number)) for name, port, number in found}


@pytest.mark.parametrize("board", SILICON)
def test_every_pin_that_the_board_has_is_what_it_is_for(board):
    _, devices = start(board)
    pins = pins_of(board)
    right = {name: CONFIGURED[re.sub(r"_\d$", "", name)] for name in pins}
    found = {name: devices[GPIO[port]].configuration(pin) for name, (port, pin) in pins.items()}
    assert found == right
    assert len(pins) == 19


def test_the_link_is_silent_until_its_transmitter_holds_it_high(started):
    _, devices = started
    assert devices[GPIO["A"]].transmitter & (UE | TE) == UE | TE


def test_step_and_dir_are_low_before_they_are_outputs(started):
    _, devices = started
    port = devices[GPIO["E"]]
    assert [port.levels[pin] for pin in range(8, 16)] == [False] * 8


def test_the_tool_is_off(started):
    _, devices = started
    assert devices[GPIO["D"]].levels[11] is False


def test_bytes_before_steps_before_control(started):
    _, devices = started
    priorities = devices[PRIORITIES].values
    serial, step = priorities[USART2_IRQ], priorities[TIM2_IRQ]
    control = devices[SYSTEM_CONTROL].values[SHPR3] >> 16 & 0xFF
    assert serial < step < control
    assert all(priority & 0x0F == 0 for priority in (serial, step, control))  # 4 bits count


def test_the_watchdog_runs_and_bites_between_30_and_100_ms(started):
    _, devices = started
    watchdog = devices[IWDG]
    assert watchdog.keys[0] == 0xCCCC
    assert watchdog.keys[-1] == 0xAAAA
    divisor, reload = 4 << watchdog.values[4], watchdog.values[8]
    slowest, quickest = (1000 * divisor * (reload + 1) / hz for hz in OSCILLATOR)
    assert 30 < quickest < slowest < 100


def test_the_main_loop_feeds_it_only_while_control_runs(started):
    processor, devices = started
    watchdog, board = devices[IWDG], processor.symbols["board"]

    def fed() -> int:
        watchdog.keys.clear()
        processor.call("dv_board_poll", board)
        return watchdog.keys.count(0xAAAA)

    fed()
    assert fed() == 0
    processor.call("PendSV_Handler")
    assert fed() == 1
    assert fed() == 0


def test_a_fault_lets_go_of_the_drivers_and_of_the_tool(started):
    processor, devices = started
    port = devices[GPIO["D"]]
    port.levels[11] = True
    port.values[MODER] |= OUTPUT << 20  # as once a host has enabled them
    processor.run_for(processor.symbols["fault_handler"], instructions=200)
    assert port.two_bits(MODER, 10) == INPUT
    assert port.levels[11] is False
