"""Set-up: the board is chosen, connected, given up, and what is wrong with it is told."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from playwright.sync_api import Page, expect

pytestmark = pytest.mark.browser

USB = {"id": "ttyusb0", "description": "CP2102 USB to UART (ttyUSB0)"}
PULLED = (
    "The link to /dev/ttyUSB0 broke: it was unplugged, or has lost its power. A board that moves "
    "brakes by itself. Check its cable and power, then connect; nothing is resumed."
)


@pytest.fixture(params=[(1280, 800), (390, 844)], ids=["wide", "pendant"])
def page(open_page: Callable[..., Page], request: pytest.FixtureRequest) -> Page:
    page = open_page(*request.param)
    if request.param[0] < 720:
        page.locator(".tabs [data-view=setup]").click()
    else:
        page.get_by_role("button", name="Set-up").click()
    return page


def test_a_board_that_is_plugged_in_can_be_chosen(
    page: Page, machine: Any, wait_until: Callable[..., Any]
) -> None:
    machine.set_link(phase="closed")
    links = page.get_by_label("Link", exact=True)
    expect(links.locator("option")).to_have_text(["Simulated board"])
    machine.ports.append(USB)
    expect(links.locator("option")).to_have_text(["Simulated board", USB["description"]])
    links.select_option("ttyusb0")
    page.get_by_role("button", name="Connect", exact=True).click()
    wait_until(lambda: machine.posted("connect") == [{"link": "ttyusb0"}])


def test_the_choice_survives_a_new_list(page: Page, machine: Any) -> None:
    machine.set_link(phase="closed")
    machine.ports.append(USB)
    links = page.get_by_label("Link", exact=True)
    expect(links.locator("option")).to_have_count(2)
    links.select_option("ttyusb0")
    machine.ports.append({"id": "ttyusb1", "description": "Another"})
    expect(links.locator("option")).to_have_count(3)
    assert links.input_value() == "ttyusb0"


@pytest.mark.parametrize("phase", ["opening", "greeting"])
def test_a_board_that_does_not_answer_is_given_up(
    page: Page, machine: Any, wait_until: Callable[..., Any], phase: str
) -> None:
    machine.set_link(phase=phase, id="ttyusb0")
    machine.set(next_step="Waiting for the board on ttyusb0 to answer.")
    expect(page.get_by_role("status")).to_have_text("Waiting for the board on ttyusb0 to answer.")
    page.get_by_role("button", name="Cancel").click()
    wait_until(lambda: [path for path, _ in machine.posts] == ["disconnect"])


def test_what_happened_to_the_link_is_told_where_it_is_mended(page: Page, machine: Any) -> None:
    problem = page.locator("#link-problem")
    assert problem.is_hidden()
    machine.set_link(phase="closed", id="ttyusb0", problem=PULLED)
    expect(problem).to_have_text(PULLED)
    expect(page.get_by_role("status")).to_have_text(PULLED)
    button = page.get_by_role("button", name="Connect", exact=True)
    button.scroll_into_view_if_needed()
    problem.scroll_into_view_if_needed()
    expect(problem).to_be_in_viewport()
    machine.set_link(phase="opening", problem=None)
    expect(problem).to_be_hidden()


def test_how_the_link_is_doing(page: Page, machine: Any) -> None:
    facts = page.locator("#link-facts > div")
    expect(facts).to_have_text(
        [
            "Boardsimulated python", "Last news4 ms", "Round trip0.8 ms", "Queue6 / 64",
            "Motion ahead58 ms", "Dropped0", "Underruns0", "Captureoff",
        ]
    )  # fmt: skip
    machine.set_link(dropped=3, round_trip_ms=None)
    machine.set(underruns=2)
    expect(facts.nth(2)).to_have_text("Round trip–")
    expect(facts.nth(5)).to_have_text("Dropped3")
    expect(facts.nth(6)).to_have_text("Underruns2")
    capture = {"name": "today.capture", "size": 3_210_000, "lost": 0, "problem": None}
    machine.set(capture=capture)
    expect(facts.nth(7)).to_have_text("Capturetoday.capture, 3.2 MB")
    machine.set(capture=capture | {"lost": 12})
    expect(facts.nth(7)).to_have_text("Capturetoday.capture, 3.2 MB, 12 records lost")
    machine.set(capture=capture | {"problem": "The capture has ended: No space left on device."})
    expect(facts.nth(7)).to_contain_text("No space left")
    machine.set_link(phase="closed")
    expect(page.locator("#link-facts")).to_be_hidden()


def test_a_board_that_was_met_again_is_told_of_with_the_next_step(page: Page, machine: Any) -> None:
    machine.set_link(note="Connected again: the board was restarted, so home it.")
    machine.set(mode="unhomed", homed=False, next_step="Home the robot.")
    expect(page.get_by_role("status")).to_have_text(
        "Connected again: the board was restarted, so home it. Home the robot."
    )


def test_an_e_stop_is_told_with_its_cause(page: Page, machine: Any) -> None:
    next_step = "Make sure that all is safe, then reset."
    machine.set(mode="estop", homed=False, next_step=next_step)
    expect(page.get_by_role("status")).to_have_text(next_step)
    machine.set(stop_reason="The board refused 'reset': the emergency stop is still pressed.")
    expect(page.get_by_role("status")).to_have_text(
        f"The board refused 'reset': the emergency stop is still pressed. {next_step}"
    )
