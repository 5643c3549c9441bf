"""Nothing overlaps, is cut off, or scrolls sideways, at any of the sizes that count."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from playwright.sync_api import Page

pytestmark = pytest.mark.browser

SIZES = [(1280, 800), (390, 844), (390, 664), (844, 390)]
LONG_FAULT = (
    "Homing of arm 2 failed: its switch did not open within 170 degrees of travel. "
    "Check its wire, its plug and its lever now."
)
assert len(LONG_FAULT) >= 120

COVERED = """() => {
  const found = [];
  for (const control of document.querySelectorAll("button, select, input, iframe")) {
    if (!control.checkVisibility({visibilityProperty: true})) continue;
    control.scrollIntoView({block: "nearest"});
    const box = control.getBoundingClientRect();
    const x = box.x + box.width / 2, y = box.y + box.height / 2;
    const hit = document.elementFromPoint(x, y);
    if (!control.contains(hit))
      found.push(`${control.outerHTML.slice(0, 80)} under ${hit?.outerHTML.slice(0, 60)}`);
    if (box.x < 0 || box.right > innerWidth + 0.5)
      found.push(`${control.outerHTML.slice(0, 80)} leaves the page`);
  }
  return found;
}"""
SIDEWAYS = """() => [...document.querySelectorAll("*")]
  .filter((e) => e.checkVisibility() && e.scrollWidth > e.clientWidth + 1
    && getComputedStyle(e).display !== "inline" && !e.matches(".unseen, input, select"))
  .map((e) => `${e.tagName}#${e.id}.${e.className} ${e.scrollWidth} > ${e.clientWidth}`)"""
SCROLLS = """() => [...document.querySelectorAll("*")]
  .filter((e) => e.checkVisibility() && e.scrollHeight > e.clientHeight + 1
    && getComputedStyle(e).overflowY !== "visible" && !e.matches(".unseen, input, select"))
  .map((e) => `${e.tagName}#${e.id}.${e.className} ${e.scrollHeight} > ${e.clientHeight}`)"""


def views(width: int, height: int) -> list[str]:
    """What to click, one after another, to see all of the console."""
    if width >= 720 and height >= 560:
        return ["[data-frame=joints]", "[data-frame=camera]", "#setup-toggle", "#view-toggle"]
    tabs = [f".tabs [data-view={view}]" for view in ("pose", "view", "setup", "jog")]
    return [*tabs, "[data-frame=joints]", "[data-frame=camera]"]


def check_everywhere(page: Page, size: tuple[int, int]) -> None:
    for click in [None, *views(*size)]:
        if click is not None:
            page.locator(click).click()
            page.evaluate("new Promise(requestAnimationFrame)")
        assert page.evaluate(COVERED) == [], click
        assert page.evaluate(SIDEWAYS) == [], click


@pytest.mark.parametrize("shape", ["planar", "tool"])
@pytest.mark.parametrize("text", ["100%", "200%"])
@pytest.mark.parametrize("size", SIZES)
def test_every_control_of_other_robots_can_be_reached(
    open_page: Callable[..., Page], machine: Any, size: tuple[int, int], text: str, shape: str
) -> None:
    machine.become(shape)
    page = open_page(*size)
    page.evaluate(f"document.documentElement.style.fontSize = '{text}'")
    check_everywhere(page, size)


@pytest.mark.parametrize("theme", ["light", "dark"])
@pytest.mark.parametrize("size", SIZES)
def test_every_control_can_be_reached(
    open_page: Callable[..., Page], machine: Any, size: tuple[int, int], theme: str
) -> None:
    machine.set(mode="fault", fault=LONG_FAULT)
    page = open_page(*size, color_scheme=theme)
    page.get_by_text("Check its wire").wait_for()
    check_everywhere(page, size)


@pytest.mark.parametrize("size", SIZES)
def test_text_of_twice_the_size_hides_nothing(
    open_page: Callable[..., Page], machine: Any, size: tuple[int, int]
) -> None:
    machine.set(mode="fault", fault=LONG_FAULT)
    page = open_page(*size)
    page.evaluate("document.documentElement.style.fontSize = '200%'")
    check_everywhere(page, size)


@pytest.mark.parametrize("size", SIZES)
def test_a_browser_set_to_large_type_hides_nothing(
    open_page: Callable[..., Page], machine: Any, size: tuple[int, int]
) -> None:
    machine.set(mode="fault", fault=LONG_FAULT)
    page = open_page(*size)
    session = page.context.new_cdp_session(page)
    session.send("Page.setFontSizes", {"fontSizes": {"standard": 32}})
    assert page.evaluate("getComputedStyle(document.documentElement).fontSize") == "32px"
    for control in ("#stop", "#estop"):
        assert page.locator(control).is_visible()
    assert page.evaluate(COVERED) == []
    assert page.evaluate(SIDEWAYS) == []


@pytest.mark.parametrize("shape", ["planar", None, "tool"])
@pytest.mark.parametrize("fault", [None, LONG_FAULT])
def test_the_whole_console_fits_a_laptop(
    open_page: Callable[..., Page], machine: Any, shape: str | None, fault: str | None
) -> None:
    if shape is not None:
        machine.become(shape)
    machine.set(fault=fault, mode="fault" if fault else "idle")
    page = open_page(1280, 800)
    for click in [None, *views(1280, 800)]:
        if click is not None:
            page.locator(click).click()
            page.evaluate("new Promise(requestAnimationFrame)")
        scrolls = page.evaluate(SCROLLS)
        if click == "#view-toggle":  # a list as long as the scene's panel: it scrolls by itself
            scrolls = [what for what in scrolls if not what.startswith("DIV#.panels")]
        assert scrolls == [], click
    scene = page.locator("#scene").bounding_box()
    assert scene is not None
    assert scene["width"] >= 648 + 288  # the scene beside viser's own panel


def test_nothing_jumps_when_the_message_grows(open_page: Callable[..., Page], machine: Any) -> None:
    page = open_page(1280, 800)
    before = page.locator("#pad").bounding_box()
    machine.set(mode="fault", fault=LONG_FAULT)
    page.get_by_text("Check its wire").wait_for()
    assert page.locator("#pad").bounding_box() == before


def test_no_column_jumps_when_the_pose_is_not_known(
    open_page: Callable[..., Page], machine: Any
) -> None:
    page = open_page(1280, 800)
    heads = page.locator("thead th")
    before = [head.bounding_box() for head in heads.all()]
    page.locator("#readouts").get_by_text("−301.02").wait_for()
    unknown = ("xyz_mm", "theta_deg", "command_xyz_mm", "command_theta_deg")
    machine.set(**dict.fromkeys(unknown), mode="unhomed", homed=False)
    page.locator("#readouts").get_by_text("−301.02").wait_for(state="detached")
    assert [head.bounding_box() for head in heads.all()] == before


def test_a_long_name_leaves_the_header_in_one_line(
    open_page: Callable[..., Page], machine: Any
) -> None:
    name = "a-robot-with-the-longest-name-that-a-file-of-a-robot-may-give"
    machine.robot["name"] = name
    machine.set(robot=name)
    page = open_page(1280, 800)
    header = page.locator("header").bounding_box()
    assert header is not None
    assert header["height"] < 56


def test_the_open_view_is_marked(open_page: Callable[..., Page]) -> None:
    page = open_page(1280, 800)
    view, setup = page.locator("#view-toggle"), page.locator("#setup-toggle")
    view.click()
    page.mouse.move(600, 400)
    colours = [e.evaluate("e => getComputedStyle(e).backgroundColor") for e in (view, setup)]
    assert colours[0] != colours[1]


def test_buttons_of_a_low_page_are_of_one_height(open_page: Callable[..., Page]) -> None:
    page = open_page(844, 390, has_touch=True, is_mobile=True)
    frames = page.locator("#frames button").first.bounding_box()
    steps = page.locator("#steps button").first.bounding_box()
    assert frames is not None
    assert steps is not None
    assert abs(frames["height"] - steps["height"]) < 4


@pytest.mark.parametrize("size", [(390, 844), (390, 664)])
def test_the_pendant_leaves_room_for_the_scene(
    open_page: Callable[..., Page], size: tuple[int, int]
) -> None:
    page = open_page(*size, has_touch=True, is_mobile=True)
    heights = []
    for view in ("jog", "pose", "view", "setup"):
        page.locator(f".tabs [data-view={view}]").click()
        box = page.locator("#scene").bounding_box()
        assert box is not None
        heights.append(box["height"])
    assert min(heights) >= 200
    assert len(set(heights)) == 1  # the scene keeps its size from view to view


@pytest.mark.parametrize("size", SIZES)
def test_the_stops_stand_apart(open_page: Callable[..., Page], size: tuple[int, int]) -> None:
    page = open_page(*size)
    stop, estop = page.locator("#stop").bounding_box(), page.locator("#estop").bounding_box()
    assert stop is not None
    assert estop is not None
    assert estop["x"] - (stop["x"] + stop["width"]) >= 16


@pytest.mark.parametrize("shape", ["planar", None, "tool"])
@pytest.mark.parametrize("size", SIZES[1:])
def test_jogging_needs_no_scrolling_on_a_phone(
    open_page: Callable[..., Page], machine: Any, size: tuple[int, int], shape: str | None
) -> None:
    if shape is not None:
        machine.become(shape)
    page = open_page(*size, has_touch=True, is_mobile=True)
    for button in page.locator("#jog button, #jog input").all():
        box = button.bounding_box()
        assert box is not None
        assert box["y"] + box["height"] <= size[1]
        assert button.evaluate(
            "(e, [x, y]) => e.contains(document.elementFromPoint(x, y))",
            [box["x"] + box["width"] / 2, box["y"] + box["height"] / 2],
        )
