"""The robot's parts are drawn from outside only, so each must be closed and face outward."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from typing import Any
from unittest.mock import MagicMock

import numpy as np
import pytest

from deltaviz import load_robot
from deltaviz.scene.rotary_delta_model import RotaryDeltaModel

MOST_FACES = 13_000  # what a computer without a graphics card draws about ten times a second


def parts(robot: Any) -> dict[str, tuple[Any, Any]]:
    scene = MagicMock()
    RotaryDeltaModel(scene, robot)
    return {call.args[0]: call.args[1:] for call in scene.add_mesh_simple.call_args_list}


@pytest.mark.parametrize("name", ["stm32", "trossen", "zheng2023", "deltadraw"])
@pytest.mark.parametrize("tool", [(0.0, 0.0, 0.0), (0.0, 0.0, -60.0)])
def test_every_part_is_closed_and_faces_outward(name: str, tool: tuple[float, ...]) -> None:
    for part, (vertices, faces) in parts(replace(load_robot(name), tool_offset=tool)).items():
        corners = vertices[faces].astype(float)
        a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
        assert np.einsum("ij,ij->i", a, np.cross(b, c)).sum() > 0, part
        assert open_edges(corners) == [], part


def test_the_robot_is_not_too_much_for_a_processor_to_draw() -> None:
    assert sum(len(faces) for _, faces in parts(load_robot("stm32")).values()) <= MOST_FACES


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
