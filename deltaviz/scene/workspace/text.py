"""What is told of the workspace in words: its size, why it is empty, the key to the colours."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from deltaviz.scene import colours
from deltaviz.scene.rows import ColourKey, Row, Rows
from deltaviz.scene.workspace.compared import OwnSize, size_told
from deltaviz.scene.workspace.measures import PLAIN, colour_key, measure_named
from deltaviz.scene.workspace.pictures import Fitted, Singularities, Skin, Surface

_NAMES = {
    "boundary": "the reach",
    "refined": "the reach",
    "fitted": "the largest body",
    "singular": "the singularities",
}
_KINDS = (
    ("Type 1", "an arm straight or folded: the end of what the arms reach"),
    ("Type 2", "the forearms hold the effector no more"),
)
LINES = 3  # always there, so that what is below does not jump


@dataclass
class Told:
    """What is known, of one browser's choices."""

    planar: bool
    measure: str = PLAIN
    skin: Skin | None = None
    fitted: Fitted | None = None
    singular: Singularities | None = None
    scale: tuple[float, float] | None = None
    problem: str | None = None
    own: OwnSize | None = None  # what the reach is compared with
    waiting: set[str] = field(default_factory=set[str])

    def rows(self) -> Rows:
        return (*map(Row, self.lines()), *self._singular(), *self._key())

    def lines(self) -> list[str]:
        lines = [self.problem] if self.problem else []
        if self.skin is not None:
            lines.append(self._reach(self.skin))
        if self.fitted is not None:
            lines.append(self._fitted(self.fitted))
        waiting = self.waiting - ({"boundary"} if self.skin is not None else set())
        named = sorted({_NAMES[topic] for topic in waiting if topic in _NAMES})
        if named:
            lines.append(f"Computing {' and '.join(named)} …")
        return lines

    def _reach(self, skin: Skin) -> str:
        if skin.reason is not None:
            return f"The workspace is empty. {skin.reason}"
        size = size_told(skin.size, planar=self.planar)
        if self.own is not None and (compared := self.own.against(skin)):
            size = f"{size} ({compared})"
        if skin.deviation is None:
            return f"Reach: about {size}, drawn coarsely."
        return f"Reach: {size}, drawn within {max(skin.deviation, 0.1):.1f} mm."

    def _fitted(self, fitted: Fitted) -> str:
        name = "rectangle" if self.planar else "cylinder"
        if fitted.shape is None:
            return f"No {name} fits."
        return f"Largest {fitted.shape}."

    def _singular(self) -> list[Row]:
        if self.singular is None:
            return []
        surfaces = (self.singular.type_1, self.singular.type_2)
        return [
            Row(f"{name} ({what}): {how_near(surface)}", dot=colour)
            for (name, what), surface, colour in zip(
                _KINDS, surfaces, colours.SINGULAR, strict=True
            )
        ]

    def _key(self) -> list[ColourKey]:
        measure = measure_named(self.measure)
        if measure is None or self.scale is None:
            return []
        return [colour_key(measure, self.scale)]


def how_near(surface: Surface | None) -> str:
    if surface is None:
        return "there is no workspace to come near to."
    if surface.distance is None:
        return f"none within {surface.near:.0f} mm of the workspace."
    if surface.distance == 0.0:
        return "goes through the workspace."
    return f"comes to within {math.ceil(surface.distance)} mm of the workspace."
