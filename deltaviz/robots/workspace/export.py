"""A workspace written to files for other programs."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from deltaviz.mechanism.arrays import Array
from deltaviz.robots.workspace.workspace import Empty, Workspace

AT_ONCE = 100_000  # points


def write_stl(workspace: Workspace, path: str) -> None:
    """The boundary as a binary STL file, mm. Raises ValueError for a robot in a plane, Empty."""
    import trimesh

    if workspace.margins.dimensions == 2:
        raise ValueError("a workspace in a plane has no surface; STL files hold surfaces")
    if workspace.empty:
        raise Empty(workspace.reason)
    mesh = trimesh.Trimesh(workspace.boundary.vertices, workspace.boundary.faces, process=False)
    mesh.export(path, file_type="stl")


def write_csv(workspace: Workspace, path: str, spacing: float) -> int:
    """The points of a grid that are within reach, with their joint angles, how far they are from
    what limits them, and what that is; how many. Raises Empty, TooFine."""
    if workspace.empty:
        raise Empty(workspace.reason)
    field = workspace.field(spacing)
    index = np.argwhere(field.value >= 0)
    robot = workspace.robot
    header = [f"{axis.lower()}_mm" for axis in robot.axes]
    header += [f"theta{i + 1}_deg" for i in range(robot.mechanism.joints)]
    with Path(path).open("w", newline="", encoding="utf-8") as file:
        out = csv.writer(file)
        out.writerow([*header, "margin_mm", "limit"])
        for first in range(0, len(index), AT_ONCE):
            points = field.grid.low + field.grid.cell * index[first : first + AT_ONCE]
            out.writerows(_rows(workspace, points))
    return len(index)


def _rows(workspace: Workspace, points: Array) -> Iterator[list[str]]:
    margin, code = workspace.margins.nearest(points)
    robot = workspace.robot
    theta = np.degrees(robot.inverse(points)[:, : robot.mechanism.joints])
    for point, angles, room, name in zip(
        points.tolist(), theta.tolist(), margin.tolist(), code.tolist(), strict=True
    ):
        numbers = [f"{v:.6g}" for v in point] + [f"{v:.6f}" for v in angles]
        yield [*numbers, f"{room:.3f}", str(workspace.margins.names[name])]
