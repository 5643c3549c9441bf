"""What a person does on the first day, in a real browser in front of the real program."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import pytest
from playwright.sync_api import Locator, Page

pytestmark = pytest.mark.browser

LONG = 120_000  # ms; software rendering is slow
TRIES = 12  # of a press that the page may break off by itself
CLOSE = 0.4  # mm: one microstep of each of the three joints


@pytest.fixture
def served(served_on: Any) -> Any:
    return served_on


def slider(page: Page, name: str) -> Locator:
    return page.frame_locator("#scene").get_by_role("slider", name=name)


def test_dragging_the_effector_moves_the_reported_robot(
    console: Page, served: Any, drag: Callable[..., None]
) -> None:
    before = served.state()["xyz_mm"]
    drag(
        90,
        0,
        lambda s: (
            math.dist(s["xyz_mm"], before) > 20
            and math.dist(s["xyz_mm"], s["target_xyz_mm"]) < CLOSE
            and s["stop_reason"] is None
        ),
    )
    moved = served.state()
    assert moved["xyz_mm"][2] == pytest.approx(before[2], abs=CLOSE)  # over the plane
    assert moved["control"]["holder"] == "another"  # the page's, as this program sees it
    console.mouse.up()
    served.wait(lambda s: s["mode"] == "idle", "rest after the drag")


def test_letting_go_early_still_reaches_the_last_target(
    served: Any, drag: Callable[..., None]
) -> None:
    before = served.state()["xyz_mm"]
    drag(
        -80,
        10,
        lambda s: (
            s["mode"] == "idle"
            and s["stop_reason"] is None
            and math.dist(s["xyz_mm"], before) > 10
            and math.dist(s["xyz_mm"], s["target_xyz_mm"]) < CLOSE
        ),
        let_go=True,
    )


def test_with_shift_the_drag_is_vertical(
    console: Page, served: Any, drag: Callable[..., None]
) -> None:
    before = served.state()["xyz_mm"]
    console.keyboard.down("Shift")
    drag(0, 60, lambda s: s["xyz_mm"][2] < before[2] - 15)
    after = served.state()["xyz_mm"]
    console.mouse.up()
    console.keyboard.up("Shift")
    assert after[:2] == pytest.approx(before[:2], abs=1.0)


def test_an_angle_slider_moves_xyz_and_the_other_way_round(console: Page, served: Any) -> None:
    before = served.state()
    press_right(console, slider(console, "θ1"), times=20)
    after = served.wait(
        lambda s: s["theta_deg"][0] > before["theta_deg"][0] + 1 and s["mode"] == "idle",
        "a turned joint",
    )
    assert math.dist(after["xyz_mm"], before["xyz_mm"]) > 1
    assert after["theta_deg"][1:] == pytest.approx(before["theta_deg"][1:], abs=0.12)
    expect_slider(console, "X mm", after["xyz_mm"][0])

    press_right(console, slider(console, "Z mm"), times=30)
    last = served.wait(
        lambda s: s["xyz_mm"][2] > after["xyz_mm"][2] + 1 and s["mode"] == "idle", "a higher tip"
    )
    assert last["xyz_mm"][:2] == pytest.approx(after["xyz_mm"][:2], abs=CLOSE)
    expect_slider(console, "θ1", last["theta_deg"][0])


def press_right(page: Page, thumb: Locator, *, times: int) -> None:
    thumb.focus()
    for _ in range(times):
        page.keyboard.press("ArrowRight")


def expect_slider(page: Page, name: str, value: float) -> None:
    """The slider comes to stand at the value, to its own resolution."""
    page.wait_for_function(
        """([name, value]) => {
            const page = document.querySelector("#scene").contentDocument;
            const thumbs = [...page.querySelectorAll("[role=slider]")];
            const thumb = thumbs.find((t) => (t.getAttribute("aria-label") ?? "").startsWith(name));
            return Math.abs(Number(thumb?.getAttribute("aria-valuenow")) - value) < 0.11;
        }""",
        arg=[name, value],
        timeout=LONG,
    )


def test_a_held_key_jogs_and_its_release_stops(
    console: Page, served: Any, hold: Callable[..., Any]
) -> None:
    before = served.state()["xyz_mm"]
    rest: dict[str, Any] = {}
    for _ in range(TRIES):
        start = served.state()["xyz_mm"][0]
        hold(console, "ArrowRight", lambda s, start=start: s["xyz_mm"][0] > start + 5)
        console.keyboard.up("ArrowRight")
        rest = served.wait(lambda s: s["mode"] == "idle", "rest after the release")
        if rest["stop_reason"] is None:
            break
    assert rest["stop_reason"] is None  # a release is no stop
    assert rest["xyz_mm"][1:] == pytest.approx(before[1:], abs=CLOSE)


def test_a_held_button_jogs_and_a_jog_key_works_inside_the_scene(
    console: Page, served: Any, hold: Callable[..., Any]
) -> None:
    before = served.state()["xyz_mm"]
    console.get_by_role("button", name="Y+", exact=True).hover()
    moved = False
    for _ in range(TRIES):
        console.mouse.down()
        moved = served.soon(lambda s: s["xyz_mm"][1] > before[1] + 5)
        console.mouse.up()
        if moved:
            break
    assert moved
    served.wait(lambda s: s["mode"] == "idle", "rest after the release")

    scene = console.locator("#scene").bounding_box()
    assert scene is not None
    console.mouse.click(scene["x"] + scene["width"] - 20, scene["y"] + 20)  # focus into the frame
    middle = served.state()["xyz_mm"]
    hold(console, "a", lambda s: s["xyz_mm"][0] < middle[0] - 5)
    console.keyboard.up("a")
    served.wait(lambda s: s["mode"] == "idle", "rest after the release")


def test_go_to_moves_straight_there(console: Page, served: Any) -> None:
    for field, text in (("X mm", "40,5"), ("Y mm", "−20"), ("Z mm", "-310")):
        console.locator("#move").get_by_label(field).fill(text)
    console.get_by_role("button", name="Go", exact=True).click()
    served.wait(
        lambda s: s["mode"] == "idle" and math.dist(s["xyz_mm"], [40.5, -20, -310]) < CLOSE,
        "the typed point",
    )


def test_what_is_out_of_reach_is_said_and_nothing_moves(console: Page, served: Any) -> None:
    before = served.state()["xyz_mm"]
    for field, text in (("X mm", "900"), ("Y mm", "0"), ("Z mm", "-310")):
        console.locator("#move").get_by_label(field).fill(text)
    console.get_by_role("button", name="Go", exact=True).click()
    console.get_by_text("cannot reach").first.wait_for(timeout=LONG)
    assert served.state()["xyz_mm"] == before


def test_another_robot_is_a_choice_away(console: Page, served: Any) -> None:
    console.locator("header select").select_option("zheng2023")
    state = served.wait(
        lambda s: s["robot"] == "zheng2023" and s["mode"] == "idle", "the other robot at rest"
    )
    assert state["xyz_mm"][2] < -500
    expect_slider(console, "Z mm", state["xyz_mm"][2])


def is_sorter(error: object) -> bool:
    """viser's page tries to compile a sorter that nothing here uses; the policy forbids it."""
    return "'unsafe-eval'" in str(error)


def test_nothing_goes_wrong_unseen(page: Page, served: Any) -> None:
    """No error in the browser's console, no request to another host, on a first visit."""
    errors: list[str] = []
    hosts: set[str] = set()
    page.on(
        "console",
        lambda m: errors.append(m.text) if m.type == "error" and not is_sorter(m.text) else None,
    )
    page.on("pageerror", lambda error: errors.append(str(error)) if not is_sorter(error) else None)
    page.on("request", lambda r: hosts.add(r.url.split("/")[2]) if "//" in r.url else None)
    page.goto(served.url)
    slider(page, "θ1").wait_for(timeout=LONG)
    assert errors == []
    assert hosts == {served.url.removeprefix("http://")}
