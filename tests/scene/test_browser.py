"""viser's page in a real browser, through our gateway."""

from __future__ import annotations

import itertools
import json
import re
import threading
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Browser, BrowserContext, Locator, Page
from websockets.sync.server import serve

from deltaviz.machine.intent import DragEnd, DragStart, DragTo, FollowAngles
from deltaviz.scene.drag import eye_of

pytestmark = [pytest.mark.browser, pytest.mark.xdist_group("scene-browser")]

PATIENCE = 90_000  # ms; a software renderer on a busy machine


@pytest.fixture
def context(browser: Browser, stand: Any) -> Iterator[BrowserContext]:
    context = browser.new_context(viewport={"width": 740, "height": 520})
    context.set_default_timeout(PATIENCE)
    context.add_cookies([{"name": "session", "value": "anna", "domain": "127.0.0.1", "path": "/"}])
    yield context
    context.close()


@pytest.fixture
def page(context: BrowserContext, stand: Any) -> Page:
    """The scene, open, with its sliders and its camera at rest."""
    page = context.new_page()
    page.goto(stand.url)
    page.get_by_text("Angles").wait_for()
    stand.eventually(lambda: stand.server.get_clients())
    page.wait_for_function(
        "() => [...document.querySelectorAll('canvas')].some(c => c.clientWidth < 600)"
    )
    at_rest(page, stand)
    return page


def the_client(stand: Any) -> Any:
    (client,) = stand.server.get_clients().values()
    return client


def at_rest(page: Page, stand: Any) -> None:
    """Wait until the camera that the server knows is that of the picture."""

    def fits() -> bool:
        page.wait_for_timeout(50)
        canvas, camera = picture(page), the_client(stand).camera
        framed = np.allclose(camera.position, stand.server.initial_camera.position, atol=1e-3)
        return framed and abs(camera.aspect - canvas["width"] / canvas["height"]) < 0.01

    stand.eventually(fits)


def picture(page: Page) -> dict[str, float]:
    """The canvas that shows the robot."""
    return page.evaluate(
        """() => {
            const all = [...document.querySelectorAll('canvas')];
            const areas = all.map(c => c.getBoundingClientRect());
            const r = areas.sort((a, b) => b.width * b.height - a.width * a.height)[0];
            return {x: r.x, y: r.y, width: r.width, height: r.height};
        }"""
    )


def on_screen(page: Page, stand: Any, mm: tuple[float, ...]) -> tuple[float, float]:
    u, v = eye_of(the_client(stand).camera).project(np.asarray(mm) / 1000.0)
    canvas = picture(page)
    return canvas["x"] + u * canvas["width"], canvas["y"] + v * canvas["height"]


def hover(page: Page, stand: Any, x: float, y: float) -> None:
    """Move the pointer onto something that the page offers to drag."""
    jitter = itertools.cycle((0.0, 1.0))

    def offered() -> bool:
        page.mouse.move(x + next(jitter), y)
        page.wait_for_timeout(50)
        return page.evaluate(
            "() => [...document.querySelectorAll('canvas')].some(c => c.style.cursor == 'pointer')"
        )

    stand.eventually(offered)
    page.mouse.move(x, y)


