"""Inputs of one browser's panel that change a picture, and what is told beside them."""

from __future__ import annotations

from collections.abc import Callable, Coroutine, Sequence
from typing import Any

import viser
from viser import (
    GuiButtonHandle,
    GuiCheckboxHandle,
    GuiDropdownHandle,
    GuiEvent,
    GuiHtmlHandle,
    GuiSliderHandle,
    GuiTextHandle,
)

from deltaviz.scene import items
from deltaviz.scene.controls import LONGEST_TEXT, Controls, Judgement
from deltaviz.scene.equals import Equal, Equals
from deltaviz.scene.rows import Row, Rows, html_of


class Readout:
    """Rows in the panel, always with room for so many lines."""

    def __init__(self, handle: GuiHtmlHandle, lines: int) -> None:
        self.handle = handle
        self.rows: Rows = ()
        self._lines = lines

    def show(self, *rows: Row | str) -> None:
        self.show_all(tuple(Row(row) if isinstance(row, str) else row for row in rows if row))

    def show_all(self, rows: Rows) -> None:
        if rows != self.rows:
            self.rows = rows
            self.handle.content = html_of(rows, lines=self._lines)


class Inputs:
    """Of one group, in the folder that is open while they are made. Each calls back with what a
    person chose, in the panel or by its equal in the console, never with what we set."""

    def __init__(self, group: str, gui: viser.GuiApi, controls: Controls, equals: Equals) -> None:
        self._group = group
        self._gui = gui
        self._controls = controls
        self._all = equals
        self._equals: list[Equal] = []

    def toggle(self, label: str, value: bool, chosen: Callable[[bool], None]) -> GuiCheckboxHandle:
        handle = self._gui.add_checkbox(label, value)
        self._controls.add_toggle(handle)
        at = self._place(label)
        self._keep(handle, chosen, lambda: items.Toggle(*at, label, handle.value))
        return handle

    def choice(
        self, label: str, options: Sequence[str], value: str, chosen: Callable[[str], None]
    ) -> GuiDropdownHandle[str]:
        handle = self._gui.add_dropdown(label, options, initial_value=value)
        self._controls.add_choice(handle, Judgement.SHOWS)
        at, names = self._place(label), tuple(options)
        self._keep(handle, chosen, lambda: items.Choice(*at, label, handle.value, names))
        return handle

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
        at = self._place(label)

        def item() -> items.Slider:
            return items.Slider(*at, label, handle.value, handle.min, handle.max, step)

        self._keep(handle, chosen, item)
        return handle

    def line(self, label: str, chosen: Callable[[str], None], *, hint: str) -> GuiTextHandle:
        handle = self._gui.add_text(label, "", hint=hint)
        self._controls.add_text(handle)
        at = self._place(label)
        self._keep(handle, chosen, lambda: items.Line(*at, label, handle.value, hint, LONGEST_TEXT))
        return handle

    def button(
        self,
        label: str,
        pressed: Callable[[], None],
        judgement: Judgement,
        *,
        disabled: bool = False,
        quiet: bool = False,
    ) -> GuiButtonHandle:
        handle = self._gui.add_button(label, disabled=disabled, color="gray" if quiet else None)
        self._controls.add_button(handle, judgement)
        handle.on_click(by_a_person(lambda _: pressed()))
        at = self._place(label)
        self._add(
            Equal(
                item=lambda: items.Button(*at, label, handle.disabled),
                is_shown=lambda: handle.visible,
                handle=handle,
                choose=lambda _: pressed(),
            )
        )
        return handle

    def readout(self, name: str, *, lines: int = 0) -> Readout:
        """`name` is for the console; nobody reads it."""
        readout = Readout(self._gui.add_html(html_of((), lines=lines)), lines)
        at = self._place(name)
        self._add(
            Equal(
                item=lambda: items.Readout(*at, readout.rows),
                is_shown=lambda: bool(readout.rows),
                handle=readout.handle,
                choose=lambda _: None,
            )
        )
        return readout

    def retire(self) -> None:
        """The browser is gone."""
        for equal in self._equals:
            self._controls.retire(equal.handle)
        self._all.drop(self._equals)

    def remove(self) -> None:
        self.retire()
        for equal in self._equals:
            equal.handle.remove()
        self._equals.clear()

    def _place(self, name: str) -> tuple[str, str]:
        return f"{self._group}: {name}", self._group

    def _keep(self, handle: Any, chosen: Callable[[Any], None], item: Callable[[], Any]) -> None:
        handle.on_update(by_a_person(chosen))

        def choose(value: Any) -> None:
            handle.value = type(handle.value)(value)  # a whole number may come for a float
            chosen(handle.value)

        self._add(Equal(item, lambda: handle.visible, handle, choose))

    def _add(self, equal: Equal) -> None:
        self._all.add(equal)
        self._equals.append(equal)


def by_a_person(
    change: Callable[[Any], None],
) -> Callable[[GuiEvent[Any]], Coroutine[None, None, None]]:
    """A callback that hands the new value on. Async callbacks keep their order."""

    async def update(event: GuiEvent[Any]) -> None:
        if event.client is not None:
            change(event.target.value)

    return update
