"""The scene: viser behind our gateway, showing the machine's snapshots at 60 Hz.

Everything that touches nodes runs in viser's event loop, so nothing here needs a lock.
"""

from __future__ import annotations

import asyncio
import contextlib
import logging
import time
from collections.abc import Callable
from concurrent.futures import Future

from fastapi import APIRouter
from starlette.requests import HTTPConnection
from viser import ClientHandle

from deltaviz.machine.intent import Answer, Intent, Refused
from deltaviz.machine.port import MachinePort
from deltaviz.machine.snapshot import Snapshot
from deltaviz.robots.coordinates import in_space
from deltaviz.robots.load import Loaded
from deltaviz.scene.controls import Controls
from deltaviz.scene.drag import Dragging, eye_of
from deltaviz.scene.gateway import Gate, make_router
from deltaviz.scene.items import AnyItem
from deltaviz.scene.listener import SESSION, Listener, open_listener
from deltaviz.scene.page import Page, load_page
from deltaviz.scene.panel import Panel
from deltaviz.scene.robot_model import RobotModel, draw
from deltaviz.scene.stage import Stage
from deltaviz.scene.trail import Trail
from deltaviz.scene.units import metres
from deltaviz.scene.viewer import HANDLE, Display, Viewer
from deltaviz.scene.workspace.grips import GRIPS
from deltaviz.scene.workspace.orders import Reply
from deltaviz.scene.workspace.worker import Worker

_log = logging.getLogger(__name__)

RATE = 60.0  # Hz
_PANEL_EVERY = 5  # frames
_TRAIL_EVERY = 3
_NOTE_LIFE = 6.0  # s


