"""The folder Geometry: a design on paper, of the robot with other lengths and joint limits.

Its inputs change a draft of this browser's and nothing else: no intent is ever posted here.
"""

from __future__ import annotations

import html
import shlex
from collections.abc import Callable
from pathlib import Path

from viser import ClientHandle, GuiButtonHandle, GuiSliderHandle

from deltaviz.robots import Robot, RobotFileError
from deltaviz.robots.draft import Draft, Made, Parameter
from deltaviz.robots.errors import Faulty
from deltaviz.robots.load import Loaded, parse_robot
from deltaviz.scene.controls import Controls, Judgement
from deltaviz.scene.workspace.inputs import by_a_person
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
        controls: Controls,
        loaded: Loaded,
        values: dict[str, float],
        *,
        changed: Callable[[], None],
        may_save: bool,
    ) -> None:
        self._controls = controls
        self._loaded, self._values = loaded, values
        self._changed = changed
        self._draft = Draft(loaded.text)
        self._made: Made | None = None  # the last that was possible
        self._problem: str | None = None
        self._sliders: dict[str, GuiSliderHandle[float]] = {}
        gui = client.gui
        self._folder = gui.add_folder("Geometry", expand_by_default=False)
        with self._folder:
            self._box = gui.add_html("")
            for parameter in self._draft.parameters:
                self._add_slider(client, parameter)
            back = gui.add_button("Back to the robot's own", color="gray")
            self._save = gui.add_button("Save as robot file", disabled=not may_save)
        self._buttons = (back, self._save)
        self._add_button(back, self._reset, Judgement.SHOWS)
        self._add_button(self._save, self._save_file, Judgement.STEERS)
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
        self.retire()
        self._folder.remove()

    def retire(self) -> None:
        for handle in (*self._sliders.values(), *self._buttons):
            self._controls.retire(handle)

    def _add_slider(self, client: ClientHandle, parameter: Parameter) -> None:
        field = parameter.field
        slider = client.gui.add_slider(
            parameter.name,
            min=parameter.low,
            max=parameter.high,
            step=parameter.step,
            initial_value=self._values.get(field, parameter.shown),
        )
        self._controls.add_slider(slider, Judgement.SHOWS)

        def move(value: float) -> None:
            if abs(value - parameter.shown) < parameter.step / 2:
                self._values.pop(field, None)
            else:
                self._values[field] = value
            self._change()

        slider.on_update(by_a_person(move))
        self._sliders[field] = slider

    def _add_button(
        self, button: GuiButtonHandle, press: Callable[[], None], judgement: Judgement
    ) -> None:
        self._controls.add_button(button, judgement)
        button.on_click(by_a_person(lambda _: press()))

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
        self._tell(_NOTE if self._problem is None else f"No robot: {self._problem}.")

    def _tell(self, *lines: str) -> None:
        body = "".join(f"<div>{html.escape(line)}</div>" for line in lines)
        self._box.content = (
            f"<div style='font-size:12px;line-height:1.4;padding:4px 8px;overflow-wrap:anywhere;"
            f"min-height:calc({_LINES} * 1.4em + 8px)'>{body}</div>"
        )

    def _save_file(self) -> None:
        self._tell(*self._write())

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
