"""The equals, for the console, of what stands in one browser's panel."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from viser import GuiHtmlHandle

from deltaviz.scene.controls import Controls, Handle, Judgement
from deltaviz.scene.inner import uuid_of
from deltaviz.scene.items import AnyItem


@dataclass(frozen=True)
class Equal:
    """`item` tells it as it is now; `choose` does what a person's choice does, but for what is only
    told: that no value is accepted for."""

    item: Callable[[], AnyItem]
    is_shown: Callable[[], bool]
    handle: Handle | GuiHtmlHandle
    choose: Callable[[Any], None]


class Equals:
    """In the panel's order. Runs in viser's event loop only."""

    def __init__(self, controls: Controls) -> None:
        self._controls = controls
        self._equals: list[Equal] = []

    def add(self, equal: Equal) -> None:
        self._equals.append(equal)

    def drop(self, equals: Sequence[Equal]) -> None:
        """Those that are not there any more."""
        self._equals = [equal for equal in self._equals if equal not in equals]

    def items(self) -> tuple[AnyItem, ...]:
        return tuple(equal.item() for equal in self._equals if equal.is_shown())

    def choose(self, key: str, value: object, *, may_steer: bool) -> str | None:
        """As if it were chosen in the panel, by the same rules; why it was not taken."""
        for equal in self._equals:
            if equal.is_shown() and (item := equal.item()).key == key:
                break
        else:
            return f"The view has no '{key}' now."
        judgement = self._controls.judge(uuid_of(equal.handle), value)
        if judgement is Judgement.STEERS and not may_steer:
            return "Another session has control."
        if judgement not in (Judgement.STEERS, Judgement.SHOWS):
            return f"'{key}' takes {item.takes}."
        equal.choose(value)
        return None
