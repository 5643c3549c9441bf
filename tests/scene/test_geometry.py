"""A design on paper beside the robot, spoken by hand through the gateway: it is drawn, told and
saved, and the machine hears nothing of it."""

from __future__ import annotations

import itertools
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from deltaviz.robots import load_robot
from deltaviz.scene.workspace.newest import Newest
from deltaviz.scene.workspace.saving import save_new

Visit = Callable[[str | None], Any]
LONG = 40.0  # s; a process that computes has to load first
BOUNDARY = "/reach/boundary"


def move(visitor: Any, label: str, value: Any) -> None:
    visitor.send(type="GuiUpdateMessage", uuid=visitor.input(label), updates={"value": value})


def drawn(message: dict[str, Any]) -> bool:
    return message.get("name") == BOUNDARY and "props" in message


def told(text: str) -> Callable[[dict[str, Any]], bool]:
    return lambda m: re.search(text, str(m.get("updates", {}).get("content"))) is not None


def depth(mesh: dict[str, Any]) -> float:
    """The lowest point of a boundary, mm."""
    return -1000.0 * float(mesh["props"]["vertices"][2::3].min())


def lowest(forearm: float) -> float:
    """Of stm32 (joints to 90°), by Pythagoras: its elbows stand at R - r from the axis then."""
    return 125.0 + float(np.sqrt(forearm**2 - (115.0 - 75.0) ** 2))


class Shown:
    """What a browser shows, from what came so far: the boundary's depth, the readout."""

    def __init__(self, visitor: Any) -> None:
        self._visitor = visitor
        self.depth, self.readout = 0.0, ""

    def read(self) -> None:
        """The next change."""
        message = self._visitor.read(lambda m: drawn(m) or told("Reach:")(m), LONG)
        if drawn(message):
            self.depth = depth(message)
        else:
            self.readout = message["updates"]["content"]

    def read_until(self, forearm: float, text: str) -> None:
        """Until the boundary is that of stm32 with this forearm, and the readout tells `text`."""
        while not (abs(self.depth - lowest(forearm)) < 2.0 and re.search(text, self.readout)):
            self.read()


def watcher(stand: Any, visit: Visit, session: str = "boris") -> Any:
    visitor = visit(session)
    visitor.look()
    stand.eventually(lambda: stand.server.get_clients())
    return visitor


def test_the_boundary_follows_the_hand_then_is_refined_and_nothing_moves(
    stand: Any, visit: Visit
) -> None:
    stand.machine.be_held_by("anna")
    viewer = watcher(stand, visit)
    before = stand.machine.snapshot, stand.machine.robot
    shown = Shown(viewer)
    coarse = r"Reach: about [\d.]+ l \([\d.]+ l more than stm32\), drawn coarsely"
    for forearm in itertools.cycle((380.0, 400.0)):  # a hand that does not rest
        move(viewer, "Forearm", forearm)
        shown.read()
        if re.search(coarse, shown.readout):
            break
    assert lowest(378.0) < shown.depth < lowest(402.0)
    move(viewer, "Forearm", 400.0)
    shown.read_until(400.0, r"Reach: [\d.]+ l \([\d.]+ l more than stm32\), drawn within")
    move(viewer, "Back to the robot's own", True)
    shown.read_until(338.0, r"Reach: [\d.]+ l, drawn within")
    assert stand.machine.posted == []
    assert (stand.machine.snapshot, stand.machine.robot) == before


def test_what_is_impossible_is_explained_and_the_last_boundary_stays_pale(
    stand: Any, visit: Visit
) -> None:
    viewer = watcher(stand, visit)
    move(viewer, "Forearm", 400.0)
    solid = viewer.read(drawn, LONG)["props"]["opacity"]
    viewer.read(told("drawn within"), LONG)
    move(viewer, "Forearm", 150.0)
    viewer.read(told(r"homing\.ready_deg = .*must be a pose in which the forearms can meet"))
    pale = viewer.read(lambda m: m.get("name") == BOUNDARY and "opacity" in m.get("updates", {}))
    assert pale["updates"]["opacity"] < solid / 2
    (client,) = stand.server.get_clients().values()
    assert client.scene.get_handle_by_name(BOUNDARY) is not None
    move(viewer, "Forearm", 400.0)
    viewer.read(lambda m: m.get("updates", {}).get("opacity") == solid)


