"""The workspace as one browser sees it: its folder in the panel, what it orders, what is drawn.

It looks at a robot and never speaks to the machine: nothing here can move anything.
"""

from __future__ import annotations

import asyncio
from dataclasses import dataclass, field

from viser import ClientHandle

from deltaviz.robots.coordinates import is_planar
from deltaviz.robots.load import Loaded
from deltaviz.scene.controls import Controls
from deltaviz.scene.equals import Equals
from deltaviz.scene.inputs import Inputs
from deltaviz.scene.workspace import tasks
from deltaviz.scene.workspace.arms_outline import arms_outline
from deltaviz.scene.workspace.compared import OwnSize
from deltaviz.scene.workspace.draw import Drawing
from deltaviz.scene.workspace.geometry import Geometry
from deltaviz.scene.workspace.measures import NAMES, PLAIN
from deltaviz.scene.workspace.newest import Newest
from deltaviz.scene.workspace.object_shown import Laying, ObjectShown
from deltaviz.scene.workspace.orders import Send
from deltaviz.scene.workspace.outer import roughly
from deltaviz.scene.workspace.pictures import (
    Failed,
    Fitted,
    NoSection,
    Picture,
    Section,
    Singularities,
    Skin,
)
from deltaviz.scene.workspace.probe_shown import ProbeShown, Probing
from deltaviz.scene.workspace.sections_shown import Cutting, SectionsShown
from deltaviz.scene.workspace.singular import Near
from deltaviz.scene.workspace.text import LINES, Told

REST = 0.25  # s after the last change, when what takes longer is ordered

_QUICK = ("boundary", "own")  # topics; "own": the robot's, to compare a design's with
_PATIENT = ("refined", "fitted", "singular", "own_refined")


@dataclass
class Choices:
    """What one session chose; kept while its browser reconnects."""

    boundary: bool = False
    fitted: bool = False
    singular: bool = False
    measure: str = PLAIN
    cutting: Cutting = field(default_factory=Cutting)
    laying: Laying = field(default_factory=Laying)
    probing: Probing = field(default_factory=Probing)
    geometry: dict[str, float] = field(default_factory=dict[str, float])


