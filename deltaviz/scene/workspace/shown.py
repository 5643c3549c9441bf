"""The workspace as one browser sees it: its folder in the panel, what it orders, what is drawn.

It looks at a robot and never speaks to the machine: nothing here can move anything.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from viser import ClientHandle, GuiCheckboxHandle, GuiDropdownHandle, GuiEvent, GuiSliderHandle

from deltaviz.mechanism import FiveBar, RotaryDelta
from deltaviz.robots import Robot
from deltaviz.robots.coordinates import is_planar
from deltaviz.scene.controls import Controls, Judgement
from deltaviz.scene.workspace import tasks
from deltaviz.scene.workspace.draw import Drawing
from deltaviz.scene.workspace.grips import Grips
from deltaviz.scene.workspace.inputs import Inputs
from deltaviz.scene.workspace.measures import NAMES, PLAIN
from deltaviz.scene.workspace.object_shown import Laying, ObjectShown
from deltaviz.scene.workspace.orders import Send, Topical
from deltaviz.scene.workspace.pictures import (
    Failed,
    Fitted,
    Picture,
    Section,
    Singularities,
    Skin,
)
from deltaviz.scene.workspace.probe_shown import ProbeShown, Probing
from deltaviz.scene.workspace.singular import Near
from deltaviz.scene.workspace.text import Told

AXES = "XYZ"
REST = 0.25  # s after the last change, when the boundary is refined

Handle = GuiCheckboxHandle | GuiSliderHandle[float] | GuiDropdownHandle[str]


@dataclass
class Choices:
    """What one session chose; kept while its browser reconnects."""

    boundary: bool = False
    fitted: bool = False
    singular: bool = False
    measure: str = PLAIN
    sections: set[int] = field(default_factory=set[int])
    levels: dict[int, float] = field(default_factory=dict[int, float])
    laying: Laying = field(default_factory=Laying)
    probing: Probing = field(default_factory=Probing)


class WorkspaceShown:
    """Runs in viser's event loop only. `quick` and `patient` order what takes milliseconds and
    what takes seconds."""

    def __init__(
        self,
        client: ClientHandle,
        controls: Controls,
        choices: Choices,
        robot: Robot,
        *,
        quick: Send,
        patient: Send,
    ) -> None:
        self._client = client
        self._controls = controls
        self._choices = choices
        self._quick, self._patient = quick, patient
        self._refining: asyncio.TimerHandle | None = None
        self._drawing = Drawing(client.scene)
        self._grips = Grips(client.scene, self._drag_section)
        self._spans: dict[int, tuple[float, float]] = {}
        self._awaited: set[int] = set()  # sections of which no picture has come since the order
        self._folder = client.gui.add_folder("Workspace", expand_by_default=False)
        self._handles: list[Handle] = []
        self._sliders: dict[int, GuiSliderHandle[float]] = {}
        self._parts: list[ObjectShown | ProbeShown] = []
        self._start(robot)

    def set_robot(self, robot: Robot) -> None:
        """Another robot: other sections; where they stood means nothing to it."""
        self._stop()
        self._choices.levels.clear()
        self._choices.laying.level = None
        self._start(robot)

    def leave(self) -> None:
        """The browser is gone, and with it what was drawn."""
        self._cancel_all()
        for part in self._parts:
            part.leave()
        for handle in self._handles:
            self._controls.retire(handle)

    def take(self, topic: str, picture: Picture) -> None:
        """A picture that was ordered has come."""
        for part in self._parts:
            if topic in part.topics:
                part.take(picture)
                return
        match picture:
            case Skin():
                if self._choices.boundary and not self._is_older(picture):
                    self._take_skin(picture)
            case Section():
                self._take_section(picture)
            case Fitted():
                if self._choices.fitted:
                    self._drawing.fitted(picture)
                    self._told.fitted = picture
            case Singularities():
                if self._choices.singular:
                    self._drawing.singular(picture)
                    self._told.singular = picture
            case Failed(text):
                self._told.problem = text
                self._awaited.clear()
        self._told.waiting.discard(topic)
        self._tell()

    def _take_skin(self, skin: Skin) -> None:
        if skin.measure != self._choices.measure:
            self._recolour(skin)
            return
        self._drawing.skin(skin)
        self._told.skin = skin
        self._told.scale = skin.scale or self._told.scale

    def _take_section(self, section: Section) -> None:
        axis = section.axis
        if axis not in self._choices.sections:
            return
        self._drawing.section(section)
        self._told.scale = section.scale or self._told.scale
        self._spans[axis] = section.span
        self._fit_slider(section)
        self._awaited.discard(axis)
        if axis in self._sliders:
            self._grips.show(section, level := self._choices.levels[axis])
            if section.level != level:
                self._order_section(axis, moving=True)

    def _is_older(self, skin: Skin) -> bool:
        """A coarse boundary that comes after a fine one."""
        fine = skin.deviation is not None or skin.reason is not None
        self._refined = self._refined or fine
        return self._refined and not fine

    def _start(self, robot: Robot) -> None:
        self._robot = robot
        self._told = Told(planar=is_planar(robot))
        with self._folder:
            self._parts = [self._added_probe()]  # at the top, to be seen while clicking
            self._add_inputs()
            self._readout = self._client.gui.add_html("")
            if not is_planar(robot):
                self._parts.append(self._added_object())
        self._tell()
        self._order_boundary()
        self._order_fitted()
        self._order_singular()
        self._order_sections()

    def _stop(self) -> None:
        self._cancel_all()
        for part in self._parts:
            part.remove()
        self._drawing.clear()
        for handle in self._handles:
            self._controls.retire(handle)
            handle.remove()
        self._readout.remove()
        self._handles.clear()
        self._sliders.clear()
        self._grips.drop(*range(3))
        self._spans.clear()
        self._awaited.clear()

    def _added_probe(self) -> ProbeShown:
        low, high = roughly(self._robot, 2)
        return ProbeShown(
            Inputs(self._client.gui, self._controls),
            self._client.scene,
            self._drawing.surfaces,
            self._choices.probing,
            self._robot,
            high - low,
            quick=self._by_topic(self._quick),
        )

    def _added_object(self) -> ObjectShown:
        return ObjectShown(
            Inputs(self._client.gui, self._controls),
            self._drawing,
            self._choices.laying,
            self._robot,
            roughly(self._robot, 2),
            quick=self._by_topic(self._quick),
            patient=self._by_topic(self._patient),
        )

    def _by_topic(self, send: Send) -> Topical:
        return lambda topic, task: send((self._client.client_id, topic), task)

    # The panel's inputs.

    def _add_inputs(self) -> None:
        planar = is_planar(self._robot)
        body = "Largest rectangle" if planar else "Largest cylinder"
        self._add_toggle("Reach", self._choices.boundary, self._set_boundary)
        self._add_toggle(body, self._choices.fitted, self._set_fitted)
        self._add_toggle("Singularities", self._choices.singular, self._set_singular)
        colour = self._client.gui.add_dropdown(
            "Colours", NAMES, initial_value=self._choices.measure
        )
        self._controls.add_choice(colour, Judgement.SHOWS)
        colour.on_update(self._told_of(self._set_measure))
        self._handles.append(colour)
        for axis in (1,) if planar else range(3):
            self._add_section(axis, planar=planar)

    def _add_section(self, axis: int, *, planar: bool) -> None:
        name = "Coloured plane" if planar else f"Section {AXES[axis]}"

        def choose(wanted: bool) -> None:
            (self._choices.sections.add if wanted else self._choices.sections.discard)(axis)
            self._order_section(axis)

        def move(level: float) -> None:
            self._move_section(axis, level)

        self._add_toggle(name, axis in self._choices.sections, choose)
        if planar:
            return
        low, high = roughly(self._robot, axis)
        level = self._choices.levels.setdefault(axis, round((low + high) / 2))
        slider = self._client.gui.add_slider(
            f"mm along {AXES[axis]}",
            min=min(low, level),
            max=max(high, level),
            step=1.0,
            initial_value=level,
        )
        self._controls.add_slider(slider, Judgement.SHOWS)
        slider.on_update(self._told_of(move))
        self._handles.append(slider)
        self._sliders[axis] = slider

    def _add_toggle(self, label: str, value: bool, chosen: Callable[[bool], None]) -> None:
        toggle = self._client.gui.add_checkbox(label, value)
        self._controls.add_toggle(toggle)
        toggle.on_update(self._told_of(chosen))
        self._handles.append(toggle)

    @staticmethod
    def _told_of(
        change: Callable[[Any], None],
    ) -> Callable[[GuiEvent[Any]], Coroutine[None, None, None]]:
        async def update(event: GuiEvent[Any]) -> None:
            if event.client is not None:
                change(event.target.value)

        return update

    def _fit_slider(self, section: Section) -> None:
        """To what the workspace turned out to span."""
        slider = self._sliders.get(section.axis)
        if slider is None:
            return
        low, high = (float(round(end)) for end in section.span)
        low, high = min(low, slider.value), max(high, slider.value)
        if (slider.min, slider.max) != (low, high):
            slider.min, slider.max = low, high

    # Where the sections are.

    def _drag_section(self, axis: int, level: float) -> None:
        """By its grip, within what the workspace spans; its slider goes along."""
        low, high = self._spans[axis]
        level = float(round(min(max(level, low), high)))
        if level != self._choices.levels[axis]:
            self._sliders[axis].value = level
            self._move_section(axis, level)

    def _move_section(self, axis: int, level: float) -> None:
        """One picture at a time: to order the next breaks off the one before, and a hand that
        moves on would see none. When it comes, the newest level is ordered."""
        self._choices.levels[axis] = level
        self._grips.place(axis, level)
        if axis not in self._awaited:
            self._order_section(axis, moving=True)

    # What is ordered.

    def _set_boundary(self, wanted: bool) -> None:
        self._choices.boundary = wanted
        self._order_boundary()

    def _set_fitted(self, wanted: bool) -> None:
        self._choices.fitted = wanted
        self._order_fitted()

    def _set_measure(self, name: str) -> None:
        self._choices.measure = name
        self._told.measure = name
        self._told.scale = None
        if self._told.skin is not None:
            self._recolour(self._told.skin)
        self._order_sections()

    def _order_boundary(self) -> None:
        self._cancel("boundary")
        self._refined = False
        if self._choices.boundary:
            self._order(self._quick, "boundary", tasks.Coarse(self._robot, self._choices.measure))
            loop = asyncio.get_running_loop()
            self._refining = loop.call_later(REST, self._refine)
        else:
            self._told.skin = None
            self._drawing.skin(None)
        self._tell()

    def _refine(self) -> None:
        self._order(self._patient, "boundary", tasks.Fine(self._robot, self._choices.measure))

    def _recolour(self, skin: Skin) -> None:
        coloured = tasks.Coloured(self._robot, skin, self._choices.measure)
        self._order(self._quick, "boundary", coloured)

    def _order_fitted(self) -> None:
        self._cancel("fitted")
        self._told.fitted = None
        self._drawing.fitted(None)
        if self._choices.fitted:
            self._order(self._patient, "fitted", tasks.Fit(self._robot))
        self._tell()

    def _set_singular(self, wanted: bool) -> None:
        self._choices.singular = wanted
        self._order_singular()

    def _order_singular(self) -> None:
        self._cancel("singular")
        self._told.singular = None
        self._drawing.singular(None)
        if self._choices.singular:
            self._order(self._patient, "singular", Near(self._robot))
        self._tell()

    def _order_sections(self) -> None:
        self._told.measure = self._choices.measure
        for axis in (1,) if is_planar(self._robot) else range(3):
            self._order_section(axis)

    def _order_section(self, axis: int, *, moving: bool = False) -> None:
        name = AXES[axis]
        if axis in self._choices.sections:
            level = 0.0 if is_planar(self._robot) else self._choices.levels[axis]
            pixels = (tasks.DRAFT, tasks.PIXELS) if moving else (tasks.PIXELS,)
            cut = tasks.Cut(self._robot, axis, level, self._choices.measure, pixels)
            self._order(self._quick, name, cut)
            self._awaited.add(axis)
        else:
            self._cancel(name)
            self._awaited.discard(axis)
            self._drawing.no_section(axis)
            self._grips.drop(axis)
        self._tell()

    def _order(self, send: Send, topic: str, task: tasks.Task) -> None:
        self._told.problem = None
        self._told.waiting.add(topic)
        send((self._client.client_id, topic), task)

    def _cancel_all(self) -> None:
        for topic in ("boundary", "fitted", "singular", *AXES):
            self._cancel(topic)

    def _cancel(self, topic: str) -> None:
        if topic == "boundary" and self._refining is not None:
            self._refining.cancel()
            self._refining = None
        self._told.waiting.discard(topic)
        for send in (self._quick, self._patient):
            send((self._client.client_id, topic), None)

    def _tell(self) -> None:
        if not (self._choices.sections or self._choices.boundary):
            self._told.scale = None
        content = self._told.html()
        if self._readout.content != content:
            self._readout.content = content


def roughly(robot: Robot, axis: int) -> tuple[float, float]:
    """What the workspace cannot exceed along an axis, in mm, from the arms' lengths alone."""
    zone, mechanism = robot.zone, robot.mechanism
    assert isinstance(mechanism, RotaryDelta | FiveBar)
    reach = float(np.max(np.add(mechanism.upper_arm, mechanism.forearm)))
    if axis == 2:
        return float(round(min(-reach, zone.z[0]))), float(round(max(0.0, zone.z[1])))
    return -float(round(reach)), float(round(reach))
