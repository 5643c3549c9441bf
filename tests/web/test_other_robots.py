"""Surfaces speak three coordinates and one angle per joint, whatever the robot has."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from fastapi.testclient import TestClient

from deltaviz.machine import intent
from deltaviz.machine.intent import JogFrame
from deltaviz.robots import Robot, load_robot
from deltaviz.web.conversation import Conversation
from deltaviz.web.once import OncePerMinute
from deltaviz.web.session import HTTP_CLIENT

TOOL_AXIS = Path(__file__).parents[2] / "docs" / "examples" / "stm32-tool.toml"
NOW = 1000.0


@pytest.fixture
def become(machine: Any, robot: Robot) -> Iterator[Any]:
    """The machine with another robot, for one test."""

    def other(name: str | Path) -> Robot:
        machine.robot = load_robot(name)
        machine.reset()
        return machine.robot

    yield other
    machine.robot = robot


@pytest.fixture
def planar(become: Any) -> Robot:
    return become("fivebar")


@pytest.fixture
def turning(become: Any) -> Robot:
    return become(TOOL_AXIS)


def says(machine: Any, scene: Any, *messages: dict[str, Any]) -> list[dict[str, Any]]:
    """What a page is told back."""
    told_back: list[dict[str, Any]] = []
    conversation = Conversation(
        machine=machine, client="me", reply=told_back.append, scene=scene, logged=OncePerMinute()
    )
    for message in messages:
        conversation.hear(json.dumps(message), NOW)
    return told_back


class TestFiveBar:
    def test_kinematics(self, client: TestClient, planar: Robot) -> None:
        points = [[0, 0, -240], [-40.5, 0, -180]]
        angles = client.post("/api/ik", json={"xyz_mm": points}).json()["theta_deg"]
        assert angles[0] == pytest.approx([53.13010235415598] * 2)
        back = client.post("/api/fk", json={"theta_deg": angles}).json()["xyz_mm"]
        assert [len(point) for point in back] == [3, 3]
        for point, found in zip(points, back, strict=True):
            assert found == pytest.approx(point, abs=1e-9)

    @pytest.mark.parametrize(
        ("call", "body", "says"),
        [
            ("ik", {"xyz_mm": [0, 5, -240]}, "xyz_mm: Y must be 0, as fivebar is planar; got 5."),
            ("ik", {"xyz_mm": [[0, 0, -240], [0, -0.1, -240]]}, "xyz_mm[1]: Y must be 0"),
            ("fk", {"theta_deg": [0, 0, 0]}, "theta_deg needs 2 numbers"),
            ("fk", {"theta_deg": [[0, 0], [0, 0, 0]]}, "theta_deg[1] needs 2 numbers"),
            ("move", {"xyz_mm": [0, 1, -200]}, "xyz_mm: Y must be 0"),
            ("move", {"theta_deg": [0, 0, 0]}, "theta_deg needs 2 numbers"),
            ("jog", {"xyz_mm": [0, 1, 0]}, "xyz_mm: Y must be 0"),
        ],
    )
    def test_what_is_not_in_its_plane(
        self, client: TestClient, machine: Any, planar: Robot, call: str, body: Any, says: str
    ) -> None:
        answer = client.post(f"/api/{call}", json=body)
        assert answer.status_code == 422
        assert answer.json()["detail"].startswith(says)
        assert machine.told == []

    def test_calls_become_intents_in_its_plane(
        self, client: TestClient, machine: Any, planar: Robot
    ) -> None:
        client.post("/api/move", json={"xyz_mm": [10, 0, -200]})
        client.post("/api/jog", json={"xyz_mm": [1, -0.0, -2]})
        client.post("/api/move", json={"theta_deg": [30, 45]})
        assert machine.told == [
            intent.MoveToPoint(HTTP_CLIENT, (10, -200), 1.0),
            intent.StepPoint(HTTP_CLIENT, (1, -2), 1.0),
            intent.MoveToAngles(HTTP_CLIENT, (math.radians(30), math.radians(45)), 1.0),
        ]

    def test_it_is_described(self, client: TestClient, planar: Robot) -> None:
        told = client.get("/api/robot").json()
        assert (told["kind"], told["joints"], told["axes"]) == ("five_bar", 2, ["X", "Z"])
        assert told["joint_names"] == ["θ1", "θ2"]
        assert told["geometry"]["platform_half"] == [20.0, 20.0]
        assert told["geometry"]["tool_offset"] == [0.0, 0.0, 0.0]
        assert told["limits"]["joint"]["ball_joint_max_deg"] is None
        assert told["workspace"] == {"x": [-100, 100], "y": None, "z": [-240, -130], "radius": None}
        state = client.get("/api/state").json()
        assert len(state["xyz_mm"]) == 3
        assert len(state["theta_deg"]) == 2

    @pytest.mark.parametrize(
        ("yaw_deg", "seen", "meant"),
        [
            (0, [5, 0, 7], (5, 7)),
            (60, [5, 0, 7], (5, 7)),
            (-75, [5, 0, 0], (5, 0)),
            (180, [5, 0, 7], (-5, 7)),
            (120, [5, 0, 0], (-5, 0)),
            (90, [0, 0, 7], (0, 7)),
        ],
    )
    def test_right_in_the_picture_is_along_the_plane(
        self,
        machine: Any,
        scene: Any,
        planar: Robot,
        yaw_deg: float,
        seen: list[float],
        meant: tuple[float, float],
    ) -> None:
        scene.yaw = math.radians(yaw_deg)
        start = {"type": "jog_start", "id": "p1", "frame": "camera", "v_mm_s": seen}
        assert says(machine, scene, start) == []
        assert machine.told[0].velocity == pytest.approx(meant)

    @pytest.mark.parametrize(
        ("yaw_deg", "seen", "why"),
        [(90, [5, 0, 0], "looks along the plane"), (10, [0, 5, 0], "Y must be 0")],
    )
    def test_what_the_picture_has_no_direction_for(
        self, machine: Any, scene: Any, planar: Robot, yaw_deg: float, seen: Any, why: str
    ) -> None:
        scene.yaw = math.radians(yaw_deg)
        start = {"type": "jog_start", "id": "p1", "frame": "camera", "v_mm_s": seen}
        (refused,) = says(machine, scene, start)
        assert why in refused["detail"]
        assert machine.told == []

    def test_a_jog_out_of_its_plane_is_refused_and_its_beats_too(
        self, machine: Any, scene: Any, planar: Robot
    ) -> None:
        start = {"type": "jog_start", "id": "p1", "frame": "base", "v_mm_s": [0, 5, 0]}
        beat = {"type": "jog", "id": "p1", "seq": 1, "t_ms": 1, "v_mm_s": [0, 5, 0]}
        told = says(machine, scene, start, beat)
        assert [message["type"] for message in told] == ["refused", "refused"]
        assert machine.told == []


class TestTurningTool:
    def test_a_straight_move_may_turn_it(
        self, client: TestClient, machine: Any, turning: Robot
    ) -> None:
        client.post("/api/move", json={"xyz_mm": [1, 2, -300], "tool_deg": -90})
        client.post("/api/move", json={"theta_deg": [0, 0, 0, 90]})
        assert machine.told == [
            intent.MoveToPoint(HTTP_CLIENT, (1, 2, -300), 1.0, -math.pi / 2),
            intent.MoveToAngles(HTTP_CLIENT, (0, 0, 0, math.pi / 2), 1.0),
        ]

    @pytest.mark.parametrize(
        "body",
        [
            {"theta_deg": [0, 0, 0, 0], "tool_deg": 5},
            {"tool_deg": 5},
            {"xyz_mm": [0, 0, -300], "tool_deg": "5"},
            {"xyz_mm": [0, 0, -300], "tool_deg": 1e9},
        ],
    )
    def test_malformed(
        self, client: TestClient, machine: Any, turning: Robot, body: dict[str, Any]
    ) -> None:
        answer = client.post("/api/move", json=body)
        assert answer.status_code == 422
        assert answer.json()["detail"]
        assert machine.told == []

    def test_it_is_the_last_angle_everywhere(self, client: TestClient, turning: Robot) -> None:
        told = client.get("/api/robot").json()
        assert (told["joints"], told["tool_axis"]) == (4, True)
        assert told["joint_names"] == ["θ1", "θ2", "θ3", "Tool"]
        assert told["limits"]["joint"]["max_deg"] == [90, 90, 90, 175]
        assert len(client.get("/api/state").json()["theta_deg"]) == 4
        theta = client.post("/api/ik", json={"xyz_mm": [0, 0, -300]}).json()["theta_deg"]
        assert theta[3] == 0
        turned = client.post("/api/fk", json={"theta_deg": [*theta[:3], 77]}).json()["xyz_mm"]
        assert turned == pytest.approx([0, 0, -300])

    def test_its_jog_is_a_joints(self, machine: Any, scene: Any, turning: Robot) -> None:
        start = {"type": "jog_start", "id": "p", "frame": "joints", "v_deg_s": [0, 0, 0, 90]}
        assert says(machine, scene, start) == []
        rates = (0, 0, 0, math.pi / 2)
        assert machine.told == [intent.JogStart("me", "p", JogFrame.JOINTS, rates, NOW)]
