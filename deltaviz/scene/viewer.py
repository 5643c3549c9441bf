"""What belongs to one browser: its theme, its display choices, its grip on the robot."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
import viser
from viser import ClientHandle

from deltaviz.robots.load import Loaded
from deltaviz.scene import colours, inner
from deltaviz.scene.controls import Controls
from deltaviz.scene.drag import BINDINGS, Dragging
from deltaviz.scene.equals import Equals
from deltaviz.scene.inputs import Inputs
from deltaviz.scene.panel import Panel
from deltaviz.scene.robot_model import RobotModel
from deltaviz.scene.rows import Row, html_of
from deltaviz.scene.workspace.orders import Send
from deltaviz.scene.workspace.shown import Choices, WorkspaceShown

HANDLE = "/robot/effector/handle"

_LEAST_SHARE = 0.075  # of the picture's smaller side: a radius that makes 44 px on a phone
_LEAST_PIXELS = 26.0
_TELL_AGAIN = 12  # times: for a second or so
_REFINE = 1.06  # a change of size smaller than this is not worth a message


@dataclass
class Display:
    """What one session chose to see; kept while its browser reconnects."""

    trail: bool = True
    ghost: bool = True
    labels: bool = False
    workspace: bool = False
    shadows: bool = False
    reflections: bool = False
    dark: bool = False
    reach: Choices = field(default_factory=Choices)


_LAYERS = {"trail": "/trail", "ghost": "/ghost", "labels": "/labels", "workspace": "/workspace"}
_TITLES = {
    "trail": "Trail",
    "ghost": "Ghost at the target",
    "labels": "Joint labels",
    "workspace": "Allowed zone",
    "shadows": "Shadows",
    "reflections": "Reflections",
}


class Viewer:
    """One browser. Runs in viser's event loop only."""

    def __init__(
        self,
        client: ClientHandle,
        session: str | None,
        *,
        display: Display,
        panel: Panel,
        controls: Controls,
        dragging: Dragging,
        loaded: Loaded,
        quick: Send,
        patient: Send,
    ) -> None:
        self.client = client
        self.session = session
        self._display = display
        self._panel = panel
        self._dragging = dragging
        self._may_steer: bool | None = None
        self._tell_again = 0
        self._handle: viser.IcosphereHandle | None = None
        self._handle_scale = 1.0
        self.equals = Equals(controls)
        self._toggles = Inputs("Display", client.gui, controls, self.equals)
        self._add_toggles()
        self.reach = WorkspaceShown(
            client, controls, self.equals, display.reach, loaded, quick=quick, patient=patient
        )
        self._note = client.gui.add_html("", visible=False, order=-1.0)
        self.apply_theme()
        for choice in (*_LAYERS, "shadows", "reflections"):
            self._apply(choice)

    def leave(self) -> None:
        """The browser is gone."""
        self._toggles.retire()
        self.reach.leave()

    def apply_theme(self) -> None:
        self.client.gui.configure_theme(
            dark_mode=self._display.dark,
            show_logo=False,
            show_share_button=False,
            control_width="small",
        )

    def tell(self, text: str) -> None:
        """A sentence above the panel's inputs; empty to take it away."""
        content = html_of((Row(text),) if text else ())
        if self._note.content != content:
            self._note.content = content
            self._note.visible = bool(text)

    def hold(self, model: RobotModel) -> None:
        """Put the handle on a robot that was just drawn."""
        if self._handle is not None:
            self._handle.remove()
        handle = self.client.scene.add_icosphere(
            HANDLE,
            radius=1.0,
            subdivisions=3,
            color=colours.EFFECTOR,
            opacity=0.1,
            cast_shadow=False,
            receive_shadow=False,
            visible=bool(self._may_steer),
        )
        handle.on_drag("left")(self._dragging.on_plane)
        handle.on_drag("left", modifier="shift")(self._dragging.on_vertical)
        self._handle, self._handle_scale = handle, 0.0
        self._tell_again = _TELL_AGAIN
        self._apply_steering(model)

    def set_steering(self, may_steer: bool, model: RobotModel) -> None:
        """Whether this session may move the robot: others see the panel and cannot use it.

        To be called again and again: what is said to one browser may overtake what is said to
        all, so a new robot's inputs are told of several times.
        """
        if may_steer == self._may_steer and self._tell_again == 0:
            return
        self._tell_again = max(0, self._tell_again - 1)
        self._may_steer = may_steer
        self._apply_steering(model)

    def fit_handle(self, effector: np.ndarray) -> None:
        """Keep the handle large enough for a finger, from wherever this browser looks."""
        camera = self.client.camera
        distance = float(np.linalg.norm(np.asarray(camera.position) - effector))
        smaller_side = min(camera.image_width, camera.image_height)
        pixels = max(_LEAST_SHARE * smaller_side, _LEAST_PIXELS)
        metres_per_pixel = 2.0 * math.tan(camera.fov / 2.0) * distance / camera.image_height
        scale = pixels * metres_per_pixel
        if self._handle is not None and not (
            scale / _REFINE < self._handle_scale < scale * _REFINE
        ):
            self._handle_scale = scale
            self._handle.scale = scale

    def _apply_steering(self, model: RobotModel) -> None:
        may_steer = bool(self._may_steer)
        for handle in self._panel.steering:
            inner.set_enabled(self.client, handle, may_steer)
        inner.set_draggable(self.client, model.effector, BINDINGS if may_steer else ())
        if self._handle is not None:
            self._handle.visible = may_steer
        self.reach.set_steering(may_steer)

    def _add_toggles(self) -> None:
        with self._panel.display_folder:
            for choice, title in _TITLES.items():
                self._toggles.toggle(title, getattr(self._display, choice), self._setter(choice))

    def _setter(self, choice: str) -> Callable[[bool], None]:
        def choose(wanted: bool) -> None:
            setattr(self._display, choice, wanted)
            self._apply(choice)

        return choose

    def _apply(self, choice: str) -> None:
        wanted = getattr(self._display, choice)
        if choice in _LAYERS:
            inner.set_visible(self.client, _LAYERS[choice], wanted)
        elif choice == "shadows":
            self.client.scene.configure_default_lights(cast_shadow=wanted)
        else:
            self.client.scene.configure_environment_map("studio" if wanted else None)