def test_a_design_is_saved_and_read_back_and_none_is_written_over(
    stand: Any, visit: Visit, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "stm32-2.toml").write_text("mine")
    viewer = watcher(stand, visit, "anna")
    move(viewer, "Save as robot file", True)
    viewer.read(told("Not saved"))
    move(viewer, "Forearm", 400.0)
    move(viewer, "Base R", 100.0)
    for number in (3, 4):
        move(viewer, "Save as robot file", True)
        viewer.read(told(f"deltaviz --robot .*/stm32-{number}.toml"), LONG)
        saved: Any = load_robot(tmp_path / f"stm32-{number}.toml")
        assert saved.mechanism.forearm == (400.0,) * 3
        assert saved.mechanism.base_radius == (100.0,) * 3
        assert saved.name == f"stm32-{number}"
    assert (tmp_path / "stm32-2.toml").read_text() == "mine"
    assert len(list(tmp_path.iterdir())) == 3
    assert stand.machine.posted == []


def test_who_may_not_steer_may_not_save(
    stand: Any, visit: Visit, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    stand.machine.be_held_by("anna")
    viewer = watcher(stand, visit)
    move(viewer, "Forearm", 400.0)
    viewer.read(drawn, LONG)
    move(viewer, "Save as robot file", True)
    assert viewer.closed() == (1008, "another session has control")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("label", "value"),
    [
        ("Forearm", 1e4),
        ("Forearm", -1.0),
        ("Forearm", "long"),
        ("Save as robot file", False),
        ("Save as robot file", "stm32.toml"),
        ("Back to the robot's own", 1.0),
    ],
)
def test_garbage_for_the_design_closes_the_socket(
    stand: Any, visit: Visit, label: str, value: Any
) -> None:
    viewer = watcher(stand, visit, "anna")
    move(viewer, label, value)
    assert viewer.closed()[0] == 1008


def test_another_robot_ends_the_design(own_stand: Any, visit_own: Visit) -> None:
    viewer = watcher(own_stand, visit_own, "anna")
    move(viewer, "Forearm", 400.0)
    viewer.read(drawn, LONG)
    old = viewer.input("Forearm")
    viewer.inputs.clear()
    own_stand.machine.become(load_robot("trossen"))
    slider = viewer.read(lambda m: m.get("props", {}).get("label") == "Forearm")
    assert slider["value"] == 232.0
    mesh = viewer.read(drawn, LONG)
    trossen = 112.0 + np.sqrt(232.0**2 - (457.3 - 115.0) ** 2 / 12)
    assert depth(mesh) < trossen + 1.0
    viewer.send(type="GuiUpdateMessage", uuid=old, updates={"value": 410.0})  # on its way then
    move(viewer, "Forearm", 240.0)
    viewer.read(told("than trossen"), LONG)
    assert own_stand.machine.posted == []


def test_a_hand_that_is_faster_than_the_pictures_starves_none() -> None:
    sent: list[Any] = []
    newest = Newest(lambda topic, task: sent.append((topic, task)))
    tasks: Iterator[Any] = iter(range(1, 100))
    for _ in range(3):
        newest.tell("boundary", next(tasks))
    newest.tell("X", next(tasks))
    assert sent == [("boundary", 1), ("X", 4)]
    newest.came("boundary")
    assert sent[2:] == [("boundary", 3)]
    newest.came("boundary")
    newest.tell("boundary", next(tasks))
    newest.tell("boundary", next(tasks))
    newest.tell("boundary", None)
    newest.came("boundary")
    assert sent[3:] == [("boundary", 5), ("boundary", None)]


def test_a_robot_s_name_is_no_path(tmp_path: Path) -> None:
    folder = tmp_path / "here"
    folder.mkdir()
    path = save_new(folder, "../../a robot/é", lambda stem: stem)
    assert path.parent == folder
    assert path.read_text() == path.stem == "a-robot-2"
