"""What makes the chip's clock, after RM0090: RCC, the flash's wait states, and TIM11, which can
capture the crystal's edges.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from tests.firmware.processor import Registers

RCC, FLASH, TIM11 = 0x4002_3800, 0x4002_3C00, 0x4001_4800

_CR, _PLLCFGR, _CFGR, _APB2ENR = 0x00, 0x04, 0x08, 0x44
_HSION, _HSIRDY, _HSEON, _HSERDY, _PLLON, _PLLRDY = (1 << bit for bit in (0, 1, 16, 17, 24, 25))
_HSI_HZ = 16_000_000
_HZ_PER_WAIT_STATE = 30_000_000  # at 2.7 to 3.6 V


@dataclass
class ClockTree:
    """`crystal_hz` is 0 where no crystal oscillates; `wrong` is what silicon would not forgive."""

    crystal_hz: int
    hsi_hz: float = _HSI_HZ
    pll_locks: bool = True
    switches: bool = True  # to the PLL
    captures: bool = True  # of the crystal's edges
    wrong: list[str] = field(default_factory=list, init=False)

    def __post_init__(self) -> None:
        self.flash = Registers()
        self.rcc = _Rcc(self)
        self.devices: dict[int, Registers] = {RCC: self.rcc, FLASH: self.flash, TIM11: _Tim11(self)}

    @property
    def crystal_runs(self) -> bool:
        return bool(self.rcc.values[_CR] & _HSERDY)

    @property
    def pll_input_hz(self) -> float:
        word = self.rcc.values[_PLLCFGR]
        source = self.crystal_hz if word >> 22 & 1 else self.hsi_hz
        return source / (word & 63)

    @property
    def pll_vco_hz(self) -> float:
        return self.pll_input_hz * (self.rcc.values[_PLLCFGR] >> 6 & 511)

    @property
    def system_hz(self) -> float:
        if self.rcc.values[_CFGR] >> 2 & 3 != 2:
            return self.hsi_hz
        return self.pll_vco_hz / (2 * (self.rcc.values[_PLLCFGR] >> 16 & 3) + 2)

    @property
    def random_hz(self) -> float:
        return self.pll_vco_hz / (self.rcc.values[_PLLCFGR] >> 24 & 15)

    def bus_hz(self, bus: int) -> float:
        """Of APB1 or APB2."""
        prescaler = self.rcc.values[_CFGR] >> (10 if bus == 1 else 13) & 7
        return self.system_hz / (2 << prescaler - 4 if prescaler >= 4 else 1)

    def timer_hz(self, bus: int) -> float:
        """Of a bus's timers: twice its clock, unless that is the system's."""
        return min(self.system_hz, 2 * self.bus_hz(bus))

    @property
    def wait_states(self) -> int:
        return self.flash.values[0] & 7

    def check(self) -> None:
        """After each change: whether the chip could still run."""
        if self.system_hz > (self.wait_states + 1) * _HZ_PER_WAIT_STATE:
            self.wrong.append(f"{self.system_hz / 1e6:g} MHz with {self.wait_states} wait states")
        if self.bus_hz(1) > 42e6 or self.bus_hz(2) > 84e6:
            self.wrong.append(f"buses of {self.bus_hz(1) / 1e6:g} and {self.bus_hz(2) / 1e6:g} MHz")


class _Rcc(Registers):
    def __init__(self, tree: ClockTree) -> None:
        super().__init__()
        self._tree = tree
        self.values |= {_CR: _HSION | _HSIRDY, _PLLCFGR: 0x2400_3010, _CFGR: 0}

    def write(self, offset: int, value: int) -> None:
        tree = self._tree
        if offset == _CR:
            value &= ~(_HSERDY | _PLLRDY)
            value |= _HSERDY if value & _HSEON and tree.crystal_hz else 0
            fed = value & _HSERDY or not self.values[_PLLCFGR] >> 22 & 1
            value |= _PLLRDY if value & _PLLON and fed and tree.pll_locks else 0
        elif offset == _PLLCFGR and self.values[_CR] & _PLLON:
            tree.wrong.append("the PLL was changed while it is on")
        elif offset == _CFGR:
            value = value & ~0xC | self._switched(value & 3) << 2
        super().write(offset, value)
        tree.check()

    def _switched(self, wanted: int) -> int:
        """The clock that is used: the wanted one once it runs."""
        ready = {0: _HSIRDY, 1: _HSERDY, 2: _PLLRDY if self._tree.switches else 0}.get(wanted, 0)
        return wanted if self.values[_CR] & ready else self.values[_CFGR] >> 2 & 3


_CR1, _SR, _CCMR1, _CCER, _ARR, _CCR1, _OR = 0x00, 0x10, 0x18, 0x20, 0x2C, 0x34, 0x50  # TIM11
_CC1IF, _CC1OF = 1 << 1, 1 << 9
_LOOK = 20  # cycles that a look at its flags takes


class _Tim11(Registers):
    """Counts its clock, and captures the count at every so many edges of HSE_RTC. Time passes as
    the program looks at the flags.
    """

    def __init__(self, tree: ClockTree) -> None:
        super().__init__()
        self._tree = tree
        self._cycles = 0
        self._next = 0.37  # of the time between two captures: they begin somewhere

    def read(self, offset: int) -> int:
        if offset == _SR and self._tree.rcc.values[_APB2ENR] >> 18 & 1:
            self._pass(_LOOK)
        if offset == _CCR1:
            self.values[_SR] &= ~_CC1IF
        return super().read(offset)

    def _pass(self, cycles: int) -> None:
        self._cycles += cycles
        between = self._cycles_between_captures()
        while between and self._next * between <= self._cycles:
            self.values[_SR] |= _CC1OF if self.values[_SR] & _CC1IF else _CC1IF
            self.values[_CCR1] = int(self._next * between) % (self.values[_ARR] + 1)
            self._next += 1

    def _cycles_between_captures(self) -> float:
        """0 where there are none."""
        tree, prescaler = self._tree, self._tree.rcc.values[_CFGR] >> 16 & 31
        counts = self.values[_CR1] & 1 and self.values[_ARR]
        listens = self.values[_OR] & 3 == 2 and self.values[_CCMR1] & 3 == 1
        hears = tree.crystal_runs and prescaler >= 2 and tree.captures
        if not (counts and listens and hears and self.values[_CCER] & 1):
            return 0
        edges = 1 << (self.values[_CCMR1] >> 2 & 3)
        return tree.timer_hz(2) * edges * prescaler / tree.crystal_hz
