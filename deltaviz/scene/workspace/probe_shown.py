"""The point that a person probes in one browser: the click, the mark, what is told of it."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np
import viser
from viser import SceneClickEvent

from deltaviz.robots import Robot
from deltaviz.robots.coordinates import is_planar
from deltaviz.scene import colours
from deltaviz.scene.inputs import Inputs
from deltaviz.scene.units import metres, millimetres
from deltaviz.scene.workspace.hits import Surfaces
from deltaviz.scene.workspace.orders import Topical
from deltaviz.scene.workspace.pictures import Failed, Picture, Probed
from deltaviz.scene.workspace.probing import Point, Probe, told

TOPIC = "probe"
CROSS, LABEL = "/reach/probe/cross", "/reach/probe/label"
FARTHEST = 1e4  # mm
HINT = "Click what is drawn of the workspace, or type X Y Z in mm."
WRONG = f"Three numbers are needed, X Y Z in mm, none beyond {FARTHEST:.0f}."

Mark = tuple[viser.LineSegmentsHandle, viser.LabelHandle]


@dataclass
class Probing:
    """Whether one session probes."""

    on: bool = False


class ProbeShown:
    """Clicks are asked for only while it is on; a press that moves is none, it turns the camera or
    drags the robot. Runs in viser's event loop only."""

    topics = (TOPIC,)

    def __init__(
        self,
        inputs: Inputs,
        scene: viser.SceneApi,
        surfaces: Surfaces,
        choices: Probing,
        robot: Robot,
        size: float,
        *,
        quick: Topical,
    ) -> None:
        """`size` mm: the robot's, by which the mark is sized."""
        self._inputs = inputs
        self._scene = scene
        self._surfaces = surfaces
        self._choices = choices
        self._robot = robot
        self._arm = float(metres(size)) / 40
        self._quick = quick
        self._listening = False
        self._mark: Mark | None = None
        self._point: Point | None = None
        inputs.toggle("Probe", choices.on, self._set_on)
        self._place = inputs.line("Point", self._typed, hint=HINT)
        self._readout = inputs.readout("Probe told")
        self._follow()

    def take(self, picture: Picture) -> None:
        if not self._choices.on:
            return
        match picture:
            case Probed():
                self._readout.show(*told(picture))
            case Failed(text):
                self._readout.show(text)
            case _:
                return

    def consider(self, robot: Robot, *, moving: bool) -> None:
        """The same robot with other lengths."""
        self._robot = robot
        if self._point is not None:
            self._probe(self._point)

    def leave(self) -> None:
        """Nothing is wanted any more."""
        self._quick(TOPIC, None)
        self._inputs.retire()

    def remove(self) -> None:
        self.leave()
        self._listen(False)
        self._forget()
        self._inputs.remove()

    def _set_on(self, wanted: bool) -> None:
        self._choices.on = wanted
        self._follow()

    def _follow(self) -> None:
        on = self._choices.on
        self._place.visible = on
        self._listen(on)
        if not on:
            self._place.value = ""
        self._forget()
        self._readout.show(HINT if on else "")

    def _listen(self, wanted: bool) -> None:
        if wanted and not self._listening:
            self._scene.on_click()(self._clicked)  # type: ignore[arg-type]
        elif self._listening and not wanted:
            self._scene.remove_click_callback(self._clicked)
        self._listening = wanted

    async def _clicked(self, event: SceneClickEvent) -> None:
        hit = self._surfaces.hit(np.array(event.ray_origin), np.array(event.ray_direction))
        if hit is None:
            return
        x, y, z = millimetres(hit).tolist()
        point = (x, 0.0 if is_planar(self._robot) else y, z)
        self._place.value = " ".join(f"{value:z.1f}" for value in point)
        self._probe(point)

    def _typed(self, text: str) -> None:
        point = parsed(text)
        if point is None:
            self._forget()
            self._readout.show(WRONG if text.strip() else HINT)
        elif is_planar(self._robot) and point[1] != 0.0:
            self._forget()
            self._readout.show("Y must be 0, as this robot moves in a plane.")
        else:
            self._probe(point)

    def _probe(self, point: Point) -> None:
        if self._mark is None:
            self._readout.show("Computing …")
        self._point = point
        self._draw(point)
        self._quick(TOPIC, Probe(self._robot, point))

    def _draw(self, point: Point) -> None:
        at = metres(point)
        text = ", ".join(f"{value:.0f}" for value in point)
        if self._mark is None:
            self._mark = self._added_mark()
        cross, label = self._mark
        cross.position = at
        label.position = at + np.array((0.0, 0.0, 1.2 * self._arm))
        label.text = text

    def _added_mark(self) -> Mark:
        cross = self._scene.add_line_segments(
            CROSS,
            points=self._arm * np.stack((-np.eye(3), np.eye(3)), axis=1),
            colors=colours.PROBE,
            thickness=3.0,
            thickness_units="screen",
        )
        return cross, self._scene.add_label(LABEL, "", anchor="bottom-center")

    def _forget(self) -> None:
        self._quick(TOPIC, None)
        for node in self._mark or ():
            node.remove()
        self._mark = self._point = None


def parsed(text: str) -> Point | None:
    """Three finite numbers that spaces, commas or semicolons stand between; else None.

    Commas are decimal where something else stands between all three.
    """
    parts = re.split(r"\s*;\s*|,?\s+", text.strip())
    if len(parts) != 3:
        parts = re.split(r"[\s,;]+", text.strip())
    try:
        values = [float(part.replace("\u2212", "-").replace(",", ".")) for part in parts]
    except ValueError:
        return None
    if len(values) != 3 or not all(abs(value) <= FARTHEST for value in values):
        return None  # a NaN is no more than anything
    x, y, z = values
    return x, y, z
