"""The scene as browsers get it: nodes, rates, switches of robot."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest

from deltaviz.machine.intent import FollowAngles, FollowPoint
from deltaviz.robots import Robot
from deltaviz.robots.coordinates import in_space
from deltaviz.robots.load import Loaded
from deltaviz.scene import colours, framing
from deltaviz.scene.stage import outline
from deltaviz.scene.trail import SEGMENTS, TrailPoints

Visit = Callable[[str | None], Any]


def nodes(stand: Any) -> set[str]:
    return set(stand.server.scene._handle_from_node_name)


def buffered(stand: Any) -> int:
    """Messages that a browser would be sent on arrival."""
    return len(stand.server._websock_server._broadcast_buffer.message_from_id)


def drawn_tip(stand: Any) -> np.ndarray:
    return stand.server.scene.get_handle_by_name("/robot/effector").position * 1000.0


def test_a_thousand_poses_add_no_node_and_no_message(stand: Any) -> None:
    before = nodes(stand)
    counts: list[int] = []

    def poses() -> Iterator[None]:
        for i in range(1000):
            angle = i / 50
            xyz = (60 * math.cos(angle), 60 * math.sin(angle), -330.0)
            target = (-xyz[0], xyz[1], -320.0)
            theta = tuple(stand.machine.robot.inverse(target).tolist())
            stand.machine.be_at(xyz, target_xyz=target, target_theta=theta, margins=(1.0, 0.1, 0.0))
            counts.append(buffered(stand))
            yield

    stand.draw(poses())
    assert nodes(stand) == before
    assert max(counts[500:]) == max(counts[50:500])  # nothing piles up


def test_the_robot_is_shown_where_it_was_reported_not_where_it_was_sent(stand: Any) -> None:
    stand.machine.be_at((10.0, -20.0, -340.0), target_xyz=(80.0, 0.0, -330.0))
    stand.eventually(lambda: np.allclose(drawn_tip(stand), (10.0, -20.0, -340.0)))


def test_the_ghost_is_at_the_target_and_gone_when_it_is_reached(stand: Any) -> None:
    target = (80.0, 0.0, -330.0)
    theta = tuple(stand.machine.robot.inverse(target).tolist())
    ghost = stand.server.scene.get_handle_by_name("/ghost/robot")
    effector = stand.server.scene.get_handle_by_name("/ghost/robot/effector")
    stand.machine.be_at((0.0, 0.0, -330.0), target_xyz=target, target_theta=theta)
    stand.eventually(lambda: ghost.visible and np.allclose(effector.position, (0.08, 0, -0.33)))
    stand.machine.be_at(target)
    stand.eventually(lambda: not ghost.visible)


def test_another_robot_is_drawn_with_the_same_names(own_stand: Any, other_robot: Robot) -> None:
    robots = (other_robot, own_stand.machine.robot)
    before = nodes(own_stand)
    counts: list[int] = []

    def switches() -> Iterator[None]:
        for i in range(12):
            own_stand.machine.become(robots[i % 2])
            yield
            counts.append(buffered(own_stand))
            yield

    own_stand.draw(switches())
    assert nodes(own_stand) == before
    assert max(counts[8:]) == max(counts[4:8])  # nothing piles up
    own_stand.machine.become(other_robot)
    own_stand.eventually(lambda: own_stand.scene._robot is other_robot)
    own_stand.eventually(lambda: np.allclose(drawn_tip(own_stand), (0, 0, -260)))


def test_the_sliders_take_the_range_of_another_robot(
    own_stand: Any, visit_own: Visit, other_robot: Robot
) -> None:
    visitor = visit_own("anna")
    visitor.look()
    z = visitor.input("Z mm")
    own_stand.machine.become(other_robot)
    lowest = visitor.read(
        lambda m: m["type"] == "GuiUpdateMessage" and m["uuid"] == z and "min" in m["updates"]
    )
    assert lowest["updates"]["min"] == -290.0


def labels_after(visitor: Any, stand: Any, robot: Robot, last: str) -> list[str]:
    """The labels, in their order, of the target's sliders that come with another robot."""
    visitor.inputs.clear()
    stand.machine.become(robot)
    visitor.input(last)
    return [label for label in visitor.inputs if label.startswith(("θ", "Tool", *"XYZ"))]