@pytest.mark.parametrize("shift", [False, True])
def test_what_was_grabbed_stays_under_the_pointer(page: Page, stand: Any, shift: bool) -> None:
    """Judged by the browser's own projection of the grabbed place, which viser sends along."""
    seen: list[Any] = []

    async def record(event: Any) -> None:
        seen.append(event)

    handle = the_client(stand).scene.get_handle_by_name("/robot/effector/handle")
    for target in (stand.scene._model.effector, handle):
        target.on_drag("left", modifier="shift" if shift else None)(record)
    x, y = on_screen(page, stand, stand.machine.snapshot.xyz)
    dx, dy = (0.0, -30.0) if shift else (50.0, 15.0)
    hover(page, stand, x, y)
    if shift:
        page.keyboard.down("Shift")
    page.mouse.down()
    page.mouse.move(x + dx, y + dy, steps=6)
    stand.eventually(lambda: stand.machine.of(DragTo))
    size = np.array((picture(page)["width"], picture(page)["height"]))
    jitter = itertools.cycle((1, 0))

    def miss() -> float:
        """How far from the pointer (px) the picture shows the place that was grabbed."""
        page.mouse.move(x + dx + next(jitter), y + dy)
        page.wait_for_timeout(100)
        apart = np.subtract(seen[-1].start_screen_pos, seen[-1].end_screen_pos)
        return float(np.abs(apart * size).max())

    stand.eventually(lambda: miss() <= 3.0)
    page.mouse.up()
    if shift:
        page.keyboard.up("Shift")
    stand.eventually(lambda: stand.machine.of(DragEnd))
    start, last = stand.machine.of(DragStart), stand.machine.of(DragTo)[-1]
    assert [intent.client for intent in start] == ["anna"]
    moved = np.subtract(last.xyz, (0.0, 0.0, sum(stand.machine.robot.zone.z) / 2))
    assert abs(moved[2]) < 1e-6 if not shift else np.abs(moved[:2]).max() < 1e-6
    assert np.linalg.norm(moved) > 20.0


def test_a_slider_posts_angles_and_the_others_follow(page: Page, stand: Any) -> None:
    slider = page.get_by_role("slider").nth(0)
    slider.focus()
    for _ in range(5):
        page.keyboard.press("ArrowRight")
        page.wait_for_timeout(80)
    intent = stand.eventually(lambda: stand.machine.of(FollowAngles))[-1]
    assert intent.client == "anna"
    z_before = sum(stand.machine.robot.zone.z) / 2
    box = page.get_by_role("textbox")
    stand.eventually(
        lambda: (page.wait_for_timeout(50), float(box.nth(5).input_value()) != z_before)[1]
    )
    assert float(box.nth(5).input_value()) == pytest.approx(stand.machine.snapshot.xyz[2], abs=0.2)


def look(page: Page) -> bytes:
    """The picture, when it is still."""
    last = b""
    canvas: Any = picture(page)
    while (now := page.screenshot(clip=canvas)) != last:
        last = now
        page.wait_for_timeout(400)
    return last


def other_than(before: bytes, page: Page) -> bytes:
    """The picture, still again, when it has changed."""
    for _ in range(100):
        if (now := look(page)) != before:
            return now
    raise AssertionError("the picture stayed as it was")


def test_the_workspace_is_shown_and_cut_and_nothing_moves(page: Page, stand: Any) -> None:
    page.get_by_text("Angles", exact=True).click()
    page.get_by_text("Position", exact=True).click()
    page.get_by_text("Workspace", exact=True).click()
    bare = look(page)
    page.get_by_label("Reach", exact=True).check()
    page.get_by_text("drawn within").wait_for()
    with_boundary = look(page)
    page.get_by_label("Section Z", exact=True).check()
    cut = other_than(with_boundary, page)
    row = page.locator(".mantine-Flex-root:has(> div label)", has_text="mm along Z").last
    row.get_by_role("slider").focus()
    for _ in range(3):
        page.keyboard.press("PageDown")
        page.keyboard.press("ArrowLeft")
    moved = other_than(cut, page)
    assert len({bare, with_boundary, cut, moved}) == 4
    assert stand.machine.posted == []


def told_of(page: Page, pattern: str) -> tuple[float, ...]:
    """The numbers in the first text of the panel that matches, when there is one."""
    page.locator("body", has_text=re.compile(pattern)).wait_for()
    found = re.search(pattern, page.locator("body").inner_text())
    assert found is not None
    return tuple(map(float, found.groups()))


NUMBER = r"(-?[0-9.]+)"
TIP = rf"X {NUMBER}\s+Y {NUMBER}\s+Z {NUMBER}"
ANGLES = rf"θ1 {NUMBER}°\s+θ2 {NUMBER}°\s+θ3 {NUMBER}°"


