"""The thing that lies in one browser's scene: its inputs, what it orders, what is told of it."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass

from deltaviz.robots import Robot
from deltaviz.scene.inputs import Inputs
from deltaviz.scene.workspace.draw import Drawing
from deltaviz.scene.workspace.laying import Lay, Serve
from deltaviz.scene.workspace.objects import Kind, Thing
from deltaviz.scene.workspace.orders import Topical
from deltaviz.scene.workspace.pictures import Failed, Laid, Picture, Section, Served

TOPIC, PROOF = "object", "belt"
REST = 0.25  # s after the last change, when it is proved how a belt is served
SIZES = (50.0, 1500.0)  # mm, of tables


@dataclass
class Laying:
    """What one session chose. `level` mm; None: where it fits best."""

    kind: Kind = Kind.NONE
    width: float = 300.0
    depth: float = 200.0
    level: float | None = None


class ObjectShown:
    """For robots that move in space. Runs in viser's event loop only."""

    topics = (TOPIC, PROOF)

    def __init__(
        self,
        inputs: Inputs,
        drawing: Drawing,
        choices: Laying,
        robot: Robot,
        heights: tuple[float, float],
        *,
        quick: Topical,
        patient: Topical,
    ) -> None:
        """`heights` mm: between which it may lie, until the workspace's own are known."""
        self._inputs = inputs
        self._drawing = drawing
        self._choices = choices
        self._robot = robot
        self._quick, self._patient = quick, patient
        self._proving: asyncio.TimerHandle | None = None
        inputs.choice("Object", [kind.value for kind in Kind], choices.kind.value, self._set_kind)
        middle = float(round(sum(heights) / 2))
        level = middle if choices.level is None else choices.level
        self._level = inputs.slider("mm at Z", heights, level, self._set_level)
        self._width = inputs.slider("mm wide", SIZES, choices.width, self._set_width, step=10.0)
        self._depth = inputs.slider("mm deep", SIZES, choices.depth, self._set_depth, step=10.0)
        self._readout = inputs.readout("Object told")
        self._order()

    def take(self, picture: Picture) -> None:
        if self._choices.kind is Kind.NONE:
            return
        match picture:
            case Laid(section, text):
                self._drawing.object(section)
                self._fit_slider(section)
                self._readout.show(text)
                self._prove_soon(section.level)
            case Served(text) | Failed(text):
                self._readout.show(text)
            case _:
                return

    def consider(self, robot: Robot, *, moving: bool) -> None:
        """The same robot with other lengths."""
        self._robot = robot
        self._order()

    def leave(self) -> None:
        """Nothing is wanted any more."""
        self._cancel_proof()
        self._quick(TOPIC, None)
        self._inputs.retire()

    def remove(self) -> None:
        self.leave()
        self._inputs.remove()
        self._drawing.object(None)

    def _set_kind(self, name: str) -> None:
        self._choices.kind = Kind(name)
        if self._choices.kind is Kind.NONE:
            self._choices.level = None
        self._order()

    def _set_level(self, level: float) -> None:
        self._choices.level = level
        self._order()

    def _set_width(self, width: float) -> None:
        self._choices.width = width
        self._order()

    def _set_depth(self, depth: float) -> None:
        self._choices.depth = depth
        self._order()

    @property
    def _thing(self) -> Thing:
        return Thing(self._choices.kind, self._choices.width, self._choices.depth)

    def _order(self) -> None:
        kind = self._choices.kind
        self._cancel_proof()
        self._level.visible = kind is not Kind.NONE
        self._width.visible = kind in (Kind.TABLE, Kind.ROUND_TABLE)
        self._depth.visible = kind is Kind.TABLE
        if kind is Kind.NONE:
            self._quick(TOPIC, None)
            self._drawing.object(None)
            self._readout.show()
        else:
            if not self._readout.rows:
                self._readout.show("Computing …")
            self._quick(TOPIC, Lay(self._robot, self._thing, self._choices.level))

    def _fit_slider(self, section: Section) -> None:
        """To where it lies and what the workspace turned out to span."""
        low, high = (float(round(end)) for end in section.span)
        low, high = min(low, section.level), max(high, section.level)
        if (self._level.min, self._level.max) != (low, high):
            self._level.min, self._level.max = low, high
        if self._choices.level is None and self._level.value != section.level:
            self._level.value = section.level

    def _prove_soon(self, level: float) -> None:
        self._cancel_proof()
        if self._choices.kind.belt_axis is not None:
            task = Serve(self._robot, self._thing, level)
            loop = asyncio.get_running_loop()
            self._proving = loop.call_later(REST, self._patient, PROOF, task)

    def _cancel_proof(self) -> None:
        if self._proving is not None:
            self._proving.cancel()
            self._proving = None
        self._patient(PROOF, None)