def test_the_sliders_are_those_of_the_robot(
    own_stand: Any, visit_own: Visit, planar_robot: Robot, tool_robot: Robot
) -> None:
    visitor = visit_own("anna")
    visitor.look()
    visitor.input("Z mm")
    own_stand.eventually(lambda: own_stand.server.get_clients())
    expected = ["θ1 °", "θ2 °", "X mm", "Z mm"]
    assert labels_after(visitor, own_stand, planar_robot, "Z mm") == expected
    visitor.send(type="GuiUpdateMessage", uuid=visitor.input("Z mm"), updates={"value": -200.0})
    wish = own_stand.eventually(lambda: own_stand.machine.of(FollowPoint))[-1]
    assert wish.xyz == (0.0, -200.0)
    expected = ["θ1 °", "θ2 °", "θ3 °", "Tool °", "X mm", "Y mm", "Z mm"]
    assert labels_after(visitor, own_stand, tool_robot, "Z mm") == expected
    visitor.send(type="GuiUpdateMessage", uuid=visitor.input("Tool °"), updates={"value": 90.0})
    wish = own_stand.eventually(lambda: own_stand.machine.of(FollowAngles))[-1]
    assert wish.theta[3] == pytest.approx(math.radians(90))


def test_who_only_watches_cannot_use_the_sliders_of_another_robot(
    own_stand: Any, visit_own: Visit, planar_robot: Robot
) -> None:
    visitor = visit_own("boris")
    visitor.look()
    visitor.input("Z mm")
    own_stand.eventually(lambda: own_stand.server.get_clients())
    own_stand.machine.be_held_by("anna")
    visitor.read(lambda m: m.get("updates") == {"disabled": True})
    visitor.inputs.clear()
    own_stand.machine.become(planar_robot)
    z = visitor.input("Z mm")
    visitor.read(lambda m: m.get("uuid") == z and m.get("updates") == {"disabled": True})


def test_every_kind_of_robot_takes_the_place_of_every_other(
    own_stand: Any, planar_robot: Robot, tool_robot: Robot
) -> None:
    """Drawn at its own pose, with nothing left over of the one before."""
    first = own_stand.machine.robot
    seen: dict[str, set[str]] = {}
    for robot in (planar_robot, tool_robot, first, planar_robot, tool_robot, first):
        own_stand.machine.become(robot)
        own_stand.eventually(lambda robot=robot: own_stand.scene._robot is robot)
        place = in_space(own_stand.machine.snapshot.xyz)
        own_stand.eventually(lambda place=place: np.allclose(drawn_tip(own_stand), place))
        assert seen.setdefault(robot.name, nodes(own_stand)) == nodes(own_stand)
    assert "/robot/effector/tool" in seen[tool_robot.name]
    assert "/robot/arm2" not in seen[planar_robot.name]


def test_a_tool_that_turns_is_shown_turned_and_at_its_limit_red(
    own_stand: Any, tool_robot: Robot
) -> None:
    own_stand.machine.become(tool_robot)
    own_stand.eventually(lambda: own_stand.scene._robot is tool_robot)
    xyz = (0.0, 0.0, -330.0)
    theta = (*tool_robot.inverse(xyz)[:3].tolist(), math.radians(-90))
    own_stand.machine.be_at(xyz, theta=theta, target_theta=theta, margins=(1.0, 1.0, 1.0, 0.0))
    tool = own_stand.server.scene.get_handle_by_name("/robot/effector/tool")
    half = math.sqrt(0.5)
    own_stand.eventually(lambda: np.allclose(tool.wxyz, (half, 0, 0, -half)))
    hub = own_stand.server.scene.get_handle_by_name("/robot/effector/tool/hub")
    own_stand.eventually(lambda: tuple(hub.color) == colours.tint(colours.STEEL, 0.0))


