"""The five-bar, chosen on the page, and a robot whose tool turns, in a real browser."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Page

pytestmark = pytest.mark.browser

TOOL_AXIS = Path(__file__).parents[2] / "docs" / "examples" / "stm32-tool.toml"
LONG = 120_000  # ms
CLOSE = 0.4  # mm: one microstep of each joint


@pytest.fixture
def served(served_on: Any) -> Any:
    return served_on


@pytest.fixture
def five_bar(console: Page, served: Any) -> Page:
    """The page on which a person has chosen the five-bar."""
    console.locator("header select").select_option("fivebar")
    served.wait(lambda s: s["robot"] == "fivebar" and s["mode"] == "idle", "the five-bar at rest")
    console.get_by_role("button", name="X− and Z+").wait_for(timeout=LONG)
    console.wait_for_function(  # two angles, X and Z
        """() => [...document.querySelector("#scene").contentDocument
            .querySelectorAll("[role=slider]")].filter((s) => s.checkVisibility()).length === 4""",
        timeout=LONG,
    )
    return console


def test_it_is_dragged_in_its_plane_and_the_reported_pose_follows(
    five_bar: Page, served: Any, drag: Callable[..., None]
) -> None:
    before = served.state()["xyz_mm"]
    drag(
        60,
        40,
        lambda s: (
            s["xyz_mm"][0] > before[0] + 10
            and s["xyz_mm"][2] < before[2] - 5
            and math.dist(s["xyz_mm"], s["target_xyz_mm"]) < CLOSE
            and s["stop_reason"] is None
        ),
    )
    state = served.state()
    assert state["xyz_mm"][1] == 0
    assert len(state["theta_deg"]) == 2
    five_bar.mouse.up()
    served.wait(lambda s: s["mode"] == "idle", "rest after the drag")


def test_it_is_jogged_up_by_a_key_and_by_its_button(
    five_bar: Page, served: Any, hold: Callable[..., None]
) -> None:
    five_bar.locator("#move").get_by_label("X mm").fill("0")
    five_bar.locator("#move").get_by_label("Z mm").fill("-220")
    five_bar.get_by_role("button", name="Go", exact=True).click()
    served.wait(
        lambda s: s["mode"] == "idle" and math.dist(s["xyz_mm"], [0, 0, -220]) < CLOSE,
        "the typed point",
    )
    five_bar.locator("#move-z").blur()
    hold(five_bar, "ArrowUp", lambda s: s["xyz_mm"][2] > -210)
    five_bar.keyboard.up("ArrowUp")
    rest = served.wait(lambda s: s["mode"] == "idle", "rest after the release")
    assert abs(rest["xyz_mm"][0]) < CLOSE


def test_escape_stops_it_in_the_middle_of_a_drag(
    five_bar: Page, served: Any, drag: Callable[..., None]
) -> None:
    drag(-70, 30, lambda s: s["mode"] == "jogging" and s["xyz_mm"][0] < -1)
    five_bar.keyboard.press("Escape")
    stopped = served.wait(lambda s: s["mode"] == "idle", "rest after the stop")
    assert stopped["stop_reason"] == "Stop was pressed"
    five_bar.mouse.move(900, 400, steps=4)  # the pointer is still down
    later = served.wait(lambda s: s["board_time_s"] > stopped["board_time_s"] + 0.5, "time passing")
    assert (later["mode"], later["xyz_mm"]) == ("idle", stopped["xyz_mm"])


def test_a_page_that_is_closed_in_the_middle_of_a_drag(
    five_bar: Page, served: Any, drag: Callable[..., None]
) -> None:
    drag(60, -20, lambda s: s["mode"] == "jogging" and s["xyz_mm"][0] > 1)
    five_bar.context.close()
    rest = served.wait(lambda s: s["mode"] == "idle", "rest")
    later = served.wait(lambda s: s["board_time_s"] > rest["board_time_s"] + 0.3, "time passing")
    assert later["xyz_mm"] == rest["xyz_mm"]


class TestTurningTool:
    @pytest.fixture
    def served(self, serve: Callable[..., Any]) -> Any:
        return serve("--robot", str(TOOL_AXIS))

    def test_a_held_key_turns_it_and_its_release_stops(
        self,
        console: Page,
        served: Any,
        hold: Callable[..., None],
        wait_for: Callable[..., Any],
    ) -> None:
        before = served.state()
        hold(console, "r", lambda s: s["theta_deg"][3] > 20)
        console.keyboard.up("r")
        rest = served.wait(lambda s: s["mode"] == "idle", "rest after the release")
        assert rest["xyz_mm"] == before["xyz_mm"]
        assert rest["theta_deg"][:3] == before["theta_deg"][:3]
        slider = console.frame_locator("#scene").get_by_role("slider", name="Tool °")
        wait_for(
            lambda: float(slider.get_attribute("aria-valuenow") or "nan"),
            lambda shown: abs(shown - rest["theta_deg"][3]) < 0.1,
            "the slider where the tool is",
        )
        slider.focus()
        for _ in range(5):
            console.keyboard.press("ArrowLeft")
        served.wait(
            lambda s: s["mode"] == "idle" and s["theta_deg"][3] < rest["theta_deg"][3] - 0.2,
            "the slider's angle",
        )

    def test_a_page_that_is_closed_while_it_turns(
        self, console: Page, served: Any, hold: Callable[..., None]
    ) -> None:
        hold(console, "r", lambda s: s["mode"] == "jogging" and s["theta_deg"][3] > 5)
        console.context.close()
        rest = served.wait(lambda s: s["mode"] == "idle", "rest")
        later = served.wait(
            lambda s: s["board_time_s"] > rest["board_time_s"] + 0.3, "time passing"
        )
        assert later["theta_deg"] == rest["theta_deg"]
