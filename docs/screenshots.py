"""Takes the pictures in the docs from the running program: python docs/screenshots.py [NAME ..]"""

from __future__ import annotations

import json
import re
import subprocess
import sys
import time
import urllib.request
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

from playwright.sync_api import Browser, Page, sync_playwright

DOCS = Path(__file__).parent
SIZES = {"1280x800": (1280, 800), "390x844": (390, 844)}
THEMES: tuple[Literal["light", "dark"], ...] = ("light", "dark")
# Each picture's name, its robot, and the way (mm) that is drawn as a trail.
PICTURES: dict[str, tuple[str, list[tuple[float, float, float]]]] = {
    "console": (
        "stm32",
        [(x, y, -320) for x, y in [(70, 30), (20, 80), (-60, 40), (-30, -50), (60, -30), (90, 20)]],
    ),
    "fivebar": ("fivebar", [(60, 0, -150), (80, 0, -190), (-70, 0, -210), (-50, 0, -170)]),
    "workspace": ("stm32", []),
    "workspace-paper": ("deltadraw", []),
    "fivebar-workspace": ("fivebar", []),
}


@dataclass(frozen=True)
class Shown:
    """What is chosen in the console's view before a picture is taken."""

    layers: tuple[str, ...]
    colours: str = "One colour"
    thing: str = "None"  # that lies in the scene
    told: str = "drawn within"  # what the view tells when all is there


SHOWN = {
    "workspace": Shown(("Reach", "Section X", "Section Z"), "Conditioning"),
    "workspace-paper": Shown(
        ("Reach", "Largest cylinder"), thing="Letter paper", told="Largest cylinder"
    ),
    "fivebar-workspace": Shown(("Reach", "Coloured plane"), "Conditioning"),
}
PENDANT = "390x844"  # where the scene has no panel
FLAGS = [
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist",
]
LONG = 60_000  # ms


def main() -> None:
    for picture in sys.argv[1:] or PICTURES:
        take_all(picture, *PICTURES[picture])


def take_all(picture: str, robot: str, way: list[tuple[float, float, float]]) -> None:
    command = [sys.executable, "-m", "deltaviz", "serve", "--port", "0", "--no-browser"]
    command += ["--robot", robot]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server:
        assert server.stdout is not None
        url = next(
            found[0] for line in server.stdout if (found := re.search(r"http://[\d.:]+", line))
        )
        try:
            with sync_playwright() as playwright:
                browser = playwright.chromium.launch(
                    executable_path="/usr/bin/chromium", args=FLAGS
                )
                for theme in THEMES:
                    for name, size in SIZES.items():
                        take(
                            browser, url, theme, size, way, picture, f"{picture}-{name}-{theme}.png"
                        )
        finally:
            server.terminate()


def take(
    browser: Browser,
    url: str,
    theme: Literal["light", "dark"],
    size: tuple[int, int],
    way: list[tuple[float, float, float]],
    picture: str,
    name: str,
) -> None:
    context = browser.new_context(
        viewport={"width": size[0], "height": size[1]}, color_scheme=theme
    )
    page = context.new_page()
    page.goto(url)
    page.locator("#mode", has_text="Idle").wait_for(timeout=LONG)
    page.frame_locator("#scene").locator("canvas").first.wait_for(timeout=LONG)
    for place in way:
        go(page, url, place)
    if shown := SHOWN.get(picture):
        show(page, shown, wide=size != SIZES[PENDANT])
    page.wait_for_timeout(9000)  # for the pictures only: drawing catches up, notices go
    page.screenshot(path=DOCS / name)
    context.close()


def show(page: Page, shown: Shown, *, wide: bool) -> None:
    opener = page.locator("#view-toggle" if wide else ".tabs [data-view=view]")
    opener.click()
    view = page.locator("#view")
    for layer in shown.layers:
        view.get_by_label(layer, exact=True).check(timeout=LONG)
    view.get_by_label("Colours").select_option(shown.colours)
    if view.get_by_label("Object").count():
        view.get_by_label("Object").select_option(shown.thing)
    told = view.locator(".told", has_text=shown.told)
    told.wait_for(timeout=LONG)
    told.scroll_into_view_if_needed()
    if wide:  # the same in the scene's own panel
        opener.click()
        for folder in ("Angles", "Position", "Robot", "Workspace"):  # the last one is opened
            page.frame_locator("#scene").get_by_text(folder, exact=True).first.click()


def go(page: Page, url: str, place: tuple[float, float, float]) -> None:
    """Move there from the page, so that it is the page that controls."""
    page.evaluate(
        """async (xyz_mm) => fetch("/api/move", {method: "POST",
            headers: {"content-type": "application/json"},
            body: JSON.stringify({xyz_mm, speed: 0.5})})""",
        list(place),
    )
    state: dict[str, Any] = {}
    end = time.monotonic() + 30
    while time.monotonic() < end:
        with urllib.request.urlopen(f"{url}/api/state") as reply:
            state = json.load(reply)
        if state["mode"] == "idle" and abs(state["xyz_mm"][0] - place[0]) < 1:
            return
        time.sleep(0.02)
    raise SystemExit(f"the robot did not arrive: {state}")


if __name__ == "__main__":
    main()
