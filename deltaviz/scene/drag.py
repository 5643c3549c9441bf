"""Dragging the effector: from viser's pointer events to intents.

A drag belongs to the session that began it. It ends when the pointer is let go, when its
browser goes (viser reports that as an end), when its session loses control, and when the
controller refuses; after that nothing moves until a fresh press.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass

import numpy as np
from viser import CameraHandle, SceneNodeDragEvent
from viser._messages import DragButton, KeyModifier

from deltaviz.machine.intent import Answer, DragEnd, DragStart, DragTo, Refused
from deltaviz.machine.port import MachinePort
from deltaviz.machine.snapshot import Snapshot
from deltaviz.robots.coordinates import in_robot, in_space, is_planar
from deltaviz.scene.listener import SESSION
from deltaviz.scene.pointer import Eye, Grip
from deltaviz.scene.units import metres, millimetres

BINDINGS: tuple[tuple[DragButton, KeyModifier | None], ...] = (("left", None), ("left", "shift"))
_SAME_GESTURE = 0.4  # s between the end of one segment and the next, when Shift changes


@dataclass
class _Drag:
    client_id: int
    vertical: bool
    grip: Grip
    target: np.ndarray  # m, the last one posted or where the tip was
    refused: bool = False
    ended_at: float | None = None


class Dragging:
    """The drags of all sessions. Runs in viser's event loop only."""

    def __init__(
        self,
        machine: MachinePort,
        tell: Callable[[str, str], None],
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        """`tell(session, text)` shows a person why the robot does not follow."""
        self._machine = machine
        self._tell = tell
        self._clock = clock
        self._drags: dict[str, _Drag] = {}

    async def on_plane(self, event: SceneNodeDragEvent) -> None:  # type: ignore[type-arg]
        self._on_event(event, vertical=False)

    async def on_vertical(self, event: SceneNodeDragEvent) -> None:  # type: ignore[type-arg]
        self._on_event(event, vertical=True)

    def end_lost(self, snapshot: Snapshot) -> None:
        """End the drags of sessions that no longer hold control."""
        for session, drag in list(self._drags.items()):
            if drag.ended_at is None and snapshot.holder not in (None, session):
                self._end(session, drag)
        self._forget_old()

    def _on_event(self, event: SceneNodeDragEvent, *, vertical: bool) -> None:  # type: ignore[type-arg]
        session = SESSION.get()
        if session is None:
            return
        if event.phase == "start":
            self._begin(session, event, vertical=vertical)
            return
        drag = self._drags.get(session)
        if drag is None or drag.ended_at is not None or drag.client_id != event.client_id:
            return
        if drag.refused:
            drag.ended_at = self._clock()
            return
        self._follow(session, drag, event)
        if event.phase == "end":
            self._end(session, drag)

    def _begin(self, session: str, event: SceneNodeDragEvent, *, vertical: bool) -> None:  # type: ignore[type-arg]
        tip = self._machine.snapshot.xyz
        if tip is None:
            self._tell(session, "The robot's position is not known.")
            return
        grip = Grip(grabbed=np.asarray(event.start_position), tip=metres(in_space(tip)))
        drag = _Drag(client_id=event.client_id, vertical=vertical, grip=grip, target=grip.tip)
        if (before := self._just_ended(session, event.client_id)) is not None:
            # Shift changed under a held pointer: go on from where the last segment pointed,
            # though the robot may still be on its way there.
            ahead = before.target - grip.tip
            drag.grip = Grip(grabbed=grip.grabbed + ahead, tip=before.target)
            drag.target = before.target
        self._drags[session] = drag
        self._post(session, drag, DragStart(client=session, at=self._clock()))

    def _follow(self, session: str, drag: _Drag, event: SceneNodeDragEvent) -> None:  # type: ignore[type-arg]
        robot = self._machine.robot
        cast = drag.grip.in_plane if is_planar(robot) else drag.grip.over_plane
        if drag.vertical:
            cast = drag.grip.along_vertical
        target = cast(eye_of(event.client.camera), event.end_screen_pos)
        if target is None:
            return
        drag.target = target
        xyz = in_robot(robot, millimetres(target).tolist())
        self._post(session, drag, DragTo(client=session, xyz=xyz, at=self._clock()))

    def _end(self, session: str, drag: _Drag) -> None:
        drag.ended_at = self._clock()
        self._post(session, drag, DragEnd(client=session))

    def _post(self, session: str, drag: _Drag, intent: DragStart | DragTo | DragEnd) -> None:
        def answered(future: Future[Answer]) -> None:
            if future.cancelled() or future.exception() is not None:
                drag.refused = True
            elif isinstance(answer := future.result(), Refused) and not drag.refused:
                drag.refused = True
                self._tell(session, answer.detail)

        self._machine.post(intent).add_done_callback(answered)

    def _just_ended(self, session: str, client_id: int) -> _Drag | None:
        drag = self._drags.get(session)
        if drag is None or drag.refused or drag.ended_at is None or drag.client_id != client_id:
            return None
        return drag if self._clock() - drag.ended_at < _SAME_GESTURE else None

    def _forget_old(self) -> None:
        now = self._clock()
        for session, drag in list(self._drags.items()):
            if drag.ended_at is not None and now - drag.ended_at > _SAME_GESTURE:
                del self._drags[session]


def eye_of(camera: CameraHandle) -> Eye:
    """The camera of one browser."""
    return Eye(
        position=np.asarray(camera.position, dtype=np.float64),
        wxyz=np.asarray(camera.wxyz, dtype=np.float64),
        fov=camera.fov,
        aspect=camera.aspect,
    )
