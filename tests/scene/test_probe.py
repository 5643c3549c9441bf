"""Probing and laying things into the scene, spoken by hand through the gateway."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from deltaviz.robots import Robot, load_robot
from deltaviz.scene.workspace.pictures import Probed
from deltaviz.scene.workspace.probe_shown import parsed
from deltaviz.scene.workspace.probing import Probe
from tests.robots.workspace import oracle
from tests.robots.workspace.test_planar_collisions import least_gap

Visit = Callable[[str | None], Any]
LONG = 120.0  # s; a process that computes has to load first

CLICK: dict[str, Any] = {
    "type": "ScenePointerMessage",
    "event_type": "click",
    "ray_origin": [0.05, -0.03, 1.0],
    "ray_direction": [0.0, 0.0, -1.0],
    "screen_pos": [[0.5, 0.5]],
    "modifier": None,
}


def choose(visitor: Any, label: str, value: Any) -> None:
    visitor.send(type="GuiUpdateMessage", uuid=visitor.input(label), updates={"value": value})


def click(visitor: Any, x: float, y: float) -> None:
    """From straight above; mm."""
    visitor.send(**{**CLICK, "ray_origin": [x / 1000, y / 1000, 1.0]})


def drawn(name: str) -> Callable[[dict[str, Any]], bool]:
    """Itself, or a picture in its place."""
    return lambda m: m.get("name") in (name, f"{name}/a", f"{name}/b") and "props" in m


def gone(name: str) -> Callable[[dict[str, Any]], bool]:
    names = (name, f"{name}/a", f"{name}/b")
    return lambda m: m["type"] == "RemoveSceneNodeMessage" and m["name"] in names


def told(text: str) -> Callable[[dict[str, Any]], bool]:
    return lambda m: text in str(m.get("updates", {}).get("content"))


def listens(for_clicks: bool) -> Callable[[dict[str, Any]], bool]:
    return lambda m: m["type"] == "ScenePointerEnableMessage" and bool(m["modifiers"]) == for_clicks


def watching(stand: Any, visit: Visit) -> Any:
    """One that may not steer: probing is for everyone."""
    stand.machine.be_held_by("anna")
    before = len(stand.server.get_clients())
    visitor = visit("boris")
    visitor.look()
    stand.eventually(lambda: len(stand.server.get_clients()) == before + 1)
    return visitor


@pytest.fixture
def viewer(stand: Any, visit: Visit) -> Any:
    return watching(stand, visit)


def test_a_click_on_the_paper_is_told_and_marked_until_probing_ends(
    stand: Any, viewer: Any
) -> None:
    choose(viewer, "Object", "A4 paper")
    paper = viewer.read(told("A4 paper at Z"), LONG)["updates"]["content"]
    level = paper.split("at Z ")[1].split(" mm")[0]
    choose(viewer, "Probe", True)
    viewer.read(listens(True))
    click(viewer, 400, 0)  # beside the paper: nothing
    click(viewer, 60, -40)
    first = viewer.read(lambda m: "Angles" in str(m.get("updates", {}).get("content")), LONG)
    assert f"X 60.0  Y -40.0  Z {level}.0" in first["updates"]["content"]
    choose(viewer, "Point", "60 -40 ")  # half typed
    viewer.read(gone("/reach/probe/cross"))
    choose(viewer, "Point", "0, 0; -700")
    viewer.read(told("Arm 2 cannot reach it"), LONG)
    choose(viewer, "Probe", False)
    viewer.read(listens(False))
    viewer.read(gone("/reach/probe/cross"))
    click(viewer, 0, 0)  # on its way when probing ended: harmless
    choose(viewer, "Object", "None")
    viewer.read(gone("/reach/object"))
    assert stand.machine.posted == []


def test_another_browser_s_click_probes_nothing_here(stand: Any, viewer: Any, visit: Visit) -> None:
    other = watching(stand, visit)
    for visitor in (viewer, other):
        choose(visitor, "Object", "Letter paper")
        visitor.read(told("Letter paper at Z"), LONG)
        choose(visitor, "Probe", True)
        visitor.read(listens(True))
    click(other, 30, 0)
    other.read(told("X 30.0"), LONG)
    click(viewer, -30, 0)
    content = viewer.read(told("Angles"), LONG)["updates"]["content"]
    assert "X -30.0" in content


def test_a_table_follows_its_sliders(stand: Any, viewer: Any) -> None:
    choose(viewer, "Object", "Table")
    viewer.read(told("Table 300 by 200 mm"), LONG)
    choose(viewer, "mm wide", 460.0)
    viewer.read(told("Table 460 by 200 mm"), LONG)
    choose(viewer, "mm at Z", -390.0)
    viewer.read(drawn("/reach/object"), LONG)
    viewer.read(told("at Z -390 mm: does not fit"), LONG)


def test_another_robot_has_no_point_and_its_own_height(
    own_stand: Any, visit_own: Visit, other_robot: Robot
) -> None:
    viewer = watching(own_stand, visit_own)
    choose(viewer, "Object", "A4 paper")
    viewer.read(told("A4 paper at Z"), LONG)
    choose(viewer, "mm at Z", -390.0)
    viewer.read(told("at Z -390 mm"), LONG)
    choose(viewer, "Probe", True)
    choose(viewer, "Point", "0 0 -300")
    viewer.read(told("Angles"), LONG)
    own_stand.machine.become(other_robot)
    viewer.read(gone("/reach/probe/cross"), LONG)
    there = viewer.read(told("A4 paper at Z"), LONG)["updates"]["content"]
    assert "Z -390" not in there


@pytest.mark.parametrize(
    "changes",
    [
        {"ray_origin": [0, 0, math.nan]},
        {"ray_origin": [0, 0, 1e9]},
        {"ray_origin": None},
        {"ray_direction": [0, 0, 0]},
        {"ray_direction": [0, 0, math.inf]},
        {"ray_direction": [0, 1]},
        {"event_type": "rect-select"},
        {"screen_pos": [[0, 0], [1, 1]]},
        {"screen_pos": [0, 0]},
        {"modifier": "shift"},
        {"owner": "1"},
    ],
)
def test_a_click_that_no_page_of_ours_sends_closes_the_socket(
    stand: Any, viewer: Any, changes: dict[str, Any]
) -> None:
    viewer.send(**{**CLICK, **changes})
    assert viewer.closed()[0] == 1008


@pytest.mark.parametrize("value", ["1 " * 60, 3.0, True])
def test_garbage_for_the_point_closes_the_socket(stand: Any, viewer: Any, value: Any) -> None:
    choose(viewer, "Point", value)
    assert viewer.closed()[0] == 1008


@pytest.mark.parametrize("text", ["", "1 2", "1 2 3 4", "1 2 nan", "1 2 1e9", "a b c", "1,,2 -"])
def test_what_is_not_a_point_is_none(text: str) -> None:
    assert parsed(text) is None


@pytest.mark.parametrize(
    "text",
    [
        "1 -2.5 -300",
        " 1, -2.5, -300",
        "1;-2.5;-3e2",
        "1,-2.5,-300 ",
        "1, -2.5,-300",
        "1 -2,5 -300",
        "1,0; -2,5; -300,0",
        "1 \u22122.5 \u2212300",
    ],
)
def test_a_point_is_three_numbers(text: str) -> None:
    assert parsed(text) == (1.0, -2.5, -300.0)


def probed(robot: Robot, *xyz: float) -> Probed:
    x, y, z = xyz
    (found,) = Probe(robot, (x, y, z)).pictures()
    return found


@pytest.mark.parametrize("name", ["stm32", "trossen", "fivebar"])
def test_the_angles_close_the_arms(name: str) -> None:
    robot = load_robot(name)
    at = (12.0, 0.0, sum(robot.zone.z) / 2)
    found = probed(robot, *at)
    own = np.array([at if len(robot.axes) == 3 else (at[0], at[2])])
    judged = [math.degrees(arm.theta[0]) for arm in oracle.arms(robot, own)]
    assert found.theta_deg == pytest.approx(judged, abs=1e-6)
    assert found.xyz == at
    assert found.why_not == ()


def test_why_not_is_said_and_by_how_much(robot: Robot) -> None:
    judged = math.degrees(oracle.arms(robot, np.array([(260.0, 0.0, -330.0)]))[1].theta[0])
    found = probed(robot, 260, 0, -330)
    beyond = (
        f"Arm 2 would stand at {judged:.2f}°, {judged - 90:.2f}° beyond its upper limit of 90°."
    )
    assert beyond in found.why_not
    assert found.nearest == ()
    assert found.theta_deg is not None
    far = probed(robot, 0, 0, -700)
    assert far.theta_deg is None
    assert far.skill is None
    assert any("too far away" in reason for reason in far.why_not)


def test_parts_that_would_overlap_are_named_of_a_planar_robot_too() -> None:
    robot = load_robot("fivebar")
    gap, pairs = least_gap(robot, np.array((-1.0, -81.5)))
    assert gap < -1.0
    assert pairs == [frozenset({("base", 0), ("forearm", 0)})]
    found = probed(robot, -1, 0, -81.5)
    (told,) = (reason for reason in found.why_not if "overlap" in reason)
    assert told == f"Forearm of arm 1 and base would overlap by {-gap:.2f} mm."
    assert not any("overlap" in reason for reason in probed(robot, 0, 0, -120).why_not)


def test_the_nearest_limits_are_as_far_as_is_told(robot: Robot) -> None:
    """Of a point by the lower end of what the robot's file allows, and far from all else."""
    bounded = dataclasses.replace(robot, bodies=None)
    found = probed(bounded, 10, 20, bounded.zone.z[0] + 7.0)
    (name, away), *others = found.nearest
    assert (name, away) == ("lower end of the workspace", pytest.approx(7.0))
    assert [far for _, far in others] == sorted(far for _, far in others)
    assert all(far > 7.0 for _, far in others)


def test_speeds_and_conditioning_are_of_small_motions(robot: Robot) -> None:
    """By turning the joints a little, in all directions, through the arms' own triangles."""
    at, step = np.array((80.0, -30.0, -310.0)), 1e-3

    def angles(points: np.ndarray) -> np.ndarray:
        return np.stack([arm.theta for arm in oracle.arms(robot, points)], axis=-1)

    ways = step * np.concatenate((np.eye(3), -np.eye(3)))
    turned = angles(at + ways)
    speeds = np.linalg.svd(np.linalg.inv((turned[:3] - turned[3:]).T / (2 * step)))[1]
    skill = probed(robot, *at.tolist()).skill
    assert skill is not None
    assert skill.fastest == pytest.approx(speeds[0], rel=1e-4)
    assert skill.slowest == pytest.approx(speeds[2], rel=1e-4)
    assert skill.condition == pytest.approx(speeds[0] / speeds[2], rel=1e-4)
    microstep = 2 * math.pi / (200 * 16)  # of the stm32's motors, which turn the arms themselves
    assert skill.resolution == pytest.approx(speeds[0] * microstep, rel=1e-4)
