"""A robot that moves in a plane, and one whose tool turns: what the console offers for each."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from playwright.sync_api import Page, expect

pytestmark = pytest.mark.browser

JOG = 0.25  # share of the limits at which a held jog moves
STEP_MM, TURN_DEG = 600 * JOG, 600 * JOG  # a second: of the tip, and of the tool


@pytest.fixture
def planar(open_page: Callable[..., Page], machine: Any) -> Page:
    machine.become("planar")
    return open_page()


@pytest.fixture
def turning(open_page: Callable[..., Page], machine: Any) -> Page:
    machine.become("tool")
    return open_page()


def names(page: Page) -> list[str]:
    return [str(b.get_attribute("aria-label")) for b in page.locator("#pad button").all()]


@pytest.fixture
def begun(machine: Any, wait_until: Callable[..., Any]) -> Callable[..., dict[str, Any]]:
    """What a press begins, and that its release ends it."""

    def press(down: Callable[[], object], up: Callable[[], object]) -> dict[str, Any]:
        machine.forget()
        down()
        wait_until(lambda: machine.messages("jog_start"))
        up()
        wait_until(lambda: machine.messages("jog_end"))
        (start,) = machine.messages("jog_start")
        return {key: start[key] for key in start if key not in ("type", "id")}

    return press


class TestPlanar:
    def test_the_pad_is_its_plane(self, planar: Page) -> None:
        diagonals = ["X− and Z+", "X+ and Z+", "X− and Z−", "X+ and Z−"]
        assert sorted(names(planar)) == sorted(["X−", "X+", "Z−", "Z+", *diagonals])
        planar.locator("[data-frame=camera]").click()
        planar.get_by_role("button", name="Left and down").wait_for()
        assert {"Left", "Right", "Up", "Down"} < set(names(planar))
        planar.locator("[data-frame=joints]").click()
        planar.get_by_role("button", name="Joint 2 +, down").wait_for()
        assert len(names(planar)) == 4

    @pytest.mark.parametrize(
        ("name", "way"),
        [
            ("X+", [STEP_MM, 0, 0]),
            ("Z+", [0, 0, STEP_MM]),
            ("Z−", [0, 0, -STEP_MM]),
            ("X− and Z+", [-STEP_MM / 2**0.5, 0, STEP_MM / 2**0.5]),
        ],
    )
    def test_its_buttons(self, planar: Page, begun: Any, name: str, way: list[float]) -> None:
        planar.get_by_role("button", name=name, exact=True).hover()
        start = begun(planar.mouse.down, planar.mouse.up)
        assert start == {"frame": "base", "v_mm_s": pytest.approx(way)}

    @pytest.mark.parametrize(
        ("key", "way"),
        [
            ("ArrowLeft", [-STEP_MM, 0, 0]),
            ("ArrowUp", [0, 0, STEP_MM]),
            ("s", [0, 0, -STEP_MM]),
            ("PageUp", [0, 0, STEP_MM]),
            ("e", [0, 0, -STEP_MM]),
        ],
    )
    def test_its_keys(self, planar: Page, begun: Any, key: str, way: list[float]) -> None:
        start = begun(lambda: planar.keyboard.down(key), lambda: planar.keyboard.up(key))
        assert start["v_mm_s"] == pytest.approx(way)

    def test_a_step(self, planar: Page, machine: Any, wait_until: Any) -> None:
        planar.locator("[data-step='1']").click()
        planar.get_by_role("button", name="Z+", exact=True).click()
        wait_until(lambda: machine.posted("jog"))
        assert machine.posted("jog") == [{"xyz_mm": [0, 0, 1]}]

    def test_there_is_no_y_to_be_seen(self, planar: Page) -> None:
        for view in ("#readouts", "#strip", "#move-form", "#sliders", "#pad"):
            for text in planar.locator(view).get_by_text("Y", exact=False).all():
                assert not text.is_visible(), view
        expect(planar.locator("#readouts tr:visible th")).to_have_text(
            ["X mm", "Z mm", "θ1 °", "θ2 °"]
        )

    def test_go_to_asks_for_two_and_sends_three(
        self, planar: Page, machine: Any, wait_until: Any
    ) -> None:
        planar.get_by_label("X mm").first.fill("12,5")
        planar.get_by_role("button", name="Go").click()
        assert planar.get_by_role("alert").inner_text() == "Z is empty."
        planar.locator("#move-z").fill("-200")
        planar.locator("#move-z").press("Enter")
        wait_until(lambda: machine.posted("move"))
        assert machine.posted("move") == [{"xyz_mm": [12.5, 0, -200], "speed": 1}]

    def test_its_sliders(
        self, open_page: Callable[..., Page], machine: Any, wait_until: Any
    ) -> None:
        machine.become("planar")
        page = open_page(390, 844)
        page.locator(".tabs [data-view=pose]").click()
        labels = [label.inner_text() for label in page.locator("#sliders .label").all()]
        assert labels == ["θ1 °", "θ2 °", "X mm", "Z mm"]
        page.get_by_label("Z mm").last.fill("-200")
        wait_until(lambda: machine.posted("move"))
        assert machine.posted("move") == [{"xyz_mm": [5.25, 0, -200], "speed": 1}]


class TestTurningTool:
    @pytest.mark.parametrize(
        ("name", "rate"),
        [("Tool +, counter-clockwise", TURN_DEG), ("Tool −, clockwise", -TURN_DEG)],
    )
    @pytest.mark.parametrize("frame", ["base", "camera", "joints"])
    def test_its_buttons_are_in_every_frame(
        self, turning: Page, begun: Any, frame: str, name: str, rate: float
    ) -> None:
        turning.locator(f"[data-frame={frame}]").click()
        turning.get_by_role("button", name=name).hover()
        start = begun(turning.mouse.down, turning.mouse.up)
        assert start == {"frame": "joints", "v_deg_s": pytest.approx([0, 0, 0, rate])}

    def test_its_speed_is_told_beside_the_arms(self, turning: Page) -> None:
        expect(turning.locator("#jog-speed")).to_have_text("150 mm/s")
        turning.locator("[data-frame=joints]").click()
        expect(turning.locator("#jog-speed")).to_have_text("85–150 °/s")

    def test_its_key(self, turning: Page, begun: Any) -> None:
        keys = turning.keyboard
        start = begun(lambda: keys.down("r"), lambda: keys.up("r"))
        assert start == {"frame": "joints", "v_deg_s": pytest.approx([0, 0, 0, TURN_DEG])}
        keys.down("Shift")
        start = begun(lambda: keys.down("R"), lambda: keys.up("Shift"))  # the modifier ends it
        keys.up("R")
        assert start["v_deg_s"] == pytest.approx([0, 0, 0, -TURN_DEG])

    def test_a_step_is_in_degrees(self, turning: Page, machine: Any, wait_until: Any) -> None:
        expect(turning.locator("#step-label")).to_have_text("Step mm, °")
        turning.locator("[data-step='10']").click()
        turning.get_by_role("button", name="Tool −, clockwise").click()
        wait_until(lambda: machine.posted("jog"))
        assert machine.posted("jog") == [{"theta_deg": [0, 0, 0, -10]}]

    def test_it_is_read_like_a_joint(self, turning: Page) -> None:
        row = turning.locator("#readouts tr", has_text="Tool °")
        expect(row.locator("td").first).to_have_text("−40.00")

    @pytest.mark.parametrize(("typed", "sent"), [("", {}), ("−12,5", {"tool_deg": -12.5})])
    def test_go_to_turns_it_if_asked(
        self, turning: Page, machine: Any, wait_until: Any, typed: str, sent: dict[str, float]
    ) -> None:
        for axis, text in (("x", "1"), ("y", "2"), ("z", "-300"), ("tool", typed)):
            turning.locator(f"#move-{axis}").fill(text)
        turning.get_by_role("button", name="Go").click()
        wait_until(lambda: machine.posted("move"))
        assert machine.posted("move") == [{"xyz_mm": [1, 2, -300], "speed": 1, **sent}]

    def test_what_is_no_angle_moves_nothing(self, turning: Page, machine: Any) -> None:
        for axis, text in (("x", "1"), ("y", "2"), ("z", "-300"), ("tool", "left")):
            turning.locator(f"#move-{axis}").fill(text)
        turning.get_by_role("button", name="Go").click()
        assert turning.get_by_role("alert").inner_text() == "Tool: no number."
        assert machine.posted("move") == []

    def test_the_present_pose_has_its_angle(self, turning: Page) -> None:
        turning.get_by_role("button", name="Use present pose").click()
        assert turning.locator("#move-tool").input_value() == "−40.00"


def test_a_robot_without_one_has_no_tool_to_turn(
    open_page: Callable[..., Page], machine: Any
) -> None:
    page = open_page()
    assert not page.locator("#move-tool").is_visible()
    assert not [name for name in names(page) if "Tool" in name]
    page.keyboard.press("r")
    page.wait_for_timeout(150)
    assert machine.messages("jog_start") == []
    assert machine.posted("jog") == []