def test_a_click_probes_a_point_of_the_paper_and_a_drag_does_not(page: Page, stand: Any) -> None:
    page.set_viewport_size({"width": 740, "height": 760})  # a panel that need not be scrolled
    at_rest(page, stand)
    for folder in ("Angles", "Position", "Robot", "Workspace"):
        page.get_by_text(folder, exact=True).click()
    page.get_by_label("Object", exact=True).click()
    page.get_by_role("option", name="A4 paper", exact=True).click()
    (level,) = told_of(page, rf"A4 paper at Z {NUMBER} mm: fits")
    page.get_by_label("Probe", exact=True).check()
    page.get_by_text("or type X Y Z in mm").wait_for()
    page.mouse.click(*on_screen(page, stand, (60.0, -70.0, level)))
    angles, tip = np.radians(told_of(page, ANGLES)), told_of(page, TIP)
    assert tip == pytest.approx((60.0, -70.0, level), abs=3.0)  # a pixel or two
    # The arms' loops close: from each elbow to its joint on the effector it is a forearm.
    for angle, azimuth in zip(angles, np.radians((0, 120, 240)), strict=True):
        outward = np.array((np.cos(azimuth), np.sin(azimuth), 0.0))
        elbow = (115 + 125 * np.cos(angle)) * outward - (0, 0, 125 * np.sin(angle))
        assert np.linalg.norm(tip + 75 * outward - elbow) == pytest.approx(338, abs=0.15)
    assert stand.machine.posted == []
    x, y = on_screen(page, stand, stand.machine.snapshot.xyz)
    hover(page, stand, x, y)
    page.mouse.down()
    page.mouse.move(x + 30, y, steps=6)
    stand.eventually(lambda: stand.machine.of(DragTo))
    page.mouse.up()
    stand.eventually(lambda: stand.machine.of(DragEnd))
    eye = np.array(the_client(stand).camera.position)
    corner = picture(page)
    page.mouse.move(corner["x"] + 30, corner["y"] + 30)
    page.mouse.down()
    page.mouse.move(corner["x"] + 90, corner["y"] + 30, steps=6)
    page.mouse.up()
    stand.eventually(lambda: np.linalg.norm(the_client(stand).camera.position - eye) > 0.02)
    assert told_of(page, TIP) == tip
    row = page.locator(".mantine-Flex-root:has(> div label)", has_text="Point").last
    row.get_by_role("textbox").fill("0 0 -700")
    page.get_by_text("Arm 2 cannot reach it").wait_for()


def test_a_section_is_dragged_along_its_axis_and_the_robot_stays(page: Page, stand: Any) -> None:
    page.get_by_text("Angles", exact=True).click()
    page.get_by_text("Position", exact=True).click()
    page.get_by_text("Workspace", exact=True).click()
    page.get_by_label("Section Z", exact=True).check()
    scene = the_client(stand).scene
    grip = stand.eventually(lambda: scene.get_handle_by_name("/reach/grip_z"))

    tips = grip.vertices[grip.vertices[:, 2] == grip.vertices[:, 2].max()]
    tip = max(tips, key=lambda tip: tip[0] - tip[1]) * 1000.0  # of the arrow in front

    def arrow() -> tuple[float, float]:
        x, y, z = tip * (1.0, 1.0, 0.7)
        return on_screen(page, stand, (x, y, z + grip.position[2] * 1000.0))

    level = page.locator(".mantine-Flex-root:has(> div label)", has_text="mm along Z").last
    box = level.get_by_role("textbox")
    before, shown = float(box.input_value()), look(page)
    x, y = arrow()
    hover(page, stand, x, y)
    page.mouse.down()
    page.mouse.move(x, y + 50, steps=6)
    jitter = itertools.cycle((0, 1))

    def under_the_pointer() -> bool:
        page.mouse.move(x + next(jitter), y + 50)
        page.wait_for_timeout(100)
        return abs(arrow()[1] - (y + 50)) < 4.0

    stand.eventually(under_the_pointer)
    page.mouse.up()
    page.mouse.move(5, 5)
    stand.eventually(lambda: float(box.input_value()) == pytest.approx(grip.position[2] * 1000))
    assert float(box.input_value()) < before - 20.0
    assert other_than(shown, page) != shown
    eye = the_client(stand).camera.position
    page.mouse.move(x, 100)
    page.mouse.down()
    page.mouse.move(x - 60, 100, steps=4)
    page.mouse.up()
    stand.eventually(lambda: not np.allclose(the_client(stand).camera.position, eye, atol=1e-3))
    assert stand.machine.posted == []