def test_an_unknown_pose_is_shown_as_a_shade(stand: Any) -> None:
    beam = stand.server.scene.get_handle_by_name("/robot/arm0/beam")
    stand.machine.snapshot = dataclasses.replace(stand.machine.snapshot, xyz=None, theta=None)
    stand.eventually(lambda: beam.opacity is not None)
    stand.machine.be_at((0.0, 0.0, -330.0))
    stand.eventually(lambda: beam.opacity is None)


def test_the_panel_tells_the_pose_as_people_write_it(stand: Any) -> None:
    readout = stand.scene._panel._readout
    stand.machine.be_at((-0.004, -0.04, -330.0))
    stand.eventually(lambda: "-330.0" in readout.content)
    assert "-0.0<" not in readout.content  # nothing is less than nothing
    stand.machine.snapshot = dataclasses.replace(stand.machine.snapshot, xyz=None, theta=None)
    stand.eventually(lambda: ")<div>Not known.</div>" in readout.content)


def test_a_robot_that_never_told_its_pose_is_whole(own_stand: Any, other_robot: Robot) -> None:
    """At its ready pose: arms, rods and effector hang together."""
    own_stand.machine.snapshot = dataclasses.replace(
        own_stand.machine.snapshot, xyz=None, theta=None, target_theta=None, target_xyz=None
    )
    own_stand.machine.loaded = Loaded(other_robot, own_stand.machine.loaded.text)
    own_stand.eventually(lambda: own_stand.scene._robot is other_robot)
    ready = other_robot.forward(other_robot.homing.ready) - other_robot.tool_offset
    assert drawn_tip(own_stand) == pytest.approx(ready)


def test_a_joint_at_its_limit_is_red(stand: Any) -> None:
    hubs = [stand.server.scene.get_handle_by_name(f"/robot/arm{i}/hub") for i in range(3)]
    stand.machine.be_at((0.0, 0.0, -330.0), margins=(1.0, 0.15, 0.0))
    stand.eventually(lambda: tuple(hubs[2].color) == colours.tint(colours.STEEL, 0.0))
    assert tuple(hubs[0].color) == colours.STEEL
    assert tuple(hubs[1].color) not in (tuple(hubs[0].color), tuple(hubs[2].color))


def test_sliders_show_the_target_unless_a_person_holds_them(stand: Any, visit: Visit) -> None:
    stand.machine.follows = False
    visitor = visit("anna")
    visitor.look()
    x, y = visitor.input("X mm"), visitor.input("Y mm")
    stand.eventually(lambda: stand.server.get_clients())
    visitor.send(type="GuiUpdateMessage", uuid=x, updates={"value": 77.7})
    stand.eventually(lambda: stand.machine.of(FollowPoint))
    stand.machine.be_at((0.0, 0.0, -330.0), target_xyz=(20.0, 33.3, -330.0))
    # Both sliders are moved to the target; the held one when it was let go.
    first = visitor.read(lambda m: m.get("updates") in ({"value": 20.0}, {"value": 33.3}))
    assert (first["uuid"], first["updates"]) == (y, {"value": 33.3})
    visitor.read(lambda m: m.get("uuid") == x and m.get("updates") == {"value": 20.0})


def test_a_refusal_is_told_to_who_asked(stand: Any, visit: Visit) -> None:
    stand.machine.refusal = "The robot is disabled. Press <Enable>."
    visitor = visit("anna")
    visitor.look()
    x = visitor.input("X mm")
    stand.eventually(lambda: stand.server.get_clients())
    visitor.send(type="GuiUpdateMessage", uuid=x, updates={"value": -12.3})
    note = visitor.read(lambda m: "disabled. Press" in str(m.get("updates", {}).get("content")))
    assert "&lt;Enable&gt;" in note["updates"]["content"]


def test_viewers_see_the_panel_and_cannot_use_it(stand: Any, visit: Visit) -> None:
    visitor = visit("boris")
    visitor.look()
    x = visitor.input("X mm")

    def set_to(disabled: bool) -> Callable[[dict[str, Any]], bool]:
        return lambda m: m.get("uuid") == x and m.get("updates") == {"disabled": disabled}

    visitor.read(set_to(False))
    stand.machine.be_held_by("anna")
    visitor.read(set_to(True))
    stand.machine.be_held_by("boris")
    visitor.read(set_to(False))


