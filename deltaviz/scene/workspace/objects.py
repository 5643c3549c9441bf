"""What a person may lay into the scene: paper, a table, a belt."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from deltaviz.robots.workspace.cells import Box
from deltaviz.robots.workspace.sheets import Disc, Rectangle, Sheet

BELT = 800.0  # mm, its width
LETTER = (215.9, 279.4)
A4 = (210.0, 297.0)
_BEYOND = 0.15  # of the workspace's longest side, that a belt is drawn past it


class Kind(Enum):
    """Values are what a person reads."""

    NONE = "None"
    TABLE = "Table"
    ROUND_TABLE = "Round table"
    BELT_X = "Belt 800 mm along X"
    BELT_Y = "Belt 800 mm along Y"
    LETTER = "Letter paper"
    A4 = "A4 paper"

    @property
    def belt_axis(self) -> int | None:
        """The axis along which it is endless."""
        return {Kind.BELT_X: 0, Kind.BELT_Y: 1}.get(self)


@dataclass(frozen=True)
class Thing:
    """`width` along x (of a round table, its diameter) and `depth` along y count for tables."""

    kind: Kind
    width: float
    depth: float

    def sheet(self, level: float, box: Box) -> Sheet:
        """What is drawn of it at a height; `box` holds the workspace."""
        kind = self.kind
        if kind is Kind.ROUND_TABLE:
            return Disc(self.width, level)
        if kind is Kind.TABLE:
            return Rectangle((self.width, self.depth), level)
        axis = kind.belt_axis
        if axis is None:
            return Rectangle(LETTER if kind is Kind.LETTER else A4, level)
        past = _BEYOND * float(box.size.max())
        length = 2 * (float(max(-box.low[axis], box.high[axis])) + past)
        return Rectangle((length, BELT) if axis == 0 else (BELT, length), level)

    def __str__(self) -> str:
        match self.kind:
            case Kind.TABLE:
                return f"Table {self.width:g} by {self.depth:g} mm"
            case Kind.ROUND_TABLE:
                return f"Round table {self.width:g} mm across"
            case kind:
                return kind.value