class Scene:
    """The robot in 3D. `start` opens the listener; `router` is mounted by the web layer."""

    def __init__(self, machine: MachinePort) -> None:
        self._machine = machine
        self._controls = Controls()
        self._displays: dict[str | None, Display] = {}
        self._viewers: dict[int, Viewer] = {}
        self._notes: dict[str, float] = {}
        self._items: dict[str, tuple[AnyItem, ...]] = {}
        self._frames = 0
        self._quick, self._patient = Worker(self._computed), Worker(self._computed)
        self._shown: Snapshot | None = None

    def start(self) -> None:
        """Open the listener, draw the robot and follow the machine.

        Raises ListenerOpenError when viser would let strangers in, PageFormatError when its
        page is not the one we know.
        """
        self._page: Page = load_page()
        self._listener: Listener = open_listener()
        try:
            self._set_up()
        except BaseException:
            self._listener.close()
            raise
        self._running = asyncio.run_coroutine_threadsafe(self._follow(), self._loop)

    def close(self) -> None:
        """Stop following and end viser's threads."""
        self._running.cancel()
        self._quick.close()
        self._patient.close()
        self._listener.close()

    def router(
        self,
        *,
        session_of: Callable[[HTTPConnection], str | None],
        holds_control: Callable[[str], bool],
    ) -> APIRouter:
        """Routes for `/scene/` (page) and `/scene` (websocket).

        A session may steer while it holds control or nobody does: its first input takes it.
        """
        return make_router(
            Gate(
                listener=self._listener,
                page=self._page,
                controls=self._controls,
                session_of=session_of,
                may_steer=lambda s: self._machine.snapshot.holder is None or holds_control(s),
                is_dark=lambda session: self._display_of(session).dark,
            )
        )

    def camera_yaw(self, session: str) -> float | None:
        """The turn (rad, counter-clockwise seen from above) that takes base +x to what is
        right in this session's picture; None while it has none. Away from the viewer is
        base +y turned by as much."""
        viewers = [v for v in list(self._viewers.values()) if v.session == session]
        if not viewers:
            return None
        newest = max(viewers, key=lambda viewer: viewer.client.camera.update_timestamp)
        return eye_of(newest.client.camera).yaw

    def set_theme(self, session: str, dark: bool) -> None:
        """Show this session's scene dark or light. From any thread."""
        self._display_of(session).dark = dark
        self._soon(self._apply_theme, session)

    def items(self, session: str) -> tuple[AnyItem, ...] | None:
        """What this session may choose of its picture; the same object while nothing changes.
        None while it has no picture. From any thread."""
        return self._items.get(session)

    def choose(self, session: str, key: str, value: object, refused: Callable[[str], None]) -> None:
        """Choose an item in this session's picture, in all its browsers. From any thread;
        `refused` is called with the reason, in another."""
        self._soon(self._choose, session, key, value, refused)

    def tell(self, session: str, text: str) -> None:
        """Show a sentence in this session's panel for a while. From any thread."""
        self._soon(self._show_note, session, text)

    def _soon(self, call: Callable[..., None], *args: object) -> None:
        """In viser's event loop; nowhere, once that is closed."""
        with contextlib.suppress(RuntimeError):
            self._loop.call_soon_threadsafe(call, *args)

    def _set_up(self) -> None:
        server = self._listener.server
        self._server = server
        self._loop = server.get_event_loop()
        self._dragging = Dragging(self._machine, self.tell)
        self._panel = Panel(server, self._controls, self._machine.robot, self._post)
        self._stage = Stage(server)
        self._trail = Trail(server.scene)
        self._draw(self._machine.loaded)
        server.on_client_connect(self._on_connect)
        server.on_client_disconnect(self._on_disconnect)

    def _draw(self, loaded: Loaded) -> None:
        robot = loaded.robot
        with self._server.atomic():
            model: RobotModel = draw(self._server.scene, robot)
            model.effector.on_drag("left")(self._dragging.on_plane)
            model.effector.on_drag("left", modifier="shift")(self._dragging.on_vertical)
            self._loaded, self._robot, self._model = loaded, robot, model
            self._stage.fit(robot, model)
            self._trail.start(0.018 * model.thickness)
            self._controls.draggable = frozenset((model.effector.name, HANDLE))
            self._controls.slidable = frozenset(GRIPS)
            self._show(self._machine.snapshot)
        for viewer in self._viewers.values():
            viewer.hold(model)
            viewer.reach.set_robot(loaded)

    async def _follow(self) -> None:
        """Show the newest snapshot, 60 times a second; poses are shown, never guessed."""
        due = time.monotonic()
        while True:
            due = max(due + 1.0 / RATE, time.monotonic())
            await asyncio.sleep(due - time.monotonic())
            try:
                self._frame()
            except Exception:
                _log.exception("A frame of the scene could not be drawn")
                await asyncio.sleep(1.0)

    def _frame(self) -> None:
        snapshot = self._machine.snapshot
        loaded = self._machine.loaded
        robot = loaded.robot
        if robot is not self._robot and robot != self._robot:
            self._panel.set_robot(robot)  # first, as drawing tells who may use its sliders
            self._model.remove()
            self._draw(loaded)
        self._frames += 1
        if snapshot is not self._shown and self._fits(snapshot):
            with self._server.atomic():
                self._show(snapshot)
        if self._frames % _PANEL_EVERY == 0:
            self._attend(snapshot)

    def _fits(self, snapshot: Snapshot) -> bool:
        """The snapshot is of the robot that is drawn."""
        return snapshot.theta is None or len(snapshot.theta) == self._robot.joint_count

    def _show(self, snapshot: Snapshot) -> None:
        before, self._shown = self._shown, snapshot
        theta, xyz = snapshot.theta, snapshot.xyz
        self._model.show_known(theta is not None)
        if theta is not None and xyz is not None:
            if before is None or (before.theta, before.xyz) != (theta, xyz):
                self._model.show(theta, xyz)
            if self._frames % _TRAIL_EVERY == 0:
                self._trail.pass_through(in_space(xyz), time.monotonic())
        self._model.show_target(snapshot.target_theta, snapshot.target_xyz)
        self._model.show_margins(snapshot.margins)

    def _attend(self, snapshot: Snapshot) -> None:
        """What need not happen in every frame."""
        self._panel.show(snapshot)
        self._dragging.end_lost(snapshot)
        tip = metres(in_space(snapshot.xyz or (0.0, 0.0, 0.0)))
        now = time.monotonic()
        for viewer in self._viewers.values():
            viewer.set_steering(self._may_steer(viewer.session, snapshot), self._model)
            viewer.fit_handle(tip)
            if viewer.session is not None and self._notes.get(viewer.session, 0.0) < now:
                other = snapshot.holder not in (None, viewer.session)
                viewer.tell("Another session has control." if other else "")
        self._gather_items()

    def _gather_items(self) -> None:
        """Of several browsers of one session those of the newest."""
        gathered = {v.session: v.equals.items() for v in self._viewers.values() if v.session}
        for session, items in gathered.items():
            before = self._items.get(session)
            if before is not None and before == items:
                gathered[session] = before
        self._items = gathered

    def _choose(
        self, session: str, key: str, value: object, refused: Callable[[str], None]
    ) -> None:
        viewers = [v for v in self._viewers.values() if v.session == session]
        if not viewers:
            refused("The scene is not open.")
        may_steer = self._may_steer(session, self._machine.snapshot)
        for viewer in viewers:
            reason = viewer.equals.choose(key, value, may_steer=may_steer)
            if reason is not None:
                refused(reason)
                return

    @staticmethod
    def _may_steer(session: str | None, snapshot: Snapshot) -> bool:
        return session is not None and snapshot.holder in (None, session)

    def _display_of(self, session: str | None) -> Display:
        return self._displays.setdefault(session, Display())

    async def _on_connect(self, client: ClientHandle) -> None:
        session = SESSION.get()
        viewer = Viewer(
            client,
            session,
            display=self._display_of(session),
            panel=self._panel,
            controls=self._controls,
            dragging=self._dragging,
            loaded=self._loaded,
            quick=self._quick.order,
            patient=self._patient.order,
        )
        self._viewers[client.client_id] = viewer
        viewer.set_steering(self._may_steer(session, self._machine.snapshot), self._model)
        viewer.hold(self._model)

    async def _on_disconnect(self, client: ClientHandle) -> None:
        viewer = self._viewers.pop(client.client_id, None)
        if viewer is not None:
            viewer.leave()

    def _computed(self, reply: Reply) -> None:
        """From the workers' threads."""
        self._soon(self._show_computed, reply)

    def _show_computed(self, reply: Reply) -> None:
        number, topic = reply.key
        viewer = self._viewers.get(number)
        if viewer is not None:
            viewer.reach.take(topic, reply.picture)

    def _apply_theme(self, session: str) -> None:
        for viewer in self._viewers.values():
            if viewer.session == session:
                viewer.apply_theme()

    def _show_note(self, session: str, text: str) -> None:
        self._notes[session] = time.monotonic() + _NOTE_LIFE
        for viewer in self._viewers.values():
            if viewer.session == session:
                viewer.tell(text)

    def _post(self, session: str, intent: Intent) -> None:
        def answered(future: Future[Answer]) -> None:
            if not future.cancelled() and isinstance(answer := future.result(), Refused):
                self.tell(session, answer.detail)

        self._machine.post(intent).add_done_callback(answered)