def test_a_length_is_dragged_and_the_reach_follows_and_nothing_moves(
    page: Page, stand: Any
) -> None:
    for folder in ("Angles", "Position", "Workspace", "Geometry"):
        page.mouse.click(*at_a_standstill(page.get_by_text(folder, exact=True)))
    row = page.locator(".mantine-Flex-root:has(> div label)", has_text="Forearm").last
    thumb = row.get_by_role("slider")
    x, y = at_a_standstill(thumb)
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 12, y, steps=6)
    page.get_by_text("more than stm32").wait_for()  # while it is held
    page.mouse.move(x - 12, y, steps=6)
    page.get_by_text("less than stm32").wait_for()
    page.mouse.up()
    page.get_by_text("drawn within").wait_for()
    assert stand.machine.posted == []


def at_a_standstill(thing: Locator) -> tuple[float, float]:
    """The middle of what has stopped to slide, scrolled into view."""
    before = None
    while True:
        thing.scroll_into_view_if_needed()
        if (box := thing.bounding_box()) is not None and box == before:
            return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
        before = box
        thing.page.wait_for_timeout(100)


def test_a_browser_that_goes_ends_its_drag(page: Page, stand: Any) -> None:
    x, y = on_screen(page, stand, stand.machine.snapshot.xyz)
    hover(page, stand, x, y)
    page.mouse.down()
    page.mouse.move(x + 40, y, steps=6)
    stand.eventually(lambda: stand.machine.of(DragTo))
    page.close()
    stand.eventually(lambda: stand.machine.of(DragEnd))


@pytest.mark.parametrize(
    "attack", ["?websocket=ws://127.0.0.1:{port}", "?playbackPath=/evil.viser"]
)
def test_a_source_in_the_address_runs_nothing(
    context: BrowserContext, stand: Any, attack: str
) -> None:
    """Both ran a message's script in our origin before the page was guarded."""
    asked: list[str] = []

    def elsewhere(connection: Any) -> None:
        asked.append("websocket")
        connection.close()

    with serve(elsewhere, "127.0.0.1", 0, subprotocols=["viser-v1.1.1"]) as server:  # type: ignore[list-item]
        threading.Thread(target=server.serve_forever, daemon=True).start()
        port = server.socket.getsockname()[1]
        page = context.new_page()
        page.on("request", lambda request: asked.append(request.url))
        page.goto(stand.url + attack.format(port=port))
        page.get_by_text("Angles").wait_for()
        address = page.evaluate("location.href")  # viser adds its own server to it
        assert str(port) not in address
        assert "playbackPath" not in address
    assert "websocket" not in asked
    assert not [url for url in asked if "evil" in url and "?" not in url]


def test_even_viser_itself_cannot_run_a_script_in_our_page(page: Page, stand: Any) -> None:
    import viser._messages as messages

    the_client(stand)._websock_connection.queue_message(
        messages.RunJavascriptMessage("globalThis.owned = 1")
    )
    stand.machine.be_at((5.0, 0.0, -330.0))
    page.wait_for_timeout(500)
    assert page.evaluate("typeof globalThis.owned") == "undefined"
    # nor can markup that gets into the panel
    the_client(stand).gui.add_html("<img src=x onerror='globalThis.owned=1'>")
    page.wait_for_timeout(500)
    assert page.evaluate("typeof globalThis.owned") == "undefined"


def test_nothing_is_loaded_from_elsewhere(context: BrowserContext, stand: Any) -> None:
    page = context.new_page()
    urls: list[str] = []
    page.on("request", lambda request: urls.append(request.url))
    page.goto(stand.url)
    page.get_by_text("Angles").wait_for()
    strange = [u for u in urls if not u.startswith((stand.url, "data:", "blob:"))]
    assert json.dumps(strange) == "[]"
