"""The workspace as one browser sees it: its folder in the panel, what it orders, what is drawn.

It looks at a robot and never speaks to the machine: nothing here can move anything.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from viser import ClientHandle, GuiCheckboxHandle, GuiDropdownHandle, GuiSliderHandle

from deltaviz.mechanism import FiveBar, RotaryDelta
from deltaviz.robots.coordinates import is_planar
from deltaviz.robots.load import Loaded
from deltaviz.robots.robot import Robot
from deltaviz.scene.controls import Controls, Judgement
from deltaviz.scene.workspace import tasks
from deltaviz.scene.workspace.arms_outline import arms_outline
from deltaviz.scene.workspace.compared import OwnSize
from deltaviz.scene.workspace.draw import Drawing
from deltaviz.scene.workspace.geometry import Geometry
from deltaviz.scene.workspace.inputs import by_a_person
from deltaviz.scene.workspace.measures import NAMES, PLAIN
from deltaviz.scene.workspace.newest import Newest
from deltaviz.scene.workspace.orders import Key
from deltaviz.scene.workspace.pictures import Failed, Fitted, NoSection, Picture, Section, Skin
from deltaviz.scene.workspace.text import Told

AXES = "XYZ"
REST = 0.25  # s after the last change, when what takes longer is ordered

_OWN = ("own", "own_refined")  # the robot's own reach, to compare a design's with
_PATIENT = ("refined", "fitted", "own_refined")  # topics of what takes seconds

Send = Callable[[Key, tasks.Task | None], None]
Handle = GuiCheckboxHandle | GuiSliderHandle[float] | GuiDropdownHandle[str]


@dataclass
class Choices:
    """What one session chose; kept while its browser reconnects."""

    boundary: bool = False
    fitted: bool = False
    measure: str = PLAIN
    sections: set[int] = field(default_factory=set[int])
    levels: dict[int, float] = field(default_factory=dict[int, float])
    geometry: dict[str, float] = field(default_factory=dict[str, float])


class WorkspaceShown:
    """Runs in viser's event loop only. `quick` and `patient` order what takes milliseconds and
    what takes seconds."""

    def __init__(
        self,
        client: ClientHandle,
        controls: Controls,
        choices: Choices,
        loaded: Loaded,
        *,
        quick: Send,
        patient: Send,
    ) -> None:
        self._client = client
        self._controls = controls
        self._choices = choices
        self._quick = Newest(lambda topic, task: quick((client.client_id, topic), task))
        self._patient = patient
        self._resting: asyncio.TimerHandle | None = None
        self._may_steer = False
        self._drawing = Drawing(client.scene)
        self._folder = client.gui.add_folder("Workspace", expand_by_default=False)
        self._handles: list[Handle] = []
        self._sliders: dict[int, GuiSliderHandle[float]] = {}
        self._start(loaded)

    def set_robot(self, loaded: Loaded) -> None:
        """Another robot: other sections and lengths; where they stood means nothing to it."""
        self._stop()
        self._choices.levels.clear()
        self._choices.geometry.clear()
        self._start(loaded)

    def set_steering(self, may_steer: bool) -> None:
        """Whether this browser's session may move the robot; it may then write files, too."""
        self._may_steer = may_steer
        self._geometry.set_steering(may_steer)

    def leave(self) -> None:
        """The browser is gone, and with it what was drawn."""
        self._cancel_all()
        for handle in self._handles:
            self._controls.retire(handle)
        self._geometry.retire()

    def take(self, topic: str, picture: Picture) -> None:
        """A picture that was ordered has come."""
        if topic not in _PATIENT:
            self._quick.came(topic)
        match picture:
            case Skin():
                self._take_skin(topic, picture)
            case Section():
                if picture.axis in self._choices.sections:
                    self._drawing.section(picture)
                    self._told.scale = picture.scale
                    self._fit_slider(picture)
            case NoSection(axis):
                self._drawing.no_section(axis)
            case Fitted():
                if self._choices.fitted:
                    self._drawing.fitted(picture)
                    self._told.fitted = picture
            case Failed(text):
                self._told.problem = text
        self._told.waiting.discard(topic)
        self._tell()

    def _take_skin(self, topic: str, skin: Skin) -> None:
        if topic in _OWN:
            self._own.take(skin)
            return
        self._refined = self._refined or topic == "refined"
        if not self._choices.boundary or (self._refined and topic == "boundary"):
            return  # a coarse boundary that comes after a fine one
        if topic == "refined" and not self._geometry.is_changed:
            self._own.take(skin)
        self._drawing.skin(skin)
        self._drawing.fade(self._geometry.problem is not None)
        self._told.skin = skin

    def _start(self, loaded: Loaded) -> None:
        self._robot = robot = loaded.robot
        self._told = Told(planar=is_planar(robot))
        self._own = OwnSize(robot.name, self._told.planar)
        with self._folder:
            self._add_inputs()
            self._readout = self._client.gui.add_html("")
            self._geometry = Geometry(
                self._client,
                self._controls,
                loaded,
                self._choices.geometry,
                changed=self._design,
                may_save=self._may_steer,
            )
        self._show_design()
        self._order_boundary()
        self._order_fitted()
        self._order_sections()

    def _stop(self) -> None:
        self._cancel_all()
        self._drawing.clear()
        for handle in self._handles:
            self._controls.retire(handle)
            handle.remove()
        self._readout.remove()
        self._geometry.remove()
        self._handles.clear()
        self._sliders.clear()

    # The panel's inputs.

    def _add_inputs(self) -> None:
        planar = is_planar(self._robot)
        body = "Largest rectangle" if planar else "Largest cylinder"
        self._reach = self._add_toggle("Reach", self._choices.boundary, self._set_boundary)
        self._add_toggle(body, self._choices.fitted, self._set_fitted)
        colour = self._client.gui.add_dropdown(
            "Colours", NAMES, initial_value=self._choices.measure
        )
        self._controls.add_choice(colour, Judgement.SHOWS)
        colour.on_update(by_a_person(self._set_measure))
        self._handles.append(colour)
        for axis in (1,) if planar else range(3):
            self._add_section(axis, planar=planar)

    def _add_section(self, axis: int, *, planar: bool) -> None:
        name = "Coloured plane" if planar else f"Section {AXES[axis]}"

        def choose(wanted: bool) -> None:
            (self._choices.sections.add if wanted else self._choices.sections.discard)(axis)
            self._order_section(axis)

        def move(level: float) -> None:
            self._choices.levels[axis] = level
            self._order_section(axis)

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
        slider.on_update(by_a_person(move))
        self._handles.append(slider)
        self._sliders[axis] = slider

    def _add_toggle(
        self, label: str, value: bool, chosen: Callable[[bool], None]
    ) -> GuiCheckboxHandle:
        toggle = self._client.gui.add_checkbox(label, value)
        self._controls.add_toggle(toggle)
        toggle.on_update(by_a_person(chosen))
        self._handles.append(toggle)
        return toggle

    def _fit_slider(self, section: Section) -> None:
        """To what the workspace turned out to span."""
        slider = self._sliders.get(section.axis)
        if slider is None:
            return
        low, high = (float(round(end)) for end in section.span)
        low, high = min(low, slider.value), max(high, slider.value)
        if (slider.min, slider.max) != (low, high):
            slider.min, slider.max = low, high

    # The design: other lengths than the robot's.

    def _design(self) -> None:
        """A length was changed. While it makes no robot, the last that was possible stays."""
        before = self._robot
        self._show_design()
        if self._robot != before:
            self._follow()

    def _show_design(self) -> None:
        changed = self._geometry.is_changed
        self._robot = self._geometry.robot
        self._told.own = self._own if changed else None
        self._drawing.design(arms_outline(self._robot) if changed else None)
        self._drawing.fade(self._geometry.problem is not None)
        self._tell()

    def _follow(self) -> None:
        """At the hand's pace: what is quick at once, the rest when the hand rests."""
        if not self._choices.boundary:
            self._choices.boundary = self._reach.value = True
        self._cancel("fitted")
        self._told.fitted = None
        self._drawing.fitted(None)
        self._order_boundary()
        self._order_sections()

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
        self._order_sections()

    def _order_boundary(self) -> None:
        self._cancel("refined")
        self._refined = False
        if self._choices.boundary:
            changed = self._geometry.is_changed
            coarse = tasks.Rough if changed else tasks.Coarse
            self._order_quick("boundary", coarse(self._robot))
            if changed and self._own.coarse is None:
                self._order_quick("own", tasks.Rough(self._geometry.own))
        else:
            self._cancel("boundary")
            self._told.skin = None
            self._drawing.skin(None)
        self._rest_anew()
        self._tell()

    def _rest_anew(self) -> None:
        if self._resting is not None:
            self._resting.cancel()
        self._resting = asyncio.get_running_loop().call_later(REST, self._rest)

    def _rest(self) -> None:
        """The hand rests."""
        if self._choices.boundary and not self._refined:
            self._order_patient("refined", tasks.Fine(self._robot))
        if self._choices.fitted and self._told.fitted is None:
            self._order_fitted()
        if self._geometry.is_changed and self._own.fine is None:
            self._order_patient("own_refined", tasks.Fine(self._geometry.own))
        self._tell()

    def _order_fitted(self) -> None:
        self._cancel("fitted")
        self._told.fitted = None
        self._drawing.fitted(None)
        if self._choices.fitted:
            self._order_patient("fitted", tasks.Fit(self._robot))
        self._tell()

    def _order_sections(self) -> None:
        self._told.measure = self._choices.measure
        for axis in (1,) if is_planar(self._robot) else range(3):
            self._order_section(axis)

    def _order_section(self, axis: int) -> None:
        name = AXES[axis]
        if axis in self._choices.sections:
            level = 0.0 if is_planar(self._robot) else self._choices.levels[axis]
            cut = tasks.Cut(self._robot, axis, level, self._choices.measure)
            self._order_quick(name, cut)
        else:
            self._cancel(name)
            self._drawing.no_section(axis)
            if not self._choices.sections:
                self._told.scale = None
        self._tell()

    def _order_quick(self, topic: str, task: tasks.Task) -> None:
        self._expect(topic)
        self._quick.order(topic, task)

    def _order_patient(self, topic: str, task: tasks.Task) -> None:
        self._expect(topic)
        self._patient((self._client.client_id, topic), task)

    def _expect(self, topic: str) -> None:
        self._told.problem = None
        self._told.waiting.add(topic)

    def _cancel_all(self) -> None:
        if self._resting is not None:
            self._resting.cancel()
        for topic in (*_PATIENT, "boundary", "own", *AXES):
            self._cancel(topic)

    def _cancel(self, topic: str) -> None:
        self._told.waiting.discard(topic)
        if topic in _PATIENT:
            self._patient((self._client.client_id, topic), None)
        else:
            self._quick.cancel(topic)

    def _tell(self) -> None:
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
