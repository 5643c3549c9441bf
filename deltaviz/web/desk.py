"""Asks the controller on behalf of an HTTP request, and tells its answer in HTTP's terms."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from typing import Any

from fastapi import HTTPException

from deltaviz.machine import intent
from deltaviz.machine.port import MachinePort
from deltaviz.web import models
from deltaviz.web.axes import AxesError, to_robot_angles, to_robot_point

ANSWER_TIMEOUT = 5.0  # s; the controller answers in milliseconds

STATUS_OF = {
    intent.RefusalKind.MODE: 409,
    intent.RefusalKind.CONTROL: 409,
    intent.RefusalKind.VALUE: 422,
}
MALFORMED: dict[int | str, dict[str, Any]] = {
    422: {"model": models.Error, "description": "Malformed, out of reach, or beyond a limit"},
}
REFUSALS: dict[int | str, dict[str, Any]] = {
    409: {"model": models.Error, "description": "Not in this mode, or another holds control"},
    **MALFORMED,
}


async def ask(machine: MachinePort, wish: intent.Intent) -> models.Taken:
    """Post an intent and wait for its answer. Raises HTTPException when it was not taken."""
    try:
        future = asyncio.wrap_future(machine.post(wish))
        answer = await asyncio.wait_for(future, ANSWER_TIMEOUT)
    except (TimeoutError, OSError, EOFError):
        detail = "The controller does not answer. Stop the robot at its own switch; restart."
        raise HTTPException(503, detail) from None
    if isinstance(answer, intent.Refused):
        raise HTTPException(STATUS_OF[answer.kind], answer.detail)
    return models.Taken()


def robot_point(
    machine: MachinePort, xyz: Sequence[float], *, field: str = "xyz_mm"
) -> tuple[float, ...]:
    """A place in the robot's axes, or a 422."""
    try:
        return to_robot_point(machine.robot, xyz, field=field)
    except AxesError as error:
        raise HTTPException(422, str(error)) from None


def robot_angles(
    machine: MachinePort, degrees: Sequence[float], *, field: str = "theta_deg"
) -> tuple[float, ...]:
    """Angles in rad, one for each joint, or a 422."""
    try:
        return to_robot_angles(machine.robot, degrees, field=field)
    except AxesError as error:
        raise HTTPException(422, str(error)) from None
