"""The whole life of `deltaviz serve`: machine, scene and web server, from start to rest."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import os
import signal
import socket
import sys
import threading
import webbrowser
from collections.abc import Callable, Coroutine
from pathlib import Path
from typing import TYPE_CHECKING, Any

from deltaviz.web.listening import ListenError, listen, name_of

if TYPE_CHECKING:  # these load while the machine's process starts
    from deltaviz.machine.client import MachineClient
    from deltaviz.scene.view import Scene
    from deltaviz.web.server import Server

OK, FAILED = 0, 1
FORCED = 128 + signal.SIGINT
CONNECT_PATIENCE = 5.0  # s; loading the compiled kernels takes one, compiling them many more
REST_TIMEOUT = 0.8  # s for the robot to come to rest and its processes to end
LAST_MOMENT = 1.9  # s after the signal; what has not ended by then is left to end by itself
_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class StartError(Exception):
    """Why the server cannot start, for a person."""


def serve(
    *, robot: str, link: str, host: str, port: int, browser: bool, capture: Path | None = None
) -> int:
    """Serve until a signal; the exit status.

    `robot` is a preset's name or a robot file, `link` a URL, `host` a loopback address; port 0
    takes any free one. What passes on the link is added to the file `capture`. Status 1: it could
    not start; 2: such an address is not allowed.
    """
    logging.basicConfig(level=logging.WARNING, format="%(levelname)s %(name)s: %(message)s")
    try:
        listener = listen(host, port)
    except ListenError as error:
        return _say(str(error), status=error.status)
    with contextlib.closing(listener):
        life = _Life(listener, browser=browser)
        try:
            asyncio.run(life.live(robot=robot, link=link, capture=capture))
        except StartError as error:
            return _say(str(error), status=FAILED)
    return OK


class _Life:
    """What runs, and how it ends: the first signal ends it in order, the second at once.

    Ending at once is safe for the robot: its own process brakes when ours is gone.
    """

    def __init__(self, listener: socket.socket, *, browser: bool) -> None:
        self._listener = listener
        self._host, self._port = name_of(listener)
        self._browser = browser
        self._ending = asyncio.Event()
        self._machine: MachineClient | None = None
        self._scene: Scene | None = None

    async def live(self, *, robot: str, link: str, capture: Path | None) -> None:
        loop = asyncio.get_running_loop()
        for number in _SIGNALS:
            loop.add_signal_handler(number, self._end)
        try:
            server = await self._start(robot, link, capture)
            serving = await self._unless_ending(server.serve(sockets=[self._listener]))
            server.should_exit = True
            await serving
        finally:
            await self._close()

    async def _start(self, robot: str, link: str, capture: Path | None) -> Server:
        # Most of the start is loading: the machine's process does its share beside ours.
        starting = asyncio.create_task(asyncio.to_thread(_start_machine, robot, link, capture))
        loading = asyncio.create_task(asyncio.to_thread(_load))
        self._machine = await starting
        await loading
        server = await asyncio.to_thread(self._build, self._machine)
        await self._connected(self._machine)
        return server

    async def _connected(self, machine: MachineClient) -> None:
        """Wait a little, so that the first page shows a robot; without it, it says why not."""
        await self._unless_ending(asyncio.to_thread(machine.ready, CONNECT_PATIENCE))

    async def _unless_ending(self, what: Coroutine[Any, Any, Any]) -> asyncio.Task[Any]:
        """Wait until this is done, or we are told to end."""
        task = asyncio.create_task(what)
        ending = asyncio.create_task(self._ending.wait())
        await asyncio.wait((task, ending), return_when=asyncio.FIRST_COMPLETED)
        ending.cancel()
        return task

    def _build(self, machine: MachineClient) -> Server:
        from deltaviz.scene.listener import ListenerOpenError
        from deltaviz.scene.page import PageFormatError
        from deltaviz.scene.view import Scene
        from deltaviz.web.app import create_app
        from deltaviz.web.origin import allowed_hosts
        from deltaviz.web.server import Server
        from deltaviz.web.static_files import static_dir

        scene = Scene(machine)
        try:
            folder = static_dir()
            scene.start()
        except (FileNotFoundError, ListenerOpenError, PageFormatError) as error:
            raise StartError(str(error)) from None
        self._scene = scene
        app = create_app(
            machine=machine,
            scene=scene,
            allowed_hosts=allowed_hosts(self._host, self._port),
            port=self._port,
            static_dir=folder,
        )
        return Server(app, started_up=self._tell)

    def _tell(self) -> None:
        url = f"http://{self._host}:{self._port}"
        print(f"deltaviz is at {url} (Ctrl-C ends it)", flush=True)
        problem = None if self._machine is None else self._machine.snapshot.link.problem
        if problem is not None:
            print(f"deltaviz: {problem}", file=sys.stderr, flush=True)
        if self._browser and _has_desktop():
            threading.Thread(target=webbrowser.open, args=(url,), daemon=True).start()

    def _end(self) -> None:
        if self._ending.is_set():
            os._exit(FORCED)
        if self._machine is not None:
            self._machine.stop("server", "deltaviz was told to end")
        self._ending.set()
        last_moment = threading.Timer(LAST_MOMENT, os._exit, (FAILED,))
        last_moment.daemon = True
        last_moment.start()

    async def _close(self) -> None:
        endings: list[Callable[[], None]] = []
        if (machine := self._machine) is not None:
            endings.append(lambda: machine.close(timeout=REST_TIMEOUT))
        if self._scene is not None:
            endings.append(self._scene.close)
        await asyncio.gather(*(asyncio.to_thread(ending) for ending in endings))


def _start_machine(robot: str, link: str, capture: Path | None) -> MachineClient:
    from deltaviz.link.capture.reader import CaptureError
    from deltaviz.link.urls import LinkError
    from deltaviz.machine.client import MachineClient
    from deltaviz.robots import RobotFileError

    try:
        return MachineClient.start(robot=robot, link=link, capture=capture)
    except (LinkError, RobotFileError, CaptureError) as error:
        raise StartError(str(error)) from None


def _load() -> None:
    """Import what takes long, so that building finds it there."""
    import deltaviz.scene.view
    import deltaviz.web.app
    import deltaviz.web.server  # noqa: F401


def _has_desktop() -> bool:
    """Without one, `webbrowser` would start a text browser in this very terminal."""
    if sys.platform != "linux" or "BROWSER" in os.environ:
        return True
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


def _say(text: str, *, status: int) -> int:
    print(f"deltaviz: {text}", file=sys.stderr)
    return status
