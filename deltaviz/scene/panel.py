"""viser's panel: what the target is, as angles and as a place, and which robot it is.

Callbacks only post intents. Whatever they ask for comes back by the controller's snapshots.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import zip_longest

import viser
from viser import GuiDropdownHandle, GuiEvent

from deltaviz.machine.intent import FollowAngles, FollowPoint, Intent, SelectRobot
from deltaviz.machine.snapshot import Snapshot
from deltaviz.robots import Robot, preset_names
from deltaviz.scene.controls import Controls
from deltaviz.scene.listener import SESSION
from deltaviz.scene.sliders import Scale, Sliders

WIDTH = 288.0


class Panel:
    """The shared part of the panel. Runs in viser's event loop only, once it is made."""

    def __init__(
        self,
        server: viser.ViserServer,
        controls: Controls,
        robot: Robot,
        post: Callable[[str, Intent], None],
    ) -> None:
        """`post(session, intent)` hands an intent on and tells the session of a refusal."""
        self._gui = server.gui
        self._controls = controls
        self._post = post
        self._robot = robot
        self._gui.configure_theme(show_logo=False, show_share_button=False, control_width="small")
        self._gui.set_panel_label("Target")
        self._gui.main_panel.dock_left()
        self._gui.main_panel.set_width(WIDTH)
        self._angles_folder = self._gui.add_folder("Angles")
        self._angles = self._angle_sliders(_angle_scales(robot))
        self._position_folder = self._gui.add_folder("Position")
        self._position = self._position_sliders(_position_scales(robot))
        self.display_folder = self._gui.add_folder("Display", expand_by_default=False)
        with self._gui.add_folder("Robot"):
            self._choice = self._robot_choice(robot)
            self._readout = self._gui.add_html(_readout(robot, None))

    @property
    def steering(self) -> list[viser.GuiInputHandle[float] | GuiDropdownHandle[str]]:
        """The inputs that only the session in control may use."""
        return [*self._angles.handles, *self._position.handles, self._choice]

    def set_robot(self, robot: Robot) -> None:
        """Another robot: other ranges, and perhaps another number of joints or axes."""
        self._robot = robot
        self._angles = self._fitted(self._angles, _angle_scales(robot), self._angle_sliders)
        self._position = self._fitted(
            self._position, _position_scales(robot), self._position_sliders
        )
        if robot.name not in self._choice.options:
            self._choice.options = (*self._choice.options, robot.name)
        self._choice.value = robot.name

    def show(self, snapshot: Snapshot) -> None:
        """The target where there is one, else what was commanded last."""
        theta = snapshot.target_theta or snapshot.command_theta or snapshot.theta
        xyz = snapshot.target_xyz or snapshot.command_xyz or snapshot.xyz
        if theta is not None and len(theta) == len(self._angles):
            self._angles.show([math.degrees(angle) for angle in theta])
        if xyz is not None and len(xyz) == len(self._position):
            self._position.show(xyz)
        if self._choice.value != snapshot.robot and snapshot.robot in self._choice.options:
            self._choice.value = snapshot.robot  # a choice that was refused
        self._readout.content = _readout(self._robot, snapshot)

    def _fitted(
        self, sliders: Sliders, scales: list[Scale], make: Callable[[list[Scale]], Sliders]
    ) -> Sliders:
        """The same sliders with other ranges, or others where the labels differ."""
        if sliders.labels == [scale.label for scale in scales]:
            sliders.set_ranges(scales)
            return sliders
        sliders.remove()
        return make(scales)

    def _angle_sliders(self, scales: list[Scale]) -> Sliders:
        return Sliders(self._gui, self._angles_folder, self._controls, scales, self._ask_for_angles)

    def _position_sliders(self, scales: list[Scale]) -> Sliders:
        folder = self._position_folder
        return Sliders(self._gui, folder, self._controls, scales, self._ask_for_point)

    def _robot_choice(self, robot: Robot) -> GuiDropdownHandle[str]:
        names = list(preset_names())
        if robot.name not in names:
            names.append(robot.name)
        choice = self._gui.add_dropdown("Preset", tuple(names), initial_value=robot.name)
        self._controls.add_choice(choice)

        @choice.on_update
        async def _(event: GuiEvent[GuiDropdownHandle[str]]) -> None:
            session = SESSION.get()
            if event.client is not None and session is not None:
                self._post(session, SelectRobot(client=session, robot=event.target.value))

        return choice

    def _ask_for_angles(self, session: str, degrees: tuple[float, ...]) -> None:
        theta = tuple(math.radians(angle) for angle in degrees)
        self._post(session, FollowAngles(client=session, theta=theta))

    def _ask_for_point(self, session: str, xyz: tuple[float, ...]) -> None:
        self._post(session, FollowPoint(client=session, xyz=xyz))


def _angle_scales(robot: Robot) -> list[Scale]:
    ranges = zip(robot.joint_names, robot.joints.min, robot.joints.max, strict=True)
    return [Scale(f"{name} °", math.degrees(low), math.degrees(high)) for name, low, high in ranges]


def _position_scales(robot: Robot) -> list[Scale]:
    workspace = robot.zone
    radius = workspace.radius
    across = (-radius, radius) if radius is not None else (0.0, 0.0)
    ranges = {"X": workspace.x or across, "Y": workspace.y or across, "Z": workspace.z}
    return [
        Scale(f"{axis} mm", float(low), float(high))
        for axis, (low, high) in ((axis, ranges[axis]) for axis in robot.axes)
    ]


def _readout(robot: Robot, snapshot: Snapshot | None) -> str:
    """The reported pose; for steppers it is counted, not measured."""
    rows: list[tuple[str, str]] = []
    if snapshot is not None and snapshot.xyz is not None and snapshot.theta is not None:
        rows += [(f"{a} mm", f"{v:z.1f}") for a, v in zip(robot.axes, snapshot.xyz, strict=False)]
        angles = zip(robot.joint_names, snapshot.theta, strict=False)
        rows += [(f"{name} °", f"{math.degrees(v):z.1f}") for name, v in angles]
    half = (len(rows) + 1) // 2
    cells = "".join(
        "<tr>" + "".join(f"<td>{name}</td>{_NUMBER}{value}</td>" for name, value in pair) + "</tr>"
        for pair in zip_longest(rows[:half], rows[half:], fillvalue=("", ""))
    )
    body = f"<table style='width:100%'>{cells}</table>" if rows else "<div>Not known.</div>"
    return (
        "<div style='font-size:12px;padding:4px 8px;font-variant-numeric:tabular-nums'>"
        f"<b>Reported</b> (counted, not measured){body}</div>"
    )


_NUMBER = "<td style='text-align:right;padding-right:8px'>"
