"""Which inputs of viser's panel exist, what values they take, and who may set them."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable
from enum import Enum, auto

from viser import (
    GuiButtonHandle,
    GuiCheckboxHandle,
    GuiDropdownHandle,
    GuiHtmlHandle,
    GuiSliderHandle,
    GuiTextHandle,
)

from deltaviz.scene.inner import uuid_of

_RETIRED_KEPT = 256
LONGEST_TEXT = 80

Handle = (
    GuiSliderHandle[float]
    | GuiCheckboxHandle
    | GuiDropdownHandle[str]
    | GuiTextHandle
    | GuiButtonHandle
)


class Judgement(Enum):
    STEERS = auto()  # moves the robot or writes a file: for the session in control
    SHOWS = auto()  # changes a picture only: for anyone
    STALE = auto()  # of an input that is gone: to be dropped
    REFUSED = auto()  # nothing that our page sends


class Controls:
    """The inputs and draggable nodes that browsers may use. Read by the gateway's thread.

    To drag one of `draggable` moves the robot; of `slidable`, a part of one browser's picture.
    """

    def __init__(self) -> None:
        self._inputs: dict[str, tuple[Judgement, Callable[[object], bool]]] = {}
        self._retired: deque[str] = deque(maxlen=_RETIRED_KEPT)
        self.draggable: frozenset[str] = frozenset()
        self.slidable: frozenset[str] = frozenset()

    def add_slider(
        self, handle: GuiSliderHandle[float], judgement: Judgement = Judgement.STEERS
    ) -> None:
        """Its range is asked anew for every value."""

        def accepts(value: object) -> bool:
            if isinstance(value, bool) or not isinstance(value, (int, float)):
                return False
            slack = 1e-6 * (handle.max - handle.min)  # the page rounds
            return math.isfinite(value) and handle.min - slack <= value <= handle.max + slack

        self._inputs[uuid_of(handle)] = (judgement, accepts)

    def add_toggle(self, handle: GuiCheckboxHandle) -> None:
        self._inputs[uuid_of(handle)] = (Judgement.SHOWS, lambda value: isinstance(value, bool))

    def add_choice(
        self, handle: GuiDropdownHandle[str], judgement: Judgement = Judgement.STEERS
    ) -> None:
        self._inputs[uuid_of(handle)] = (
            judgement,
            lambda value: isinstance(value, str) and value in handle.options,
        )

    def add_text(self, handle: GuiTextHandle) -> None:
        """A line that changes a picture; what is half typed comes too."""
        self._inputs[uuid_of(handle)] = (
            Judgement.SHOWS,
            lambda value: isinstance(value, str) and len(value) <= LONGEST_TEXT,
        )

    def add_button(self, handle: GuiButtonHandle, judgement: Judgement) -> None:
        self._inputs[uuid_of(handle)] = (judgement, lambda value: value is True)

    def retire(self, handle: Handle | GuiHtmlHandle) -> None:
        """The input was removed; what is still on the way for it is harmless. What is only told has
        none."""
        if self._inputs.pop(uuid_of(handle), None) is not None:
            self._retired.append(uuid_of(handle))

    def judge(self, uuid: str, value: object) -> Judgement:
        entry = self._inputs.get(uuid)
        if entry is None:
            return Judgement.STALE if uuid in self._retired else Judgement.REFUSED
        judgement, accepts = entry
        return judgement if accepts(value) else Judgement.REFUSED

    def judge_drag(self, node: str) -> Judgement:
        if node in self.draggable:
            return Judgement.STEERS
        return Judgement.SHOWS if node in self.slidable else Judgement.REFUSED
