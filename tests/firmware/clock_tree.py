"""What makes the chip's clock, after RM0090: RCC, and the flash's wait states."""

from __future__ import annotations

from dataclasses import dataclass, field

from tests.firmware.processor import Registers

RCC, FLASH = 0x4002_3800, 0x4002_3C00

_CR, _PLLCFGR, _CFGR = 0x00, 0x04, 0x08
_HSION, _HSIRDY, _HSEON, _HSERDY, _PLLON, _PLLRDY = (1 << bit for bit in (0, 1, 16, 17, 24, 25))
_HSI_HZ = 16_000_000
_HZ_PER_WAIT_STATE = 30_000_000  # at 2.7 to 3.6 V


@dataclass
class ClockTree:
    """`crystal_hz` is 0 where no crystal oscillates; `wrong` is what silicon would not forgive."""

    crystal_hz: int
    pll_locks: bool = True
    wrong: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.flash = Registers()
        self.rcc = _Rcc(self)

    @property
    def pll_input_hz(self) -> float:
        word = self.rcc.values[_PLLCFGR]
        source = self.crystal_hz if word >> 22 & 1 else _HSI_HZ
        return source / (word & 63)

    @property
    def pll_vco_hz(self) -> float:
        return self.pll_input_hz * (self.rcc.values[_PLLCFGR] >> 6 & 511)

    @property
    def system_hz(self) -> float:
        if self.rcc.values[_CFGR] >> 2 & 3 != 2:
            return _HSI_HZ
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
            value |= _PLLRDY if value & _PLLON and tree.pll_locks else 0
        elif offset == _PLLCFGR and self.values[_CR] & _PLLON:
            tree.wrong.append("the PLL was changed while it is on")
        elif offset == _CFGR:
            value = value & ~0xC | self._switched(value & 3) << 2
        super().write(offset, value)
        tree.check()

    def _switched(self, wanted: int) -> int:
        """The clock that is used: the wanted one once it runs."""
        ready = {0: _HSIRDY, 1: _HSERDY, 2: _PLLRDY}.get(wanted, 0)
        return wanted if self.values[_CR] & ready else self.values[_CFGR] >> 2 & 3
