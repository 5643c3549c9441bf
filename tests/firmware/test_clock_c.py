"""Clock bring-up, as the images for silicon do it, on a model of the chip's clocks.

The emulator has no such clocks, so this is the only place where that code runs.
"""

from __future__ import annotations

from collections.abc import Mapping

import pytest

from deltaviz.link.emulator.firmware import built
from tests.firmware.clock_tree import FLASH, RCC, ClockTree
from tests.firmware.processor import Peripheral, Processor, Registers

CRYSTALS = {"disc1": 8_000_000, "f407vet6": 25_000_000}
USART2, TIM2 = 0x4000_4400, 0x4000_0000
CR, PLLCFGR, CFGR = 0x00, 0x04, 0x08  # RCC
BRR, ARR = 0x08, 0x2C
HAL_BOARD, HAL_TICK_HZ = 4, 16  # in struct dv_hal


def started(
    board: str, tree: ClockTree, peripherals: Mapping[int, Peripheral] | None = None
) -> Processor:
    """From reset until the main loop begins."""
    clocks = {RCC: tree.rcc, FLASH: tree.flash}
    processor = Processor(built(f"{board}.elf"), clocks | dict(peripherals or {}))
    processor.reset(until="dv_board_poll")
    return processor


@pytest.mark.parametrize("board", CRYSTALS)
@pytest.mark.parametrize("crystal", [True, False])
def test_it_comes_to_168_mhz_with_and_without_its_crystal(board, crystal):
    tree = ClockTree(CRYSTALS[board] if crystal else 0)
    started(board, tree)
    assert tree.wrong == []
    assert tree.system_hz == 168e6
    assert tree.wait_states == 5
    assert (tree.bus_hz(1), tree.bus_hz(2)) == (42e6, 84e6)
    assert 1e6 <= tree.pll_input_hz <= 2e6
    assert 100e6 <= tree.pll_vco_hz <= 432e6
    assert tree.random_hz == 48e6


@pytest.mark.parametrize("board", CRYSTALS)
@pytest.mark.parametrize(
    ("crystal", "pll_locks", "error"), [(True, True, 0), (False, True, 1), (True, False, 2)]
)
def test_ticks_and_baud_are_right_on_every_clock_and_an_error_is_told(
    board, crystal, pll_locks, error
):
    tree = ClockTree(CRYSTALS[board] if crystal else 0, pll_locks=pll_locks)
    serial, timer = Registers(), Registers()
    processor = started(board, tree, {USART2: serial, TIM2: timer})
    assert tree.wrong == []
    assert tree.system_hz == (168e6 if pll_locks else 16e6)
    tick_hz = 200_000 if pll_locks else 10_000
    assert tree.timer_hz(1) / (timer.values[ARR] + 1) == tick_hz
    assert tree.bus_hz(1) / serial.values[BRR] == pytest.approx(921_600, rel=0.025)
    hal = processor.symbols["hal"]
    name = processor.text(processor.word(hal + HAL_BOARD))
    assert ("clock error" in name) == (error > 0)
    assert error == 0 or name.endswith(f"clock error {error}")
    assert processor.word(hal + HAL_TICK_HZ) == tick_hz


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
