"""The robot's parts are drawn from outside only, so each must be closed and face outward."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from pathlib import Path
from typing import Any
from unittest.mock import MagicMock

import numpy as np
import pytest

from deltaviz import load_robot
from deltaviz.mechanism import FiveBar
from deltaviz.robots import preset_names
from deltaviz.scene.robot_model import draw

TOOL_AXIS = Path(__file__).parents[2] / "docs" / "examples" / "stm32-tool.toml"
MOST_FACES = 13_000  # what a computer without a graphics card draws about ten times a second


def parts(robot: Any) -> dict[str, tuple[Any, Any]]:
    scene = MagicMock()
    draw(scene, robot)
    return {call.args[0]: call.args[1:] for call in scene.add_mesh_simple.call_args_list}


def robot_of(name: str, tool: float) -> Any:
    robot = load_robot(TOOL_AXIS if name == "stm32-tool" else name)
    return replace(robot, tool_offset=(*robot.tool_offset[:-1], tool))


@pytest.mark.parametrize("name", [*preset_names(), "stm32-tool"])
@pytest.mark.parametrize("tool", [0.0, -60.0])
def test_every_part_is_closed_and_faces_outward(name: str, tool: float) -> None:
    for part, (vertices, faces) in parts(robot_of(name, tool)).items():
        corners = vertices[faces].astype(float)
        a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
        assert np.einsum("ij,ij->i", a, np.cross(b, c)).sum() > 0, part
        assert open_edges(corners) == [], part


@pytest.mark.parametrize("name", ["stm32", "fivebar", "stm32-tool"])
def test_the_robot_is_not_too_much_for_a_processor_to_draw(name: str) -> None:
    assert sum(len(faces) for _, faces in parts(robot_of(name, 0.0)).values()) <= MOST_FACES


@pytest.mark.parametrize("half", [0.0, 80.0])
def test_a_five_bar_without_a_platform_needs_no_links(half: float) -> None:
    """Where both forearms end in one point there is nothing to be kept level."""
    point = FiveBar(base_half=half, platform_half=0, upper_arm=100, forearm=200)
    drawn = parts(replace(load_robot("fivebar"), mechanism=point))
    assert not [name for name in drawn if "link" in name or "bracket" in name]
    assert [name for name in parts(load_robot("fivebar")) if "link" in name]


def open_edges(corners: Any) -> list[Any]:
    """Edges that do not have one face on either side; bands share places, not vertices."""
    places = [[tuple(corner) for corner in face] for face in np.round(corners, 6).tolist()]
    edges: Counter[Any] = Counter()
    for face in places:
        for i in range(3):
            start, end = face[i], face[(i + 1) % 3]
            if start != end:  # a triangle at a pole has one edge without length
                edges[start, end] += 1
                edges[end, start] -= 1
    return [edge for edge, count in edges.items() if count]
