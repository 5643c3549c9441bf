"""How the board stands when its main loop begins: drivers off, pins safe, priorities in order."""

from __future__ import annotations

import pytest

from deltaviz.link.emulator.firmware import built
from tests.firmware.clock_tree import FLASH, RCC, ClockTree
from tests.firmware.processor import Processor, Registers

GPIO = {port: 0x4002_0000 + 0x400 * number for number, port in enumerate("ABCDE")}
MODER, PUPDR, AFRL, BSRR = 0x00, 0x0C, 0x20, 0x18
IWDG, RNG, PRIORITIES, SYSTEM_CONTROL = 0x4000_3000, 0x5006_0800, 0xE000_E400, 0xE000_EC00
TIM2_IRQ, USART2_IRQ, SHPR3 = 28, 38, 0x120
INPUT, OUTPUT, FUNCTION, PULLED_UP = 0, 1, 2, 1
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


@pytest.fixture(scope="module")
def started():
    tree = ClockTree(25_000_000)
    devices: dict[int, Registers] = {base: Pins() for base in GPIO.values()}
    devices |= {RCC: tree.rcc, FLASH: tree.flash, IWDG: Watchdog(), RNG: RandomNumbers()}
    devices |= {PRIORITIES: Registers(), SYSTEM_CONTROL: Registers()}
    processor = Processor(built("f407vet6.elf"), devices)
    processor.reset(until="dv_board_poll")
    return processor, devices


def test_enable_floats_until_a_host_says_which_level_it_is(started):
    _, devices = started
    port = devices[GPIO["D"]]
    assert port.two_bits(MODER, 10) == INPUT
    assert port.two_bits(PUPDR, 10) == 0


def test_step_and_dir_are_low_before_they_are_outputs(started):
    _, devices = started
    port = devices[GPIO["E"]]
    assert all(port.two_bits(MODER, pin) == OUTPUT for pin in range(8, 16))
    assert [port.levels[pin] for pin in range(8, 16)] == [False] * 8


def test_every_input_has_its_pull_up(started):
    _, devices = started
    port = devices[GPIO["D"]]
    for pin in (0, 1, 3, 6, 7):
        assert (port.two_bits(MODER, pin), port.two_bits(PUPDR, pin)) == (INPUT, PULLED_UP)


def test_the_tool_is_off(started):
    _, devices = started
    assert devices[GPIO["D"]].levels[11] is False
    assert devices[GPIO["C"]].two_bits(MODER, 6) == FUNCTION
    assert devices[GPIO["C"]].values[AFRL] >> 24 & 15 == 2  # TIM3


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


def test_a_fault_lets_go_of_the_drivers(started):
    processor, devices = started
    port = devices[GPIO["D"]]
    port.values[MODER] |= OUTPUT << 20  # as once a host has enabled them
    processor.run_for(processor.symbols["fault_handler"], instructions=200)
    assert port.two_bits(MODER, 10) == INPUT
