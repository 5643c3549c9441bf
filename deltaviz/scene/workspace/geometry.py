"""The folder Geometry: a design on paper, of the robot with other lengths and joint limits.

Its inputs change a draft of this browser's and nothing else: no intent is ever posted here.
"""

from __future__ import annotations

import shlex
from collections.abc import Callable
from pathlib import Path

from viser import ClientHandle, GuiSliderHandle

from deltaviz.robots import Robot, RobotFileError
from deltaviz.robots.draft import Draft, Made, Parameter
from deltaviz.robots.errors import Faulty
from deltaviz.robots.load import Loaded, parse_robot
from deltaviz.scene.controls import Judgement
from deltaviz.scene.inputs import Inputs
from deltaviz.scene.workspace.saving import save_new

_NOTE = (
    "A design on paper, in mm: the robot stays as it is, and nothing here can move it. Arms that "
    "differ change alike. Violet: its arms where homing ends."
)
_LINES = 4  # of the box, always there, so that no slider jumps away from its hand


class Geometry:
    """Runs in viser's event loop only. `values` are those of the parameters that were changed, by
    their fields; they are kept by whoever owns them. `changed` is called when one has changed."""

    def __init__(
        self,
        client: ClientHandle,
        inputs: Inputs,
        loaded: Loaded,
        values: dict[str, float],
        *,
        changed: Callable[[], None],
        may_save: bool,
    ) -> None:
        self._inputs = inputs
        self._loaded, self._values = loaded, values
        self._changed = changed
        self._draft = Draft(loaded.text)
        self._made: Made | None = None  # the last that was possible
        self._problem: str | None = None
        self._sliders: dict[str, GuiSliderHandle[float]] = {}
        self._folder = client.gui.add_folder("Geometry", expand_by_default=False)
        with self._folder:
            self._readout = inputs.readout("Note", lines=_LINES)
            for parameter in self._draft.parameters:
                self._add_slider(parameter)
            inputs.button("Back to the robot's own", self._reset, Judgement.SHOWS, quiet=True)
            self._save = inputs.button(
                "Save as robot file", self._save_file, Judgement.STEERS, disabled=not may_save
            )
        self._make()

    @property
    def robot(self) -> Robot:
        """The design, the last that was possible; the robot itself while nothing is changed."""
        return self._loaded.robot if self._made is None else self._made.robot

    @property
    def own(self) -> Robot:
        return self._loaded.robot

    @property
    def is_changed(self) -> bool:
        return bool(self._values)

    @property
    def problem(self) -> str | None:
        """Why what the sliders say is no robot."""
        return self._problem

    def set_steering(self, may_steer: bool) -> None:
        """Who may steer may also save: it writes a file where the server is."""
        if self._save.disabled == may_steer:
            self._save.disabled = not may_steer

    def remove(self) -> None:
        self._inputs.remove()
        self._folder.remove()

    def retire(self) -> None:
        self._inputs.retire()

    def _add_slider(self, parameter: Parameter) -> None:
        field = parameter.field

        def move(value: float) -> None:
            if abs(value - parameter.shown) < parameter.step / 2:
                self._values.pop(field, None)
            else:
                self._values[field] = value
            self._change()

        self._sliders[field] = self._inputs.slider(
            parameter.name,
            (parameter.low, parameter.high),
            self._values.get(field, parameter.shown),
            move,
            step=parameter.step,
        )

    def _reset(self) -> None:
        self._values.clear()
        for parameter in self._draft.parameters:
            self._sliders[parameter.field].value = parameter.shown
        self._change()

    def _change(self) -> None:
        self._make()
        self._changed()

    def _make(self) -> None:
        self._problem = None
        try:
            self._made = self._draft.made(self._values) if self._values else None
        except Faulty as error:
            self._problem = str(error)
        self._readout.show(_NOTE if self._problem is None else f"No robot: {self._problem}.")

    def _save_file(self) -> None:
        self._readout.show(*self._write())

    def _write(self) -> tuple[str, ...]:
        """What became of it."""
        if self._problem is not None or self._made is None:
            return ("Not saved: move a slider to a robot that is possible first.",)
        made, folder = self._made, Path.cwd()
        try:
            path = save_new(folder, self._loaded.robot.name, lambda stem: self._text(made, stem))
        except OSError as error:
            return (f"Not saved: {error.filename or folder}: {error.strerror or error}.",)
        except RobotFileError as error:
            return (f"Not saved: {error}.",)
        told = f"Saved. Use it with: deltaviz --robot {shlex.quote(str(path))}"
        return (told, *_moved_zone(made))

    def _text(self, made: Made, stem: str) -> str:
        """Proved to be readable."""
        changes = ", ".join(f"{field} = {value:g}" for field, value in self._values.items())
        notes = (f"{self._loaded.robot.name} with {changes}.", *_moved_zone(made))
        text = made.text(name=stem, notes=notes)
        parse_robot(text, source=stem)
        return text


def _moved_zone(made: Made) -> tuple[str, ...]:
    if not made.zone_moved:
        return ()
    way = f"{abs(made.zone_moved):.1f} mm {'down' if made.zone_moved < 0 else 'up'}"
    return (
        f"The allowed zone moved {way}, with the pose where homing ends: see whether it suits.",
    )
