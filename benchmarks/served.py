"""The whole program inside this process, with real browsers in front, for what is timed inside."""

from __future__ import annotations

import asyncio
import contextlib
import threading
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from playwright.sync_api import Browser, Page, sync_playwright

from deltaviz.machine.client import MachineClient

CHROMIUM = "/usr/bin/chromium"
FLAGS = [
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
]
LONG = 120_000  # ms


@dataclass(frozen=True)
class Served:
    machine: MachineClient
    url: str


@contextlib.contextmanager
def served(
    robot: str = "stm32", *, link: str = "sim://", capture: Path | None = None
) -> Iterator[Served]:
    """Machine, scene and web server, as `deltaviz serve` puts them together."""
    from deltaviz.scene.view import Scene
    from deltaviz.web.app import create_app
    from deltaviz.web.listening import listen
    from deltaviz.web.origin import allowed_hosts
    from deltaviz.web.server import Server
    from deltaviz.web.static_files import static_dir

    with (
        MachineClient.start(robot=robot, link=link, capture=capture) as machine,
        listen("127.0.0.1", 0) as listener,
    ):
        machine.ready(60)
        scene = Scene(machine)
        scene.start()
        port = listener.getsockname()[1]
        app = create_app(
            machine=machine,
            scene=scene,
            allowed_hosts=allowed_hosts("127.0.0.1", port),
            port=port,
            static_dir=static_dir(),
        )
        up = threading.Event()
        server = Server(app, started_up=up.set)
        thread = threading.Thread(target=lambda: asyncio.run(server.serve(sockets=[listener])))
        thread.start()
        up.wait()
        try:
            yield Served(machine, f"http://127.0.0.1:{port}")
        finally:
            server.should_exit = True
            thread.join()
            scene.close()


@contextlib.contextmanager
def chromium() -> Iterator[Browser]:
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        yield browser
        browser.close()


def open_console(browser: Browser, url: str, *, width: int = 1280, height: int = 800) -> Page:
    """A page of its own session, once it has a picture."""
    page = browser.new_context(viewport={"width": width, "height": height}).new_page()
    page.goto(url)
    page.locator("#mode", has_text="Idle").wait_for(timeout=LONG)
    page.frame_locator("#scene").locator("canvas").first.wait_for(timeout=LONG)
    return page