class WorkspaceShown:
    """Runs in viser's event loop only. `quick` and `patient` order what takes milliseconds and
    what takes seconds."""

    def __init__(
        self,
        client: ClientHandle,
        controls: Controls,
        equals: Equals,
        choices: Choices,
        loaded: Loaded,
        *,
        quick: Send,
        patient: Send,
    ) -> None:
        self._client = client
        self._controls = controls
        self._equals = equals
        self._choices = choices
        self._quick = Newest(lambda topic, task: quick((client.client_id, topic), task))
        self._patient = lambda topic, task: patient((client.client_id, topic), task)
        self._resting: asyncio.TimerHandle | None = None
        self._may_steer = False
        self._drawing = Drawing(client.scene)
        self._folder = client.gui.add_folder("Workspace", expand_by_default=False)
        self._start(loaded)

    def set_robot(self, loaded: Loaded) -> None:
        """Another robot: other sections and lengths; where they stood means nothing to it."""
        self._stop()
        self._choices.cutting.levels.clear()
        self._choices.laying.level = None
        self._choices.geometry.clear()
        self._start(loaded)

    def set_steering(self, may_steer: bool) -> None:
        """Whether this browser's session may move the robot; it may then write files, too."""
        self._may_steer = may_steer
        self._geometry.set_steering(may_steer)

    def leave(self) -> None:
        """The browser is gone, and with it what was drawn."""
        self._cancel_all()
        for part in self._parts:
            part.leave()
        self._inputs.retire()
        self._geometry.retire()

    def take(self, topic: str, picture: Picture) -> None:
        """A picture that was ordered has come."""
        self._quick.came(topic)
        for part in (self._probe, self._object):
            if part is not None and topic in part.topics:
                part.take(picture)
                return
        match picture:
            case Skin():
                self._take_skin(topic, picture)
            case Section() | NoSection():
                self._sections.take(picture)
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
            case _:
                pass
        self._told.waiting.discard(topic)
        self._tell()

    def _take_skin(self, topic: str, skin: Skin) -> None:
        if topic in ("own", "own_refined"):
            self._own.take(skin)
            return
        refined = skin.deviation is not None or skin.reason is not None
        if not self._choices.boundary or (self._refined and not refined):
            return  # a coarse boundary that comes after a fine one
        if refined and not self._geometry.is_changed:
            self._own.take(skin)
        self._refined = self._refined or refined
        if skin.measure != self._choices.measure and refined:
            self._recolour(skin)
            return
        self._drawing.skin(skin)
        self._drawing.fade(self._geometry.problem is not None)
        self._told.skin = skin

    def _start(self, loaded: Loaded) -> None:
        self._robot = robot = loaded.robot
        self._told = Told(planar=is_planar(robot), measure=self._choices.measure)
        self._own = OwnSize(robot.name, self._told.planar)
        self._refined = False
        with self._folder:
            self._probe = self._added_probe()  # at the top, to be seen while clicking
            self._inputs = self._added_inputs()
            self._sections = self._added_sections()
            self._readout = self._inputs.readout("Reach told", lines=LINES)
            self._object = None if is_planar(robot) else self._added_object()
            self._geometry = Geometry(
                self._client,
                self._own_inputs("Geometry"),
                loaded,
                self._choices.geometry,
                changed=self._design,
                may_save=self._may_steer,
            )
        self._show_design()
        self._order_boundary()
        self._order_fitted()
        self._order_singular()
        if self._robot != robot:
            self._consider(moving=False)

    def _stop(self) -> None:
        self._cancel_all()
        for part in self._parts:
            part.remove()
        self._drawing.clear()
        self._inputs.remove()
        self._geometry.remove()

    # The panel's inputs.

    @property
    def _parts(self) -> list[ProbeShown | SectionsShown | ObjectShown]:
        return [p for p in (self._probe, self._sections, self._object) if p is not None]

    def _own_inputs(self, group: str = "Workspace") -> Inputs:
        return Inputs(group, self._client.gui, self._controls, self._equals)

    def _added_inputs(self) -> Inputs:
        inputs, choices = self._own_inputs(), self._choices
        body = "Largest rectangle" if is_planar(self._robot) else "Largest cylinder"
        self._reach = inputs.toggle("Reach", choices.boundary, self._set_boundary)
        inputs.toggle(body, choices.fitted, self._set_fitted)
        inputs.toggle("Singularities", choices.singular, self._set_singular)
        inputs.choice("Colours", NAMES, choices.measure, self._set_measure)
        return inputs

    def _added_probe(self) -> ProbeShown:
        low, high = roughly(self._robot, 2)
        return ProbeShown(
            self._own_inputs(),
            self._client.scene,
            self._drawing.surfaces,
            self._choices.probing,
            self._robot,
            high - low,
            quick=self._quick.tell,
        )

    def _added_sections(self) -> SectionsShown:
        return SectionsShown(
            self._own_inputs(),
            self._client.scene,
            self._drawing,
            self._choices.cutting,
            self._robot,
            self._choices.measure,
            quick=self._quick.tell,
        )

    def _added_object(self) -> ObjectShown:
        return ObjectShown(
            self._own_inputs(),
            self._drawing,
            self._choices.laying,
            self._robot,
            roughly(self._robot, 2),
            quick=self._quick.tell,
            patient=self._patient,
        )

    def _set_boundary(self, wanted: bool) -> None:
        self._choices.boundary = wanted
        self._order_boundary()

    def _set_fitted(self, wanted: bool) -> None:
        self._choices.fitted = wanted
        self._order_fitted()

    def _set_singular(self, wanted: bool) -> None:
        self._choices.singular = wanted
        self._order_singular()

    def _set_measure(self, name: str) -> None:
        self._choices.measure = name
        self._told.measure = name
        if self._told.skin is not None:
            self._recolour(self._told.skin)
        self._sections.colour(name)
        self._tell()

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
        for topic in ("fitted", "singular"):
            self._cancel(topic)
        self._told.fitted = self._told.singular = None
        self._drawing.fitted(None)
        self._drawing.singular(None)
        self._order_boundary()
        self._consider(moving=True)

    def _consider(self, *, moving: bool) -> None:
        for part in self._parts:
            part.consider(self._robot, moving=moving)

    # What is ordered.

    def _order_boundary(self) -> None:
        self._cancel("refined")
        self._refined = False
        if self._choices.boundary:
            self._order_coarse()
        else:
            self._cancel("boundary")
            self._told.skin = None
            self._drawing.skin(None)
        self._rest_anew()
        self._tell()

    def _order_coarse(self) -> None:
        if not self._geometry.is_changed:
            self._order_quick("boundary", tasks.Coarse(self._robot, self._choices.measure))
            return
        self._order_quick("boundary", tasks.Rough(self._robot))
        if self._own.coarse is None:
            self._order_quick("own", tasks.Rough(self._geometry.own))

    def _rest_anew(self) -> None:
        if self._resting is not None:
            self._resting.cancel()
        self._resting = asyncio.get_running_loop().call_later(REST, self._rest)

    def _rest(self) -> None:
        """The hand rests."""
        if self._choices.boundary and not self._refined:
            self._order_patient("refined", tasks.Fine(self._robot, self._choices.measure))
        if self._choices.fitted and self._told.fitted is None:
            self._order_fitted()
        if self._choices.singular and self._told.singular is None:
            self._order_singular()
        if self._geometry.is_changed:
            self._consider(moving=False)
            if self._own.fine is None:
                self._order_patient("own_refined", tasks.Fine(self._geometry.own))
        self._tell()

    def _recolour(self, skin: Skin) -> None:
        measure = self._choices.measure
        self._order_quick("boundary", tasks.Coloured(self._robot, skin, measure))

    def _order_fitted(self) -> None:
        self._cancel("fitted")
        self._told.fitted = None
        self._drawing.fitted(None)
        if self._choices.fitted:
            self._order_patient("fitted", tasks.Fit(self._robot))
        self._tell()

    def _order_singular(self) -> None:
        self._cancel("singular")
        self._told.singular = None
        self._drawing.singular(None)
        if self._choices.singular:
            self._order_patient("singular", Near(self._robot))
        self._tell()

    def _order_quick(self, topic: str, task: tasks.Task) -> None:
        self._expect(topic)
        self._quick.tell(topic, task)

    def _order_patient(self, topic: str, task: tasks.Task) -> None:
        self._expect(topic)
        self._patient(topic, task)

    def _expect(self, topic: str) -> None:
        self._told.problem = None
        self._told.waiting.add(topic)

    def _cancel_all(self) -> None:
        if self._resting is not None:
            self._resting.cancel()
        for topic in (*_QUICK, *_PATIENT):
            self._cancel(topic)

    def _cancel(self, topic: str) -> None:
        self._told.waiting.discard(topic)
        (self._patient if topic in _PATIENT else self._quick.tell)(topic, None)

    def _tell(self) -> None:
        of_skin = self._told.skin.scale if self._told.skin is not None else None
        self._told.scale = of_skin or (self._sections.scale if self._sections.any else None)
        self._readout.show_all(self._told.rows())
