"""Clock bring-up, as the images for silicon do it, on a model of the chip's clocks.

The emulator has no such clocks, so this is the only place where that code runs.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import pytest

from deltaviz import load_robot
from deltaviz.link.configuration import configure_from
from deltaviz.link.emulator.firmware import built
from deltaviz.link.messages import (
    PROTOCOL_VERSION,
    Enable,
    Hello,
    HelloReply,
    Refusal,
    Refused,
    Telemetry,
)
from tests.firmware.board_processor import SteppedBoard
from tests.firmware.clock_tree import ClockTree
from tests.firmware.processor import Peripheral, Processor, Registers

BOARDS = pytest.mark.parametrize("board", ["disc1", "f407vet6"])
USART2, TIM2 = 0x4000_4400, 0x4000_0000
CR, PLLCFGR, CFGR, APB2ENR = 0x00, 0x04, 0x08, 0x44  # RCC
HSEON, PLLSRC = 1 << 16, 1 << 22
BRR, ARR = 0x08, 0x2C
HAL_BOARD, HAL_TICK_HZ = 4, 16  # in struct dv_hal
FINE, NO_CRYSTAL, NO_PLL, NO_SWITCH, ODD_CRYSTAL = range(5)
CRYSTAL, HSI = PLLSRC, 0


def started(
    board: str, tree: ClockTree, peripherals: Mapping[int, Peripheral] | None = None
) -> Processor:
    """From reset until the main loop begins."""
    processor = Processor(built(f"{board}.elf"), tree.devices | dict(peripherals or {}))
    processor.reset(until="dv_board_poll")
    return processor


def error_of(processor: Processor) -> int:
    """Of its clock, as the board tells it behind its name."""
    name = processor.text(processor.word(processor.symbols["hal"] + HAL_BOARD))
    _, told, number = name.partition(", clock error ")
    return int(number) if told else FINE


def pll_of(tree: ClockTree) -> tuple[int, int, int]:
    """Source, M and N."""
    word = tree.rcc.values[PLLCFGR]
    return word & PLLSRC, word & 63, word >> 6 & 511


@BOARDS
@pytest.mark.parametrize(
    ("tree", "error", "pll"),
    [
        (ClockTree(8_000_000), FINE, (CRYSTAL, 4, 168)),
        (ClockTree(25_000_000), FINE, (CRYSTAL, 25, 336)),
        (ClockTree(0), NO_CRYSTAL, (HSI, 8, 168)),
        (ClockTree(16_000_000), ODD_CRYSTAL, (HSI, 8, 168)),
        (ClockTree(12_000_000), ODD_CRYSTAL, (HSI, 8, 168)),
        (ClockTree(4_000_000), ODD_CRYSTAL, (HSI, 8, 168)),
        (ClockTree(8_000_000, captures=False), ODD_CRYSTAL, (HSI, 8, 168)),
    ],
    ids=["8", "25", "none", "16", "12", "4", "not measured"],
)
def test_it_comes_to_168_mhz_from_whatever_crystal_it_has(board, tree, error, pll):
    tree = replace(tree)
    processor = started(board, tree)
    assert tree.wrong == []
    assert error_of(processor) == error
    assert pll_of(tree) == pll
    assert bool(tree.rcc.values[CR] & HSEON) == (error == FINE)
    assert tree.system_hz == 168e6
    assert tree.wait_states == 5
    assert (tree.bus_hz(1), tree.bus_hz(2)) == (42e6, 84e6)
    assert 1e6 <= tree.pll_input_hz <= 2e6
    assert 100e6 <= tree.pll_vco_hz <= 432e6
    assert tree.random_hz == 48e6


@BOARDS
@pytest.mark.parametrize("crystal_hz", [8_000_000, 25_000_000])
@pytest.mark.parametrize("off", [-0.04, 0.04])
def test_it_knows_its_crystal_however_warm_it_is(board, crystal_hz, off):
    """The oscillator it measures by is 4 % off at worst from -10 to 85 °C: data sheet."""
    tree = ClockTree(crystal_hz, hsi_hz=16e6 * (1 + off))
    assert error_of(started(board, tree)) == FINE
    assert tree.system_hz == 168e6
    assert tree.wrong == []


@BOARDS
@pytest.mark.parametrize("crystal_hz", [8_000_000, 25_000_000])
@pytest.mark.parametrize("off", [-0.06, 0.06])
def test_a_crystal_that_seems_further_off_is_none_that_it_knows(board, crystal_hz, off):
    tree = ClockTree(round(crystal_hz * (1 + off)))
    assert error_of(started(board, tree)) == ODD_CRYSTAL
    assert tree.system_hz == 168e6


@BOARDS
def test_what_measured_the_crystal_is_off_again(board):
    tree = ClockTree(8_000_000)
    started(board, tree)
    assert tree.rcc.values[APB2ENR] == 0
    assert tree.rcc.values[CFGR] >> 16 & 31 == 0


@BOARDS
@pytest.mark.parametrize(
    ("tree", "error"),
    [
        (ClockTree(25_000_000), FINE),
        (ClockTree(0), NO_CRYSTAL),
        (ClockTree(8_000_000, pll_locks=False), NO_PLL),
        (ClockTree(8_000_000, switches=False), NO_SWITCH),
        (ClockTree(16_000_000), ODD_CRYSTAL),
    ],
    ids=["fine", "no crystal", "no pll", "no switch", "odd crystal"],
)
def test_ticks_and_baud_are_right_on_every_clock_and_an_error_is_told(board, tree, error):
    tree = replace(tree)
    serial, timer = Registers(), Registers()
    processor = started(board, tree, {USART2: serial, TIM2: timer})
    slow = error in (NO_PLL, NO_SWITCH)
    assert tree.wrong == []
    assert error_of(processor) == error
    assert tree.system_hz == (16e6 if slow else 168e6)
    tick_hz = 10_000 if slow else 200_000
    assert tree.timer_hz(1) / (timer.values[ARR] + 1) == tick_hz
    assert tree.bus_hz(1) / serial.values[BRR] == pytest.approx(921_600, rel=0.025)
    assert processor.word(processor.symbols["hal"] + HAL_TICK_HZ) == tick_hz


@pytest.mark.parametrize(
    "tree",
    [ClockTree(8_000_000, pll_locks=False), ClockTree(8_000_000, switches=False)],
    ids=["no pll", "no switch"],
)
def test_without_the_pll_the_board_speaks_but_is_not_enabled(tree):
    board = SteppedBoard(built("f407vet6.elf"), replace(tree))
    board.send(Hello(PROTOCOL_VERSION))
    board.send(configure_from(load_robot("stm32")))
    board.send(Enable(on=True))
    greeting, *answers = (m for m in board.said() if not isinstance(m, Telemetry))
    assert isinstance(greeting, HelloReply)
    assert answers == [
        Refused("configure", Refusal.CONFIGURATION),
        Refused("enable", Refusal.CONFIGURATION),
    ]


def test_the_model_notices_what_silicon_would_not_forgive():
    tree = ClockTree(8_000_000)
    tree.rcc.write(CR, 1 << 16 | 1)
    tree.rcc.write(PLLCFGR, 4 | 168 << 6 | 1 << 22 | 7 << 24)
    tree.rcc.write(CR, 1 << 24 | 1 << 16 | 1)
    assert tree.wrong == []
    tree.rcc.write(CFGR, 2)
    assert "168" in tree.wrong[0]
    assert "0 wait states" in tree.wrong[0]
    assert "buses" in tree.wrong[1]
    tree.rcc.write(PLLCFGR, 4 | 160 << 6)
    assert "while it is on" in tree.wrong[2]
