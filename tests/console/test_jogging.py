"""What begins a jog, what keeps it alive and what ends it."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import pytest
from playwright.sync_api import Locator, Page

pytestmark = pytest.mark.browser

JOG = ("jog_start", "jog", "jog_end")
QUIET_MS = 300  # several times the pause between two heartbeats


def kinds(machine: Any) -> list[str]:
    return [m["type"] for m in machine.messages(*JOG)]


def hold(page: Page, name: str = "X+") -> Locator:
    button = page.get_by_role("button", name=name, exact=True)
    button.hover()
    page.mouse.down()
    return button


def assert_ended(page: Page, machine: Any, wait_until: Callable[..., Any]) -> None:
    """The jog has ended, no sign of life follows, and what is still pressed starts nothing."""
    wait_until(lambda: "jog_end" in kinds(machine))
    count = len(machine.messages(*JOG))
    page.wait_for_timeout(QUIET_MS)
    said = machine.messages(*JOG)
    assert said[-1]["type"] == "jog_end"
    assert len(said) == count
    assert len({m["id"] for m in said}) == 1


@pytest.fixture
def page(open_page: Callable[..., Page]) -> Page:
    return open_page()


@pytest.fixture
def hold_until_alive(
    machine: Any, wait_until: Callable[..., Any]
) -> Callable[[Callable[[], object], Callable[[], object]], None]:
    """Presses until the jog lives: on a busy machine a page may sleep through its lease, or have
    lost the focus for a moment, and has then rightly let go."""

    def hold_(press: Callable[[], object], release: Callable[[], object]) -> None:
        for _ in range(5):
            press()
            with contextlib.suppress(AssertionError):
                wait_until(
                    lambda: kinds(machine).count("jog") >= 2 or "jog_end" in kinds(machine), 2.0
                )
            if "jog" in kinds(machine) and "jog_end" not in kinds(machine):
                return
            release()
            machine.forget()
        raise AssertionError("the page sleeps all the time")

    return hold_


@pytest.fixture
def holding(page: Page, hold_until_alive: Callable[..., None]) -> Page:
    """A page on which the pointer holds X+, alive."""
    hold_until_alive(lambda: hold(page), page.mouse.up)
    return page


@pytest.fixture
def holding_key(page: Page, hold_until_alive: Callable[..., None]) -> Callable[..., None]:
    """Presses keys, the last of which begins a jog; returns once it is alive."""

    def hold_keys(*keys: str) -> None:
        hold_until_alive(
            lambda: [page.keyboard.down(key) for key in keys],
            lambda: [page.keyboard.up(key) for key in reversed(keys)],
        )

    return hold_keys


def test_a_held_button_sends_signs_of_life_until_it_is_let_go(
    holding: Page, machine: Any, wait_until: Callable[..., Any]
) -> None:
    wait_until(lambda: kinds(machine).count("jog") >= 10)
    holding.mouse.up()
    assert_ended(holding, machine, wait_until)
    start, *beats, end = machine.messages(*JOG)
    assert start["frame"] == "base"
    assert start["v_mm_s"] == [150, 0, 0]
    assert [b["seq"] for b in beats] == list(range(1, len(beats) + 1))
    assert {m["id"] for m in (start, *beats, end)} == {start["id"]}
    pauses = sorted(b["t_ms"] - a["t_ms"] for a, b in pairwise(beats))
    assert pauses[len(pauses) // 2] >= 50  # no flood


def test_each_press_has_an_id_of_its_own(
    page: Page, machine: Any, wait_until: Callable[..., Any]
) -> None:
    for n in range(1, 4):
        hold(page)
        page.mouse.up()
        wait_until(lambda n=n: kinds(machine).count("jog_end") == n)
    assert len({m["id"] for m in machine.messages("jog_start")}) == 3


def test_the_pointer_may_leave_the_button(
    holding: Page, machine: Any, wait_until: Callable[..., Any]
) -> None:
    holding.mouse.move(300, 400)  # over the scene's frame
    machine.forget()
    wait_until(lambda: kinds(machine).count("jog") >= 3)
    holding.mouse.up()
    wait_until(lambda: kinds(machine)[-1] == "jog_end")


def test_a_diagonal_is_no_faster(page: Page, machine: Any, wait_until: Callable[..., Any]) -> None:
    hold(page, "X+ and Y+")
    (start,) = wait_until(lambda: machine.messages("jog_start"))
    page.mouse.up()
    assert math.hypot(*start["v_mm_s"]) == pytest.approx(150)


@pytest.mark.parametrize("event", ["pointercancel", "lostpointercapture"])
def test_a_lost_pointer_ends_the_jog(
    holding: Page, machine: Any, wait_until: Callable[..., Any], event: str
) -> None:
    holding.evaluate(
        """(event) => document.querySelector("#pad [data-held]").dispatchEvent(
            new PointerEvent(event, {pointerId: 1, bubbles: true}))""",
        event,
    )
    assert_ended(holding, machine, wait_until)


def test_another_pointer_ends_nothing(
    holding: Page, machine: Any, wait_until: Callable[..., Any]
) -> None:
    holding.evaluate(
        """document.querySelector("#pad [data-held]").dispatchEvent(
            new PointerEvent("pointerup", {pointerId: 7, bubbles: true}))"""
    )
    machine.forget()
    wait_until(lambda: kinds(machine).count("jog") >= 3)
    assert kinds(machine) == ["jog"] * len(kinds(machine))


def test_losing_the_focus_ends_the_jog(
    holding: Page, machine: Any, wait_until: Callable[..., Any]
) -> None:
    holding.evaluate("document.hasFocus = () => false; window.dispatchEvent(new Event('blur'))")
    assert_ended(holding, machine, wait_until)


def test_a_loss_of_focus_that_nothing_tells_is_found_by_the_next_heartbeat(
    holding: Page, machine: Any, wait_until: Callable[..., Any]
) -> None:
    holding.evaluate("document.hasFocus = () => false")
    assert_ended(holding, machine, wait_until)


def test_a_blur_into_the_frame_is_no_loss(
    holding: Page, machine: Any, wait_until: Callable[..., Any]
) -> None:
    holding.evaluate("window.dispatchEvent(new Event('blur'))")
    machine.forget()
    wait_until(lambda: kinds(machine).count("jog") >= 3)
    assert "jog_end" not in kinds(machine)


@pytest.mark.parametrize(
    "loss",
    [
        "document.querySelector('#move-x').focus()",
        "document.querySelector('#scene').contentDocument.querySelector('#box').focus()",
        "document.querySelector('#scene').contentWindow.location.reload()",
        "window.dispatchEvent(new Event('pagehide'))",
        "document.querySelector('[data-frame=joints]').click()",
        "document.querySelector('#setup-toggle').click()",
    ],
)
def test_what_breaks_a_hold(
    holding: Page, machine: Any, wait_until: Callable[..., Any], loss: str
) -> None:
    holding.evaluate(f"() => {{ {loss} }}")
    assert_ended(holding, machine, wait_until)


@pytest.mark.parametrize(
    "change",
    [
        {"mode": "stopping"},
        {"mode": "fault", "fault": "Limit switch of arm 2"},
        {"mode": "estop"},
        {"mode": "offline"},
        {"stop_reason": "Stop on a page"},
        {"control": {"holder": "another", "you": False}},
    ],
)
def test_the_machine_ends_a_jog(
    holding: Page, machine: Any, wait_until: Callable[..., Any], change: dict[str, Any]
) -> None:
    machine.set(**change)
    assert_ended(holding, machine, wait_until)
    machine.set(mode="idle", fault=None, control={"holder": "you", "you": True})
    holding.wait_for_timeout(QUIET_MS)
    assert len(machine.messages("jog_start")) == 1  # nothing resumes by itself


def test_a_jog_that_the_machine_never_takes_up_ends(
    page: Page, machine: Any, wait_until: Callable[..., Any]
) -> None:
    machine.obeys = False
    hold(page)
    assert_ended(page, machine, wait_until)


def test_a_refused_jog_ends_and_says_why(
    holding: Page, machine: Any, wait_until: Callable[..., Any]
) -> None:
    press = machine.messages("jog_start")[0]["id"]
    machine.say({"type": "refused", "to": "jog_start", "id": press, "detail": "Not that way."})
    assert_ended(holding, machine, wait_until)
    assert holding.get_by_role("status").inner_text() == "Not that way."


def test_silence_from_the_robot_ends_a_jog(
    holding: Page, machine: Any, wait_until: Callable[..., Any]
) -> None:
    machine.silent = True
    assert_ended(holding, machine, wait_until)


def test_a_page_that_slept_through_its_lease_does_not_wake_into_a_jog(
    holding: Page, machine: Any, wait_until: Callable[..., Any]
) -> None:
    holding.evaluate("const end = performance.now() + 450; while (performance.now() < end);")
    assert_ended(holding, machine, wait_until)


# Keys


@pytest.mark.parametrize(
    ("key", "direction"),
    [
        ("ArrowRight", [1, 0, 0]), ("KeyD", [1, 0, 0]), ("ArrowLeft", [-1, 0, 0]),
        ("KeyA", [-1, 0, 0]), ("ArrowUp", [0, 1, 0]), ("KeyW", [0, 1, 0]),
        ("ArrowDown", [0, -1, 0]), ("KeyS", [0, -1, 0]), ("PageUp", [0, 0, 1]),
        ("KeyQ", [0, 0, 1]), ("PageDown", [0, 0, -1]), ("KeyE", [0, 0, -1]),
    ],
)  # fmt: skip
def test_keys_jog(
    page: Page, machine: Any, wait_until: Callable[..., Any], key: str, direction: list[int]
) -> None:
    page.keyboard.down(key)
    (start,) = wait_until(lambda: machine.messages("jog_start"))
    page.keyboard.up(key)
    assert_ended(page, machine, wait_until)
    assert start["v_mm_s"] == [150 * d for d in direction]


def test_joints_have_number_keys(page: Page, machine: Any, wait_until: Callable[..., Any]) -> None:
    page.get_by_role("button", name="Joints").click()
    page.keyboard.press("ArrowRight")
    page.keyboard.press("Digit4")  # there is no fourth joint
    page.keyboard.press("Digit2")
    page.keyboard.down("Shift")
    page.keyboard.press("Digit3")
    page.keyboard.up("Shift")
    starts = wait_until(lambda: len(s := machine.messages("jog_start")) == 2 and s)
    assert [s["frame"] for s in starts] == ["joints", "joints"]
    assert [s["v_deg_s"] for s in starts] == [[0, 85, 0], [0, 0, -85]]


def test_releasing_the_modifier_of_a_press_ends_it(
    page: Page, machine: Any, wait_until: Callable[..., Any], holding_key: Callable[..., None]
) -> None:
    page.get_by_role("button", name="Joints").click()
    holding_key("Shift", "Digit1")
    page.keyboard.up("Shift")
    assert_ended(page, machine, wait_until)


def test_a_repeating_key_starts_once(
    page: Page, machine: Any, wait_until: Callable[..., Any]
) -> None:
    page.keyboard.down("KeyD")
    page.keyboard.down("KeyD")  # Playwright's second `down` is a repeat
    wait_until(lambda: kinds(machine).count("jog") >= 3)
    page.evaluate("document.hasFocus = () => false; window.dispatchEvent(new Event('blur'))")
    wait_until(lambda: "jog_end" in kinds(machine))
    page.evaluate("delete document.hasFocus")
    page.keyboard.down("KeyD")
    page.wait_for_timeout(QUIET_MS)
    assert kinds(machine).count("jog_start") == 1
    page.keyboard.up("KeyD")
    page.keyboard.down("KeyD")
    wait_until(lambda: kinds(machine).count("jog_start") == 2)  # a fresh press


def test_only_the_key_that_began_a_jog_ends_it(
    page: Page, machine: Any, wait_until: Callable[..., Any], holding_key: Callable[..., None]
) -> None:
    holding_key("KeyD")
    page.keyboard.down("KeyW")
    page.keyboard.up("KeyW")
    machine.forget()
    wait_until(lambda: kinds(machine).count("jog") >= 3)
    assert set(kinds(machine)) == {"jog"}
    page.keyboard.up("KeyD")
    wait_until(lambda: kinds(machine)[-1] == "jog_end")


@pytest.mark.parametrize("modifier", ["Control", "Alt", "Meta"])
def test_shortcuts_jog_nothing(page: Page, machine: Any, modifier: str) -> None:
    page.keyboard.down(modifier)
    page.keyboard.press("ArrowUp")
    page.keyboard.up(modifier)
    page.wait_for_timeout(QUIET_MS)
    assert kinds(machine) == []


def test_a_shortcut_ends_a_held_key(
    page: Page, machine: Any, wait_until: Callable[..., Any]
) -> None:
    page.keyboard.down("KeyD")
    wait_until(lambda: "jog" in kinds(machine))
    page.keyboard.down("Alt")
    assert_ended(page, machine, wait_until)


@pytest.mark.parametrize("field", ["#move-x", "#override", "header [data-robot]"])
def test_fields_and_sliders_keep_their_keys(page: Page, machine: Any, field: str) -> None:
    page.locator(field).focus()
    page.keyboard.press("ArrowRight")
    page.keyboard.press("KeyD")
    page.wait_for_timeout(QUIET_MS)
    assert kinds(machine) == []


def test_turning_the_speed_leaves_the_arrow_keys_to_jogging(
    page: Page, machine: Any, wait_until: Callable[..., Any]
) -> None:
    page.locator("#override").click()
    page.keyboard.press("ArrowRight")
    wait_until(lambda: "jog_start" in kinds(machine))


def test_a_focused_button_is_held_by_the_space_bar(
    page: Page, machine: Any, wait_until: Callable[..., Any]
) -> None:
    page.get_by_role("button", name="Z−", exact=True).focus()
    page.keyboard.down("Space")
    wait_until(lambda: kinds(machine).count("jog") >= 2)
    page.keyboard.up("Space")
    assert_ended(page, machine, wait_until)


# Steps, frames, and when there is no jogging


def test_steps_are_one_a_press(page: Page, machine: Any, wait_until: Callable[..., Any]) -> None:
    page.get_by_role("button", name="10", exact=True).click()
    page.get_by_role("button", name="Y−", exact=True).click()
    page.keyboard.down("PageUp")
    page.keyboard.down("PageUp")
    page.keyboard.up("PageUp")
    wait_until(lambda: len(machine.posted("jog")) == 2)
    page.wait_for_timeout(QUIET_MS)
    assert machine.posted("jog") == [{"xyz_mm": [0, -10, 0]}, {"xyz_mm": [0, 0, 10]}]
    assert kinds(machine) == []


def test_a_refused_step_says_why(page: Page, machine: Any) -> None:
    machine.refusals["jog"] = (422, "Z -441 is below the workspace.")
    page.get_by_role("button", name="1", exact=True).click()
    page.get_by_role("button", name="Z−", exact=True).click()
    page.get_by_text("Z -441 is below the workspace.").wait_for()


def test_the_camera_frame_names_its_own_directions(
    page: Page, machine: Any, wait_until: Callable[..., Any]
) -> None:
    page.get_by_role("button", name="Camera").click()
    hold(page, "Away")
    (start,) = wait_until(lambda: machine.messages("jog_start"))
    page.mouse.up()
    assert (start["frame"], start["v_mm_s"]) == ("camera", [0, 150, 0])
    assert page.get_by_role("button", name="10", exact=True).is_disabled()


def test_before_homing_only_joints_jog_and_slowly(
    page: Page, machine: Any, wait_until: Callable[..., Any]
) -> None:
    machine.set(mode="unhomed", homed=False)
    page.get_by_role("button", name="Joint 1 +, down", exact=True).wait_for()
    assert page.get_by_role("button", name="Base").is_disabled()
    hold(page, "Joint 1 +, down")
    (start,) = wait_until(lambda: machine.messages("jog_start"))
    page.mouse.up()
    assert start["v_deg_s"] == [5, 0, 0]
    machine.set(mode="idle", homed=True)
    page.get_by_role("button", name="X+", exact=True).wait_for()


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"mode": "disabled", "homed": False}, "Enable"),
        ({"mode": "estop", "homed": False}, "Reset"),
        ({"control": {"holder": "another", "you": False}}, "Another has control"),
    ],
)
def test_a_press_that_cannot_jog_says_why(
    page: Page, machine: Any, wait_until: Callable[..., Any], change: dict[str, Any], reason: str
) -> None:
    machine.set(**change)
    page.locator("#pad[data-barred]").wait_for()
    page.locator("#pad button").first.hover()
    page.mouse.down()
    wait_until(lambda: reason in page.get_by_role("status").inner_text())
    page.wait_for_timeout(QUIET_MS)
    assert kinds(machine) == []


def test_keys_jog_only_while_the_pad_shows(page: Page, machine: Any) -> None:
    page.get_by_role("button", name="Set-up").click()
    page.keyboard.press("KeyD")
    page.wait_for_timeout(QUIET_MS)
    assert kinds(machine) == []


def test_the_speed_slider_sets_the_override(
    page: Page, machine: Any, wait_until: Callable[..., Any]
) -> None:
    page.locator("#override").fill("40")
    wait_until(lambda: machine.messages("override"))
    assert machine.messages("override")[-1]["value"] == 0.4
