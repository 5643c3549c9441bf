"""Inputs of one browser's panel that change a picture and nothing else."""

from __future__ import annotations

from collections.abc import Callable, Coroutine, Sequence
from typing import Any

import viser
from viser import (
    GuiCheckboxHandle,
    GuiDropdownHandle,
    GuiEvent,
    GuiHtmlHandle,
    GuiSliderHandle,
    GuiTextHandle,
)

from deltaviz.scene.controls import Controls, Handle, Judgement


class Inputs:
    """Each calls back with what a person chose, never with what we set."""

    def __init__(self, gui: viser.GuiApi, controls: Controls) -> None:
        self._gui = gui
        self._controls = controls
        self._handles: list[Handle] = []
        self._texts: list[GuiHtmlHandle] = []

    def toggle(self, label: str, value: bool, chosen: Callable[[bool], None]) -> GuiCheckboxHandle:
        handle = self._gui.add_checkbox(label, value)
        self._controls.add_toggle(handle)
        return self._kept(handle, chosen)

    def choice(
        self, label: str, options: Sequence[str], value: str, chosen: Callable[[str], None]
    ) -> GuiDropdownHandle[str]:
        handle = self._gui.add_dropdown(label, options, initial_value=value)
        self._controls.add_choice(handle, Judgement.SHOWS)
        return self._kept(handle, chosen)

    def slider(
        self,
        label: str,
        ends: tuple[float, float],
        value: float,
        chosen: Callable[[float], None],
        *,
        step: float = 1.0,
    ) -> GuiSliderHandle[float]:
        """`ends` are widened to hold the value."""
        low, high = min(ends[0], value), max(ends[1], value)
        handle = self._gui.add_slider(label, min=low, max=high, step=step, initial_value=value)
        self._controls.add_slider(handle, Judgement.SHOWS)
        return self._kept(handle, chosen)

    def line(self, label: str, chosen: Callable[[str], None], *, hint: str) -> GuiTextHandle:
        handle = self._gui.add_text(label, "", hint=hint)
        self._controls.add_text(handle)
        return self._kept(handle, chosen)

    def readout(self) -> GuiHtmlHandle:
        handle = self._gui.add_html("")
        self._texts.append(handle)
        return handle

    def retire(self) -> None:
        """The browser is gone."""
        for handle in self._handles:
            self._controls.retire(handle)

    def remove(self) -> None:
        self.retire()
        for handle in (*self._handles, *self._texts):
            handle.remove()
        self._handles.clear()
        self._texts.clear()

    def _kept(self, handle: Any, chosen: Callable[[Any], None]) -> Any:
        handle.on_update(by_a_person(chosen))
        self._handles.append(handle)
        return handle


def by_a_person(
    change: Callable[[Any], None],
) -> Callable[[GuiEvent[Any]], Coroutine[None, None, None]]:
    """A callback that hands the new value on. Async callbacks keep their order."""

    async def update(event: GuiEvent[Any]) -> None:
        if event.client is not None:
            change(event.target.value)

    return update
