"""A group of sliders that together state one target."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import viser
from viser import GuiEvent, GuiSliderHandle

from deltaviz.scene.controls import Controls
from deltaviz.scene.listener import SESSION

STEP = 0.1  # degrees or mm
HELD = 0.5  # s after the last event during which a slider belongs to whoever moves it


@dataclass(frozen=True)
class Scale:
    """One slider: its label and its range."""

    label: str
    low: float
    high: float


class Wish:
    """What a person asked for: the values shown, with what they changed a moment ago. Pure."""

    def __init__(self, values: Sequence[float]) -> None:
        self._shown = tuple(values)
        self._asked = self._shown
        self._asked_at = float("-inf")
        self._touched = [float("-inf")] * len(self._shown)

    def change(self, index: int, value: float, now: float) -> tuple[float, ...]:
        """A person moved one slider: the target that this asks for."""
        # Two sliders moved at once: the first one's answer is not shown yet.
        base = self._asked if now - self._asked_at < HELD else self._shown
        self._asked = (*base[:index], value, *base[index + 1 :])
        self._asked_at = self._touched[index] = now
        return self._asked

    def show(self, values: Sequence[float]) -> None:
        """The controller's values."""
        self._shown = tuple(values)

    def free(self, index: int, now: float) -> bool:
        """Nobody is moving this slider."""
        return now - self._touched[index] >= HELD


class Sliders:
    """Sliders in a folder. They show the target and are never the source of it."""

    def __init__(
        self,
        gui: viser.GuiApi,
        folder: viser.GuiFolderHandle,
        controls: Controls,
        scales: Sequence[Scale],
        on_wish: Callable[[str, tuple[float, ...]], None],
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        """`on_wish(session, values)` is told what a person asks for."""
        self._controls = controls
        self._on_wish = on_wish
        self._clock = clock
        with folder:
            self.handles = [self._add(gui, i, scale) for i, scale in enumerate(scales)]
        self._wish = Wish([handle.value for handle in self.handles])

    @property
    def labels(self) -> list[str]:
        return [handle.label for handle in self.handles]

    def __len__(self) -> int:
        return len(self.handles)

    def show(self, values: Sequence[float]) -> None:
        """Move the sliders that nobody holds."""
        self._wish.show(values)
        now = self._clock()
        for i, (handle, value) in enumerate(zip(self.handles, values, strict=True)):
            place = min(max(round(value / STEP) * STEP, handle.min), handle.max)
            if abs(place - handle.value) > STEP / 2 and self._wish.free(i, now):
                handle.value = round(place, 6)

    def set_ranges(self, scales: Sequence[Scale]) -> None:
        for handle, scale in zip(self.handles, scales, strict=True):
            handle.min, handle.max = scale.low, scale.high

    def remove(self) -> None:
        for handle in self.handles:
            self._controls.retire(handle)
            handle.remove()

    def _add(self, gui: viser.GuiApi, index: int, scale: Scale) -> GuiSliderHandle[float]:
        handle = gui.add_slider(
            scale.label,
            min=scale.low,
            max=scale.high,
            step=STEP,
            initial_value=min(max(0.0, scale.low), scale.high),
        )
        self._controls.add_slider(handle)

        @handle.on_update
        async def _(event: GuiEvent[GuiSliderHandle[float]]) -> None:
            session = SESSION.get()
            if event.client is not None and session is not None:
                wish = self._wish.change(index, event.target.value, self._clock())
                self._on_wish(session, wish)

        return handle
