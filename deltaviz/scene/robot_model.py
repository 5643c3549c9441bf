"""What the scene asks of a drawn robot, and which drawing belongs to which kind."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import viser

from deltaviz.mechanism import FiveBar, RotaryDelta
from deltaviz.robots import Robot
from deltaviz.scene.five_bar_model import FiveBarModel
from deltaviz.scene.rotary_delta_model import RotaryDeltaModel

Joints = tuple[float, ...]


class RobotModel(Protocol):
    """Nodes below `/robot`, `/ghost` and `/labels`, made once and moved by their properties."""

    effector: viser.MeshHandle
    """The part that a pointer grabs; whatever follows the effector is a child of its parent."""

    reach: float
    """How far the elbows stand out from the centre, in metres."""
    thickness: float
    """What the sizes of its parts are made from, in metres."""

    def show(self, theta: Joints, xyz: tuple[float, ...]) -> None:
        """The reported pose: rad, and the tool tip in mm, in the robot's own coordinates."""
        ...

    def show_target(self, theta: Joints | None, xyz: tuple[float, ...] | None) -> None:
        """The ghost; None hides it."""
        ...

    def show_margins(self, margins: tuple[float, ...]) -> None:
        """Tint each joint by how near it is to a limit."""
        ...

    def show_known(self, known: bool) -> None:
        """Solid while the pose is known, a shade of itself while it is not."""
        ...

    def remove(self) -> None: ...


_MODELS: dict[type, Callable[[viser.SceneApi, Robot], RobotModel]] = {
    RotaryDelta: RotaryDeltaModel,
    FiveBar: FiveBarModel,
}


def draw(scene: viser.SceneApi, robot: Robot) -> RobotModel:
    """Make the nodes of a robot. Raises KeyError for a kind that has no drawing."""
    return _MODELS[type(robot.mechanism)](scene, robot)
