"""The inputs of one browser's panel as plain values, so that the console has an equal of each."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from deltaviz.scene.rows import Rows


@dataclass(frozen=True)
class Item:
    """`key` names it within one browser; `group` is the folder that it stands in."""

    kind: ClassVar[str]
    key: str
    group: str


@dataclass(frozen=True)
class Input(Item):
    label: str


@dataclass(frozen=True)
class Toggle(Input):
    kind = "toggle"
    value: bool

    @property
    def takes(self) -> str:
        return "true or false"


@dataclass(frozen=True)
class Choice(Input):
    kind = "choice"
    value: str
    options: tuple[str, ...]

    @property
    def takes(self) -> str:
        return f"one of {', '.join(self.options)}"


@dataclass(frozen=True)
class Slider(Input):
    kind = "slider"
    value: float
    low: float
    high: float
    step: float

    @property
    def takes(self) -> str:
        return f"a number from {self.low:g} to {self.high:g}"


@dataclass(frozen=True)
class Line(Input):
    kind = "line"
    value: str
    hint: str
    longest: int

    @property
    def takes(self) -> str:
        return f"text of at most {self.longest} characters"


@dataclass(frozen=True)
class Button(Input):
    kind = "button"
    disabled: bool

    @property
    def takes(self) -> str:
        return "true, for a press"


@dataclass(frozen=True)
class Readout(Item):
    """Told, and not to be changed."""

    kind = "readout"
    rows: Rows

    @property
    def takes(self) -> str:
        return "nothing"


AnyItem = Toggle | Choice | Slider | Line | Button | Readout