def test_the_theme_is_each_session_s_own(stand: Any, visit: Visit) -> None:
    day, night = visit("day"), visit("night")
    for visitor in (day, night):
        visitor.look()
        visitor.read(lambda m: m["type"] == "ThemeConfigurationMessage" and not m["dark_mode"])
    stand.eventually(lambda: len(stand.server.get_clients()) == 2)
    stand.scene.set_theme("night", True)
    night.read(lambda m: m["type"] == "ThemeConfigurationMessage" and m["dark_mode"])
    again = visit("night")
    again.look()
    again.read(lambda m: m["type"] == "ThemeConfigurationMessage" and m["dark_mode"])
    assert not [m for m in day.seen if m.get("dark_mode")]


def test_the_camera_s_yaw_is_its_session_s(
    stand: Any, visit: Visit, camera_message: dict[str, Any]
) -> None:
    assert stand.scene.camera_yaw("anna") is None
    visitor = visit("anna")
    # Looking along +y, up is z: right is +x.
    half = math.sqrt(0.5)
    visitor.send(**{**camera_message, "wxyz": [half, -half, 0, 0]})
    yaw = stand.eventually(lambda: stand.scene.camera_yaw("anna") is not None)
    assert yaw
    assert stand.scene.camera_yaw("anna") == pytest.approx(0.0, abs=1e-6)
    assert stand.scene.camera_yaw("boris") is None


def test_the_handle_stays_large_enough_for_a_finger(
    stand: Any, visit: Visit, camera_message: dict[str, Any]
) -> None:
    visitor = visit("anna")
    visitor.look()

    def radius_at(distance: float) -> float:
        position = [0.0, -distance, -0.33]
        visitor.send(**{**camera_message, "position": position, "image_height": 752})
        near = distance * 0.07 / 0.7
        message = visitor.read(
            lambda m: (
                m.get("name") == "/robot/effector/handle"
                and abs(m.get("updates", {}).get("scale", 0.0) / near - 0.5) < 0.5
            )
        )
        return message["updates"]["scale"]

    for distance in (1.0, 4.0):
        pixels = radius_at(distance) * 752 / (2 * math.tan(0.35) * distance)
        assert 2 * pixels >= 44


def test_the_trail_is_as_long_as_it_is(steady: np.random.Generator) -> None:
    trail = TrailPoints()
    assert trail.segments().shape == (SEGMENTS, 2, 3)
    now = 0.0
    points = np.cumsum(steady.normal(0, 4.0, (500, 3)), axis=0)
    for point in points:
        now += 0.02
        trail.pass_through(tuple(point), now)
        newest = trail.segments()[0, 0]
        assert newest == pytest.approx(point)
    segments = trail.segments()
    assert np.allclose(segments[1:, 0], segments[:-1, 1])  # one line
    trail.pass_through(tuple(points[-1]), now + 60.0)
    assert np.allclose(trail.segments(), points[-1])  # long forgotten


def test_the_outline_of_a_planar_workspace_is_a_rectangle_in_its_plane(planar_robot: Robot) -> None:
    corners = outline(planar_robot).reshape(-1, 3)
    assert not corners[:, 1].any()
    assert np.unique(corners[:, 0]) == pytest.approx([-0.1, 0.1])
    assert np.unique(corners[:, 2]) == pytest.approx([-0.24, -0.13])


@pytest.mark.parametrize(("reach", "depth"), [(0.24, (-0.44, -0.225)), (0.62, (-0.9, -0.65))])
def test_the_robot_fits_into_a_picture_that_is_a_little_upright(
    reach: float, depth: tuple[float, float]
) -> None:
    view = framing.frame(reach=reach, depth=depth)
    away = view.position - view.look_at
    half = math.atan(0.9 * math.tan(framing.FIELD_OF_VIEW / 2))
    assert math.asin(view.radius / np.linalg.norm(away)) <= half * 1.1
    assert view.floor < depth[0]
