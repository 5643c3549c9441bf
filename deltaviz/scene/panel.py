"""viser's panel: what the target is, as angles and as a place, and which robot it is.

Callbacks only post intents. Whatever they ask for comes back by the controller's snapshots.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import viser
from viser import GuiDropdownHandle, GuiEvent

from deltaviz.machine.intent import FollowAngles, FollowPoint, Intent, SelectRobot
from deltaviz.machine.snapshot import Snapshot
from deltaviz.robots import Robot, preset_names
from deltaviz.scene.controls import Controls
from deltaviz.scene.listener import SESSION
from deltaviz.scene.sliders import Scale, Sliders

WIDTH = 288.0
_AXES = ("X", "Y", "Z")


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
        self._gui.configure_theme(show_logo=False, show_share_button=False, control_width="small")
        self._gui.set_panel_label("Target")
        self._gui.main_panel.dock_left()
        self._gui.main_panel.set_width(WIDTH)
        self._angles_folder = self._gui.add_folder("Angles")
        self._angles = self._angle_sliders(robot)
        self._position = Sliders(
            self._gui,
            self._gui.add_folder("Position"),
            controls,
            _position_scales(robot),
            self._ask_for_point,
        )
        self.display_folder = self._gui.add_folder("Display", expand_by_default=False)
        with self._gui.add_folder("Robot"):
            self._choice = self._robot_choice(robot)
            self._readout = self._gui.add_html(_readout(None))

    @property
    def steering(self) -> list[viser.GuiInputHandle[float] | GuiDropdownHandle[str]]:
        """The inputs that only the session in control may use."""
        return [*self._angles.handles, *self._position.handles, self._choice]

    def set_robot(self, robot: Robot) -> None:
        """Another robot: other ranges, and perhaps another number of joints."""
        if len(self._angles) == robot.joint_count:
            self._angles.set_ranges(_angle_scales(robot))
        else:
            self._angles.remove()
            self._angles = self._angle_sliders(robot)
        self._position.set_ranges(_position_scales(robot))
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
        self._readout.content = _readout(snapshot)

    def _angle_sliders(self, robot: Robot) -> Sliders:
        scales = _angle_scales(robot)
        return Sliders(self._gui, self._angles_folder, self._controls, scales, self._ask_for_angles)

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
    return [
        Scale(f"θ{i + 1} °", math.degrees(low), math.degrees(high))
        for i, (low, high) in enumerate(zip(robot.joints.min, robot.joints.max, strict=True))
    ]


def _position_scales(robot: Robot) -> list[Scale]:
    workspace = robot.workspace
    radius = workspace.radius
    across = (-radius, radius) if radius is not None else (0.0, 0.0)
    ranges = (workspace.x or across, workspace.y or across, workspace.z)
    return [
        Scale(f"{axis} mm", float(low), float(high))
        for axis, (low, high) in zip(_AXES, ranges, strict=True)
    ]


def _readout(snapshot: Snapshot | None) -> str:
    """The reported pose; for steppers it is counted, not measured."""
    rows: list[tuple[str, str]] = []
    if snapshot is not None and snapshot.xyz is not None and snapshot.theta is not None:
        rows += [(f"{a} mm", f"{v:.1f}") for a, v in zip(_AXES, snapshot.xyz, strict=False)]
        rows += [(f"θ{i + 1} °", f"{math.degrees(v):.1f}") for i, v in enumerate(snapshot.theta)]
    half = (len(rows) + 1) // 2
    cells = "".join(
        "<tr>" + "".join(f"<td>{name}</td>{_NUMBER}{value}</td>" for name, value in pair) + "</tr>"
        for pair in zip(rows[:half], rows[half:], strict=False)
    )
    body = f"<table style='width:100%'>{cells}</table>" if rows else "Not known."
    return (
        "<div style='font-size:12px;padding:4px 8px;font-variant-numeric:tabular-nums'>"
        f"<b>Reported</b> (counted, not measured){body}</div>"
    )


_NUMBER = "<td style='text-align:right;padding-right:8px'>"
