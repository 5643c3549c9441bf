"""What stands in one browser's panel, as its console sees it and chooses it."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from deltaviz.robots import Robot

Visit = Callable[[str | None], Any]
LONG = 120.0  # s; a process that computes has to load first


_NUMBERS = itertools.count()  # a session keeps its choices, the scene is shared


class Console:
    """One session's, beside the scenes that it has open."""

    def __init__(self, stand: Any) -> None:
        self._stand = stand
        self.session = f"console-{next(_NUMBERS)}"
        self.refusals: list[str] = []

    @property
    def items(self) -> dict[str, Any]:
        return {item.key: item for item in self._stand.scene.items(self.session) or ()}

    def choose(self, key: str, value: object) -> None:
        self._stand.scene.choose(self.session, key, value, self.refusals.append)

    def until(self, holds: Callable[[dict[str, Any]], Any], within: float = LONG) -> Any:
        return self._stand.eventually(lambda: holds(self.items), within)

    def texts(self, key: str) -> str:
        item = self.items.get(key)
        return "" if item is None else " ".join(getattr(row, "text", "") for row in item.rows)

    def is_refused(self) -> str:
        return self._stand.eventually(lambda: self.refusals and self.refusals.pop())


def open_scene(console: Console, visit: Visit) -> Any:
    visitor = visit(console.session)
    visitor.look()
    console.until(lambda items: items)
    return visitor


@pytest.fixture
def console(stand: Any, visit: Visit) -> Console:
    """Of somebody who only watches."""
    stand.machine.be_held_by("anna")
    console = Console(stand)
    open_scene(console, visit)
    return console


def test_every_input_of_the_panel_has_an_equal(stand: Any, console: Console, visit: Visit) -> None:
    """Those of the target have theirs in the console's pose: angles, position, robot."""
    viewer = open_scene(console, visit)
    viewer.input("Save as robot file")  # the last
    elsewhere = {"θ1 °", "θ2 °", "θ3 °", "X mm", "Y mm", "Z mm", "Preset"}
    folders = {"Angles", "Position", "Display", "Robot", "Workspace", "Geometry"}
    hidden = {"Point", "mm at Z", "mm wide", "mm deep"}  # until they mean something
    labels = {item.label for item in console.items.values() if item.kind != "readout"}
    assert labels == viewer.inputs.keys() - elsewhere - folders - hidden


def test_the_reach_is_shown_from_the_console_and_told_there(
    stand: Any, console: Console, visit: Visit
) -> None:
    viewer = open_scene(console, visit)
    viewer.input("Reach")
    console.choose("Workspace: Reach", True)
    checked = {"uuid": viewer.inputs["Reach"], "updates": {"value": True}}
    viewer.read(lambda m: checked.items() <= m.items())  # its own panel says the same
    viewer.read(lambda m: m.get("name") == "/reach/boundary" and "props" in m, LONG)
    console.choose("Workspace: Colours", "Resolution")
    console.until(lambda _: "drawn within" in console.texts("Workspace: Reach told"))
    console.until(lambda items: items["Workspace: Reach told"].rows[-1].name.startswith("Resol"))
    console.choose("Workspace: Reach", False)
    console.until(lambda _: "drawn" not in console.texts("Workspace: Reach told"))
    assert stand.machine.posted == []
    assert console.refusals == []


def test_a_point_is_probed_by_typing_and_a_section_moved(stand: Any, console: Console) -> None:
    console.choose("Workspace: Probe", True)
    console.until(lambda items: "Workspace: Point" in items)
    console.choose("Workspace: Point", "0 0 -300")
    console.until(lambda _: "Conditioning" in console.texts("Workspace: Probe told"))
    console.choose("Workspace: Section Z", True)
    console.choose("Workspace: mm along Z", -310)  # a whole number is a number
    console.until(lambda items: items["Workspace: mm along Z"].value == -310.0)
    assert console.refusals == []
    assert stand.machine.posted == []


@pytest.mark.parametrize(
    ("key", "value", "why"),
    [
        ("Workspace: Reach", "yes", "'Workspace: Reach' takes true or false."),
        ("Workspace: Reach", 1.0, "takes true or false"),
        ("Workspace: mm along Z", 1e6, "takes a number from -"),
        ("Workspace: mm along Z", math.nan, "takes a number from -"),
        ("Workspace: mm along Z", True, "takes a number from -"),
        ("Workspace: Colours", "Beauty", "takes one of One colour, Conditioning, "),
        ("Workspace: Point", "0 0 -300", "The view has no 'Workspace: Point' now."),  # not probing
        ("Geometry: Note", "", "takes nothing"),
        ("Geometry: Save as robot file", True, "Another session has control."),
        ("Geometry: Back to the robot's own", False, "takes true, for a press"),
        ("Angles: θ1 °", 0.0, "The view has no 'Angles: θ1 °' now."),
    ],
)
def test_what_is_not_to_be_chosen_is_refused_and_changes_nothing(
    stand: Any,
    console: Console,
    key: str,
    value: object,
    why: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    before = console.items
    console.choose(key, value)
    assert why in console.is_refused()
    assert console.items == before
    assert list(tmp_path.iterdir()) == []
    assert stand.machine.posted == []


def test_who_steers_saves_a_design(
    stand: Any, visit: Visit, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    console = Console(stand)
    stand.machine.be_held_by(console.session)
    open_scene(console, visit)
    console.choose("Geometry: Forearm", 350.0)
    console.choose("Geometry: Save as robot file", True)
    console.until(lambda _: "Saved" in console.texts("Geometry: Note"))
    assert [path.name for path in tmp_path.iterdir()] == ["stm32-2.toml"]
    assert console.refusals == []


def test_all_scenes_of_a_session_show_the_same_and_another_s_do_not(
    stand: Any, console: Console, visit: Visit
) -> None:
    both = [open_scene(console, visit), open_scene(console, visit)]
    other = Console(stand)
    open_scene(other, visit)
    console.choose("Display: Joint labels", True)
    for viewer in both:
        viewer.input("Joint labels")
        checked = {"uuid": viewer.inputs["Joint labels"], "updates": {"value": True}}
        viewer.read(lambda m, checked=checked: checked.items() <= m.items())
    console.until(lambda items: items["Display: Joint labels"].value is True)
    assert other.items["Display: Joint labels"].value is False


def test_the_same_is_told_by_the_same_object(stand: Any, console: Console) -> None:
    first = stand.scene.items(console.session)
    console.choose("Display: Trail", False)
    console.until(lambda items: items["Display: Trail"].value is False)
    second = stand.scene.items(console.session)
    assert second is not first
    frames = stand.scene._frames
    stand.eventually(lambda: stand.scene._frames > frames + 20)
    assert stand.scene.items(console.session) is second


def test_without_a_scene_nothing_is_chosen(stand: Any, visit: Visit) -> None:
    console = Console(stand)
    assert stand.scene.items(console.session) is None
    console.choose("Workspace: Reach", True)
    assert console.is_refused() == "The scene is not open."
    viewer = open_scene(console, visit)
    viewer.socket.close()
    stand.eventually(lambda: stand.scene.items(console.session) is None)


def test_another_robot_has_other_items(
    own_stand: Any, visit_own: Visit, planar_robot: Robot
) -> None:
    console = Console(own_stand)
    open_scene(console, visit_own)
    console.until(lambda items: "Workspace: Section X" in items)
    own_stand.machine.become(planar_robot)
    console.until(lambda items: "Workspace: Coloured plane" in items)
    assert "Workspace: Section X" not in console.items
    assert "Workspace: Object" not in console.items
    assert "Geometry: Base half" in console.items
