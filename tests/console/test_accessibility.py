"""axe finds nothing wrong with the console. viser's frame is not ours and is left out."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Page

pytestmark = pytest.mark.browser

STATES: dict[str, dict[str, Any]] = {
    "idle": {},
    "fault": {"mode": "fault", "fault": "Limit switch of arm 2", "homed": False},
    "watching": {"control": {"holder": "another", "you": False}},
}


@pytest.mark.parametrize("theme", ["light", "dark"])
@pytest.mark.parametrize("state", STATES)
@pytest.mark.parametrize("size", [(1280, 800), (390, 844)])
def test_axe_finds_nothing(
    open_page: Callable[..., Page], machine: Any, size: tuple[int, int], theme: str, state: str
) -> None:
    machine.set(**STATES[state])
    page = open_page(*size, color_scheme=theme, reduced_motion="reduce")
    page.wait_for_timeout(100)
    tabs = (
        ["#setup-toggle", "#view-toggle"]
        if size[0] > 720
        else [f".tabs [data-view={view}]" for view in ("pose", "setup", "view")]
    )
    for click in [None, *tabs]:
        if click is not None:
            page.locator(click).click()
        found = Axe().run(page, context={"exclude": [["#scene"]]}).response["violations"]
        assert [(v["id"], [n["html"][:100] for n in v["nodes"]]) for v in found] == []


@pytest.mark.parametrize("shape", ["planar", "tool"])
def test_axe_finds_nothing_with_other_robots(
    open_page: Callable[..., Page], machine: Any, shape: str
) -> None:
    machine.become(shape)
    page = open_page(390, 844, reduced_motion="reduce")
    for click in (None, "[data-frame=joints]", ".tabs [data-view=pose]"):
        if click is not None:
            page.locator(click).click()
        found = Axe().run(page, context={"exclude": [["#scene"]]}).response["violations"]
        assert [(v["id"], [n["html"][:100] for n in v["nodes"]]) for v in found] == []


def test_focus_can_be_seen(open_page: Callable[..., Page]) -> None:
    page = open_page()
    page.keyboard.press("Tab")
    width = page.evaluate("getComputedStyle(document.activeElement).outlineWidth")
    assert width == "3px"
