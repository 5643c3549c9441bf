"""POST /api/ik and /api/fk: the robot's geometry, no limits, nothing moves."""

from __future__ import annotations

from typing import Any

import numpy as np
from fastapi import APIRouter, HTTPException

from deltaviz.machine.port import MachinePort
from deltaviz.robots import Robot
from deltaviz.robots.coordinates import in_space
from deltaviz.web import models
from deltaviz.web.desk import MALFORMED, robot_angles, robot_point


def add_kinematics(router: APIRouter, machine: MachinePort) -> None:
    @router.post("/ik", responses=MALFORMED)
    async def inverse(question: models.InverseQuestion) -> models.InverseAnswer:
        """Joint angles for a tool tip position, or for a list of them. Geometry only."""
        points, is_one = _as_list(question.xyz_mm)
        robot, fields = machine.robot, _fields("xyz_mm", len(points), is_one=is_one)
        xyz = np.array(
            [
                robot_point(machine, point, field=field)
                for point, field in zip(points, fields, strict=True)
            ]
        )
        theta = np.degrees(robot.inverse(xyz))
        for index in _impossible(theta):
            reason = str(robot.reach(xyz[index]))
            raise HTTPException(422, reason if is_one else f"{fields[index]}: {reason}")
        return models.InverseAnswer(theta_deg=_answer(theta.tolist(), is_one=is_one))

    @router.post("/fk", responses=MALFORMED)
    async def forward(question: models.ForwardQuestion) -> models.ForwardAnswer:
        """Tool tip position for joint angles, or for a list of them. Geometry only."""
        sets, is_one = _as_list(question.theta_deg)
        robot, fields = machine.robot, _fields("theta_deg", len(sets), is_one=is_one)
        theta = np.array(
            [
                robot_angles(machine, angles, field=field)
                for angles, field in zip(sets, fields, strict=True)
            ]
        )
        xyz = robot.forward(theta)
        for index in _impossible(xyz):
            reason = _no_pose(robot)
            raise HTTPException(422, reason if is_one else f"{fields[index]}: {reason}")
        answer = [list(in_space(point)) for point in xyz.tolist()]
        return models.ForwardAnswer(xyz_mm=_answer(answer, is_one=is_one))


def _as_list(value: list[Any]) -> tuple[list[list[float]], bool]:
    is_one = not isinstance(value[0], list)
    return ([value] if is_one else value), is_one


def _fields(name: str, count: int, *, is_one: bool) -> list[str]:
    """What an error calls each entry."""
    return [name] if is_one else [f"{name}[{index}]" for index in range(count)]


def _answer(rows: list[list[float]], *, is_one: bool) -> list[float] | list[list[float]]:
    plain = [[value + 0.0 for value in row] for row in rows]  # + 0.0: no "-0"
    return plain[0] if is_one else plain


def _impossible(rows: np.ndarray) -> list[int]:
    return np.flatnonzero(~np.isfinite(rows).all(axis=-1)).tolist()


def _no_pose(robot: Robot) -> str:
    return f"With these angles the forearms of {robot.name} cannot meet."
