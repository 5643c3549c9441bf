"""The sections in one browser: their inputs and grips, what is ordered, where they stand."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import viser
from viser import GuiSliderHandle

from deltaviz.robots import Robot
from deltaviz.robots.coordinates import is_planar
from deltaviz.scene.inputs import Inputs
from deltaviz.scene.workspace import tasks
from deltaviz.scene.workspace.draw import Drawing
from deltaviz.scene.workspace.grips import Grips
from deltaviz.scene.workspace.orders import Topical
from deltaviz.scene.workspace.outer import roughly
from deltaviz.scene.workspace.pictures import NoSection, Section

AXES = "XYZ"
_OWN_PLANE = 1  # the axis that a planar robot's plane lies across


@dataclass
class Cutting:
    """Which sections one session chose, by their axes, and where they stand (mm)."""

    axes: set[int] = field(default_factory=set[int])
    levels: dict[int, float] = field(default_factory=dict[int, float])


class SectionsShown:
    """Of a robot in a plane there is one, in that plane. Runs in viser's event loop only."""

    topics = tuple(AXES)

    def __init__(
        self,
        inputs: Inputs,
        scene: viser.SceneApi,
        drawing: Drawing,
        choices: Cutting,
        robot: Robot,
        measure: str,
        *,
        quick: Topical,
    ) -> None:
        """`measure`: the name of what they are coloured by."""
        self.scale: tuple[float, float] | None = None  # the ends of the colours, once known
        self._inputs = inputs
        self._drawing = drawing
        self._choices = choices
        self._robot = robot
        self._measure = measure
        self._quick = quick
        self._grips = Grips(scene, self._drag)
        self._spans: dict[int, tuple[float, float]] = {}
        self._sliders: dict[int, GuiSliderHandle[float]] = {}
        self._axes = (_OWN_PLANE,) if is_planar(robot) else (0, 1, 2)
        for axis in self._axes:
            self._add(axis)
        self._order_all()

    @property
    def any(self) -> bool:
        return bool(self._choices.axes)

    def colour(self, measure: str) -> None:
        self._measure = measure
        self.scale = None
        self._order_all()

    def consider(self, robot: Robot, *, moving: bool) -> None:
        """The same robot with other lengths: the colours' scale is held while a hand is moving,
        as it takes longer to find than a picture."""
        self._robot = robot
        for axis in self._axes:
            self._order(axis, moving=moving, scale=self.scale if moving else None)

    def take(self, picture: Section | NoSection) -> None:
        axis = picture.axis
        if axis not in self._choices.axes:
            return
        if isinstance(picture, NoSection):
            self._drawing.no_section(axis)
            self._grips.drop(axis)
            return
        self._drawing.section(picture)
        self.scale = picture.scale or self.scale
        self._spans[axis] = picture.span
        if axis in self._sliders:
            self._fit_slider(picture)
            self._grips.show(picture, self._choices.levels[axis])

    def leave(self) -> None:
        """Nothing is wanted any more."""
        for topic in self.topics:
            self._quick(topic, None)
        self._inputs.retire()

    def remove(self) -> None:
        self.leave()
        self._inputs.remove()
        self._grips.drop(*self._axes)

    def _add(self, axis: int) -> None:
        def choose(wanted: bool) -> None:
            (self._choices.axes.add if wanted else self._choices.axes.discard)(axis)
            self._order(axis)

        if is_planar(self._robot):
            self._inputs.toggle("Coloured plane", axis in self._choices.axes, choose)
            return
        self._inputs.toggle(f"Section {AXES[axis]}", axis in self._choices.axes, choose)
        ends = roughly(self._robot, axis)
        level = self._choices.levels.setdefault(axis, round(sum(ends) / 2))
        move: Callable[[float], None] = lambda level: self._move(axis, level)  # noqa: E731
        self._sliders[axis] = self._inputs.slider(f"mm along {AXES[axis]}", ends, level, move)

    def _fit_slider(self, section: Section) -> None:
        """To what the workspace turned out to span."""
        slider = self._sliders[section.axis]
        low, high = (float(round(end)) for end in section.span)
        low, high = min(low, slider.value), max(high, slider.value)
        if (slider.min, slider.max) != (low, high):
            slider.min, slider.max = low, high

    def _drag(self, axis: int, level: float) -> None:
        """By its grip, within what the workspace spans; its slider goes along."""
        low, high = self._spans[axis]
        level = float(round(min(max(level, low), high)))
        if level != self._choices.levels[axis]:
            self._sliders[axis].value = level
            self._move(axis, level)

    def _move(self, axis: int, level: float) -> None:
        self._choices.levels[axis] = level
        self._grips.place(axis, level)
        self._order(axis, moving=True, scale=self.scale)

    def _order_all(self) -> None:
        for axis in self._axes:
            self._order(axis)

    def _order(
        self, axis: int, *, moving: bool = False, scale: tuple[float, float] | None = None
    ) -> None:
        topic = AXES[axis]
        if axis in self._choices.axes:
            level = self._choices.levels[axis] if axis in self._sliders else 0.0
            pixels = (tasks.DRAFT, tasks.PIXELS) if moving else (tasks.PIXELS,)
            cut = tasks.Cut(self._robot, axis, level, self._measure, pixels, scale)
            self._quick(topic, cut)
        else:
            self._quick(topic, None)
            self._drawing.no_section(axis)
            self._grips.drop(axis)
