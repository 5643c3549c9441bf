"""How much more a design reaches than the robot: like is compared with like, as a coarse boundary
holds a little less than a fine one."""

from __future__ import annotations

from dataclasses import dataclass

from deltaviz.scene.workspace.pictures import Skin

_SAME = 0.002  # of the size: not told


def size_told(size: float, *, planar: bool) -> str:
    """mm³, or mm² in a plane, for a person."""
    return f"{_figures(size / 100)} cm²" if planar else f"{_figures(size / 1e6)} l"


def _figures(value: float) -> str:
    return f"{float(f'{value:.3g}'):.15g}"


@dataclass
class OwnSize:
    """Of the robot's own workspace, as coarse boundaries and as fine ones have it, once known."""

    name: str
    planar: bool
    coarse: float | None = None
    fine: float | None = None
    _told: str = ""

    def take(self, skin: Skin) -> None:
        if skin.deviation is None:
            self.coarse = skin.size
        else:
            self.fine = skin.size

    def against(self, skin: Skin) -> str:
        """As "4.1 l more than stm32". While that is not known, what was told before: the coarse
        boundary of the same design said it."""
        own = self.coarse if skin.deviation is None else self.fine
        if own is not None:
            self._told = self._compared(skin.size, own)
        return self._told

    def _compared(self, size: float, own: float) -> str:
        more = size - own
        if abs(more) <= _SAME * own:
            return f"as much as {self.name}"
        way = "more" if more > 0 else "less"
        return f"{size_told(abs(more), planar=self.planar)} {way} than {self.name}"
