"""What stands around the robot: light, floor, the outline of the workspace, layers."""

from __future__ import annotations

import math

import numpy as np
import viser

from deltaviz.robots import Robot
from deltaviz.robots.coordinates import is_planar
from deltaviz.scene import colours, framing
from deltaviz.scene.robot_model import RobotModel
from deltaviz.scene.units import metres

LAYERS = ("/trail", "/ghost", "/labels", "/workspace")
"""Frames that are never removed, so that a browser may hide what hangs below them."""

_CIRCLE = 72


class Stage:
    """The surroundings of one robot, made once and fitted to the next."""

    def __init__(self, server: viser.ViserServer) -> None:
        self._server = server
        scene = server.scene
        scene.set_up_direction("+z")
        # Shadows and an environment map keep the page's main thread busy: off unless chosen.
        scene.configure_default_lights(cast_shadow=False)
        scene.configure_environment_map(None)
        scene.add_light_hemisphere(
            "/light/sky", sky_color=(235, 242, 255), ground_color=(150, 146, 142), intensity=1.6
        )
        # From beside the camera's first place: the sun above leaves upright parts dark.
        scene.add_light_directional(
            "/light/front", color=(255, 250, 242), intensity=1.3, position=(0.9, -0.9, 0.35)
        )
        for layer in LAYERS:
            scene.add_frame(layer, show_axes=False)
        self._floor = scene.add_grid(
            "/floor",
            infinite_grid=True,
            cell_color=colours.GRID,
            section_color=colours.GRID,
            cell_thickness=0.5,
            section_thickness=1.0,
            fade_strength=2.0,
            fade_from="origin",
            shadow_opacity=0.25,
        )
        self._outline = scene.add_line_segments(
            "/workspace/outline",
            points=np.zeros((1, 2, 3), dtype=np.float32),
            colors=colours.OUTLINE,
            thickness=1.5,
            thickness_units="screen",
        )

    def fit(self, robot: Robot, model: RobotModel) -> None:
        """Set floor, outline and cameras to a robot."""
        view = framing.frame(
            reach=model.reach,
            depth=(float(metres(robot.zone.z[0])), float(metres(robot.zone.z[1]))),
            planar=is_planar(robot),
        )
        cell = 10.0 ** round(math.log10(view.radius / 8.0))
        self._floor.position = (0.0, 0.0, view.floor)
        self._floor.cell_size = cell
        self._floor.section_size = 5.0 * cell
        self._floor.fade_distance = 4.5 * view.radius
        self._outline.points = outline(robot)
        self._outline.colors = np.full((len(self._outline.points), 2, 3), colours.OUTLINE, np.uint8)
        camera = self._server.initial_camera
        camera.position, camera.look_at = tuple(view.position), tuple(view.look_at)
        camera.fov = framing.FIELD_OF_VIEW
        camera.near = 0.02 * view.radius
        for client in self._server.get_clients().values():
            client.camera.position = view.position
            client.camera.look_at = view.look_at


def outline(robot: Robot) -> np.ndarray:
    """The edges of the workspace's cylinder, box or rectangle, (n, 2, 3) in metres."""
    workspace = robot.zone
    if workspace.radius is not None:
        angles = np.linspace(0.0, 2 * math.pi, _CIRCLE + 1)
        ring = workspace.radius * np.stack((np.cos(angles), np.sin(angles)), axis=-1)
        posts = ring[: -1 : _CIRCLE // 6]
    else:
        (x0, x1), (y0, y1) = workspace.x or (0.0, 0.0), workspace.y or (0.0, 0.0)
        ring = np.array(((x0, y0), (x1, y0), (x1, y1), (x0, y1), (x0, y0)))
        posts = ring[:-1]
    low, high = workspace.z
    rings = [np.column_stack((ring, np.full(len(ring), z))) for z in (low, high)]
    edges = [np.stack((r[:-1], r[1:]), axis=1) for r in rings]
    edges.append(
        np.stack([np.column_stack((posts, np.full(len(posts), z))) for z in (low, high)], axis=1)
    )
    return metres(np.concatenate(edges)).astype(np.float32)
