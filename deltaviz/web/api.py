"""The calls under /api. Whatever acts is a POST; a stop waits for nobody."""

from __future__ import annotations

import asyncio
import math
import time
from collections.abc import Awaitable, Callable
from typing import Annotated, Any

from fastapi import APIRouter, Depends, HTTPException, Request

from deltaviz.machine import intent
from deltaviz.machine.port import MachinePort
from deltaviz.robots import preset_names
from deltaviz.web import models
from deltaviz.web.desk import REFUSALS, ask, robot_angles, robot_point
from deltaviz.web.kinematics import add_kinematics
from deltaviz.web.robot_json import robot_json
from deltaviz.web.session import Sessions
from deltaviz.web.state import state_json

# Calls without values: path, intent, what it does.
_PLAIN: tuple[tuple[str, Callable[[str], intent.Intent], str], ...] = (
    ("enable", intent.Enable, "Drivers on."),
    ("disable", intent.Disable, "Drivers off; the homing is lost."),
    ("home", intent.Home, "Home; it ends at the ready pose."),
    ("reset", intent.Reset, "Leave a fault or an e-stop; the drivers stay off."),
    ("pause", intent.Pause, "Pause what runs."),
    ("resume", intent.Resume, "Go on with what was paused."),
    ("disconnect", intent.Disconnect, "Leave the board."),
)


async def _client(request: Request) -> str:
    sessions: Sessions = request.app.state.sessions
    return sessions.client_of_request(request)


Client = Annotated[str, Depends(_client)]


def make_api(machine: MachinePort) -> APIRouter:
    """The routes of `/api` for one machine."""
    router = APIRouter(prefix="/api")
    _add_stops(router, machine)
    _add_looks(router, machine)
    add_kinematics(router, machine)
    _add_motion(router, machine)
    _add_plain(router, machine)
    _add_choices(router, machine)
    return router


def _add_stops(router: APIRouter, machine: MachinePort) -> None:
    # No body is read and no answer awaited: what reaches the handler has stopped the robot.
    @router.post("/stop")
    async def stop(client: Client) -> models.Taken:
        """Controlled stop, position kept. Anyone's, in every mode, never refused."""
        machine.stop(client, "Stop was pressed")
        return models.Taken()

    @router.post("/estop")
    async def estop(client: Client) -> models.Taken:
        """Drivers off; the homing is lost, and the arms may drop. Anyone's, never refused."""
        machine.estop(client, "E-stop was pressed")
        return models.Taken()


def _add_looks(router: APIRouter, machine: MachinePort) -> None:
    # A robot from a file can be chosen again after another was.
    choices = {*preset_names(), machine.robot.name}

    @router.get("/state")
    async def state(client: Client) -> dict[str, Any]:
        """The machine now. Lengths in mm, angles in degrees; null where unknown."""
        now = time.monotonic()
        return state_json(machine.snapshot, robot=machine.robot, client=client, now=now)

    @router.get("/robot")
    async def robot() -> dict[str, Any]:
        """The robot: geometry, limits, and the presets there are."""
        return robot_json(machine.robot, choices | {machine.robot.name})

    @router.get("/ports")
    def ports() -> list[models.Port]:
        """The links that can be chosen, by id."""
        return [models.Port(id=link.id, description=link.description) for link in machine.links()]


def _add_motion(router: APIRouter, machine: MachinePort) -> None:
    @router.post("/move", status_code=202, responses=REFUSALS)
    async def move(to: models.Move, client: Client) -> models.Taken:
        """Move there: straight for xyz_mm. Nothing moves when the way breaks a limit."""
        if to.xyz_mm is not None:
            point = robot_point(machine, to.xyz_mm)
            tool = None if to.tool_deg is None else math.radians(to.tool_deg)
            return await ask(machine, intent.MoveToPoint(client, point, to.speed, tool))
        angles = robot_angles(machine, to.theta_deg or [])
        return await ask(machine, intent.MoveToAngles(client, angles, to.speed))

    @router.post("/jog", status_code=202, responses=REFUSALS)
    async def jog(by: models.Step, client: Client) -> models.Taken:
        """One relative step. While it runs, more steps add to its target."""
        if by.xyz_mm is not None:
            point = robot_point(machine, by.xyz_mm)
            return await ask(machine, intent.StepPoint(client, point, by.speed))
        angles = robot_angles(machine, by.theta_deg or [])
        return await ask(machine, intent.StepAngles(client, angles, by.speed))


def _add_plain(router: APIRouter, machine: MachinePort) -> None:
    for path, wish, what in _PLAIN:
        router.add_api_route(
            f"/{path}",
            _asking(machine, wish),
            methods=["POST"],
            name=path,
            description=what,
            responses=REFUSALS,
        )


def _asking(
    machine: MachinePort, wish: Callable[[str], intent.Intent]
) -> Callable[..., Awaitable[models.Taken]]:
    async def call(client: Client, _: models.Nothing | None = None) -> models.Taken:
        return await ask(machine, wish(client))

    return call


def _add_choices(router: APIRouter, machine: MachinePort) -> None:
    @router.post("/robot", responses=REFUSALS)
    async def choose_robot(choice: models.RobotChoice, client: Client) -> models.Taken:
        """Drive another robot: a preset's id, or that of the file given at the start."""
        return await ask(machine, intent.SelectRobot(client, choice.robot))

    @router.post("/connect", responses=REFUSALS)
    async def connect(choice: models.LinkChoice, client: Client) -> models.Taken:
        """Connect to a board by an id from GET /api/ports; the state tells how it goes."""
        ids = [link.id for link in await asyncio.to_thread(machine.links)]
        if choice.link not in ids:
            detail = f"There is no link '{choice.link}'; there is: {', '.join(ids)}."
            raise HTTPException(422, detail)
        return await ask(machine, intent.Connect(client, choice.link))

    @router.post("/control", responses=REFUSALS)
    async def control(change: models.ControlChange, client: Client) -> models.Taken:
        """Ask for control, or give it up. It changes hands only at rest."""
        if change.action == "request":
            return await ask(machine, intent.RequestControl(client))
        return await ask(machine, intent.ReleaseControl(client))
