"""A workspace written to files for other programs."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np

from deltaviz.robots.workspace.workspace import Empty, Workspace


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
    what limits them, and what that is; how many. Raises Empty."""
    if workspace.empty:
        raise Empty(workspace.reason)
    field = workspace.field(spacing)
    index = np.argwhere(field.value >= 0)
    points = field.grid.low + field.grid.cell * index
    margin, code = workspace.margins.nearest(points)
    robot = workspace.robot
    theta = np.degrees(robot.inverse(points)[:, : robot.mechanism.joints])
    header = [f"{axis.lower()}_mm" for axis in robot.axes]
    header += [f"theta{i + 1}_deg" for i in range(theta.shape[1])]
    with Path(path).open("w", newline="", encoding="utf-8") as file:
        out = csv.writer(file)
        out.writerow([*header, "margin_mm", "limit"])
        for point, angles, room, name in zip(
            points.tolist(), theta.tolist(), margin.tolist(), code.tolist(), strict=True
        ):
            numbers = [f"{v:.6g}" for v in point] + [f"{v:.6f}" for v in angles]
            out.writerow([*numbers, f"{room:.3f}", str(workspace.margins.names[name])])
    return len(points)
