"""Every call's good and bad input; what it asks of the machine, and what it answers."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient

from deltaviz.machine import intent
from deltaviz.machine.intent import RefusalKind, Refused
from deltaviz.robots import Robot, load_robot
from deltaviz.web.api import make_api
from deltaviz.web.session import HTTP_CLIENT

TOOL_AXIS = Path(__file__).parents[2] / "docs" / "examples" / "stm32-tool.toml"

RIGHT = math.radians(90)
TOLD: list[tuple[str, dict[str, Any] | None, int, Any]] = [
    ("stop", None, 200, ("stop", HTTP_CLIENT)),
    ("estop", None, 200, ("estop", HTTP_CLIENT)),
    ("enable", None, 200, intent.Enable(HTTP_CLIENT)),
    ("enable", {}, 200, intent.Enable(HTTP_CLIENT)),
    ("disable", None, 200, intent.Disable(HTTP_CLIENT)),
    ("home", None, 200, intent.Home(HTTP_CLIENT)),
    ("reset", None, 200, intent.Reset(HTTP_CLIENT)),
    ("pause", None, 200, intent.Pause(HTTP_CLIENT)),
    ("resume", None, 200, intent.Resume(HTTP_CLIENT)),
    ("disconnect", None, 200, intent.Disconnect(HTTP_CLIENT)),
    ("connect", {"link": "sim"}, 200, intent.Connect(HTTP_CLIENT, "sim")),
    ("robot", {"robot": "trossen"}, 200, intent.SelectRobot(HTTP_CLIENT, "trossen")),
    ("control", {"action": "request"}, 200, intent.RequestControl(HTTP_CLIENT)),
    ("control", {"action": "release"}, 200, intent.ReleaseControl(HTTP_CLIENT)),
    (
        "move",
        {"xyz_mm": [1, -2.5, -300]},
        202,
        intent.MoveToPoint(HTTP_CLIENT, (1, -2.5, -300), 1.0),
    ),
    (
        "move",
        {"theta_deg": [90, 0, -90], "speed": 0.5},
        202,
        intent.MoveToAngles(HTTP_CLIENT, (RIGHT, 0, -RIGHT), 0.5),
    ),
    (
        "jog",
        {"xyz_mm": [0, 0, 5], "speed": 0.25},
        202,
        intent.StepPoint(HTTP_CLIENT, (0, 0, 5), 0.25),
    ),
    (
        "jog",
        {"theta_deg": [0, 90, 0]},
        202,
        intent.StepAngles(HTTP_CLIENT, (0, RIGHT, 0), 1.0),
    ),
]


@pytest.mark.parametrize(("call", "body", "status", "told"), TOLD)
def test_a_call_becomes_an_intent(
    client: TestClient, machine: Any, call: str, body: Any, status: int, told: Any
) -> None:
    answer = client.post(f"/api/{call}", json=body)
    assert (answer.status_code, answer.json()) == (status, {"accepted": True})
    assert machine.told == [told]


REFUSABLE = [(call, body) for call, body, _, _ in TOLD if call not in ("stop", "estop")]


@pytest.mark.parametrize(("call", "body"), REFUSABLE)
@pytest.mark.parametrize(
    ("kind", "status"),
    [(RefusalKind.MODE, 409), (RefusalKind.CONTROL, 409), (RefusalKind.VALUE, 422)],
)
def test_a_refusal_keeps_its_words(
    client: TestClient, machine: Any, call: str, body: Any, kind: RefusalKind, status: int
) -> None:
    machine.answer = Refused(kind, "Not now, because.")
    answer = client.post(f"/api/{call}", json=body)
    assert (answer.status_code, answer.json()) == (status, {"detail": "Not now, because."})


@pytest.mark.parametrize("call", ["stop", "estop"])
def test_a_stop_takes_any_body_and_asks_nobody(client: TestClient, machine: Any, call: str) -> None:
    machine.answer = None  # a controller that answers nothing
    for content in (b"", b"{", b"[1]", b'{"unknown": 1}', b"\xff" * 1000):
        assert client.post(f"/api/{call}", content=content).status_code == 200
    assert machine.told == [(call, HTTP_CLIENT)] * 5


def test_a_controller_that_is_gone_is_told_as_such(client: TestClient, machine: Any) -> None:
    machine.answer = BrokenPipeError()
    answer = client.post("/api/home")
    assert answer.status_code == 503
    assert "controller" in answer.json()["detail"]


POINT = {"xyz_mm": [0, 0, -300]}
BAD: list[tuple[str, str, str]] = [  # call, body as sent, what the sentence must name
    ("move", "", "JSON object"),
    ("move", "null", "JSON object"),
    ("move", "[]", "JSON object"),
    ("move", "7", "JSON object"),
    ("move", "{", "no JSON"),
    ("move", "[" * 5000, "no JSON"),
    ("move", "{}", "xyz_mm"),
    ("move", '{"xyz_mm": [0, 0, -300], "theta_deg": [0, 0, 0]}', "either"),
    ("move", '{"xyz_mm": [0, 0]}', "xyz_mm"),
    ("move", '{"xyz_mm": [0, 0, -300, 1]}', "xyz_mm"),
    ("move", '{"xyz_mm": [[0, 0, -300]]}', "xyz_mm"),
    ("move", '{"xyz_mm": "0,0,-300"}', "xyz_mm"),
    ("move", '{"xyz_mm": {"0": 1}}', "xyz_mm"),
    ("move", '{"xyz_mm": [0, NaN, -300]}', "xyz_mm[1]"),
    ("move", '{"xyz_mm": [0, 0, -Infinity]}', "xyz_mm[2]"),
    ("move", '{"xyz_mm": [0, 0, 1e999]}', "xyz_mm[2]"),
    ("move", '{"xyz_mm": [0, 0, 1e9]}', "xyz_mm[2]"),
    ("move", '{"xyz_mm": [0, 0, ' + "9" * 400 + "]}", "xyz_mm[2]"),
    ("move", '{"xyz_mm": [0, 0, null]}', "xyz_mm[2]"),
    ("move", '{"xyz_mm": [0, 0, true]}', "xyz_mm[2]"),
    ("move", '{"xyz_mm": [0, 0, "-300"]}', "xyz_mm[2]"),
    ("move", '{"theta_deg": [0, 0]}', "theta_deg needs 3 numbers"),
    ("move", '{"theta_deg": [0, 0, 0, 0]}', "theta_deg needs 3 numbers"),
    ("move", '{"xyz_mm": [0, 0, -300], "speed": 0}', "speed"),
    ("move", '{"xyz_mm": [0, 0, -300], "speed": 1.01}', "speed"),
    ("move", '{"xyz_mm": [0, 0, -300], "speed": NaN}', "speed"),
    ("move", '{"xyz_mm": [0, 0, -300], "spede": 1}', "spede"),
    ("jog", '{"xyz_mm": [0, 0, NaN]}', "xyz_mm[2]"),
    ("jog", "{}", "xyz_mm"),
    ("jog", '{"theta_deg": [1]}', "theta_deg"),
    ("enable", '{"now": true}', "now"),
    ("home", "[1]", "JSON object"),
    ("connect", "{}", "link"),
    ("connect", '{"link": "/dev/ttyUSB0"}', "link"),
    ("connect", '{"link": "socket://evil.example:1"}', "link"),
    ("connect", '{"link": 7}', "link"),
    ("robot", '{"robot": "../../etc/passwd"}', "robot"),
    ("robot", '{"robot": "Stm32"}', "robot"),
    ("robot", '{"robot": ""}', "robot"),
    ("robot", json.dumps({"robot": "a" * 65}), "robot"),
    ("robot", json.dumps({"robot": "stm32\n"}), "robot"),
    ("control", '{"action": "steal"}', "action"),
    ("control", "{}", "action"),
    ("ik", "{}", "xyz_mm"),
    ("ik", '{"xyz_mm": []}', "xyz_mm"),
    ("ik", '{"xyz_mm": [[]]}', "xyz_mm[0]"),
    ("ik", '{"xyz_mm": [[0, 0, -300], [0, 0]]}', "xyz_mm[1]"),
    ("ik", '{"xyz_mm": [[0, 0, -300], 7]}', "xyz_mm[1]"),
    ("ik", '{"xyz_mm": [[0, 0, -300], [0, 0, NaN]]}', "xyz_mm[1][2]"),
    ("ik", '{"xyz_mm": [0, 0, -300], "robot": "x"}', "robot"),
    ("fk", '{"theta_deg": [0, 0]}', "theta_deg needs 3 numbers"),
    ("fk", '{"theta_deg": [[0, 0, 0], [0, 0, 0, 0]]}', "theta_deg"),
    ("fk", '{"theta_deg": [0, 0, Infinity]}', "theta_deg[2]"),
]


@pytest.mark.parametrize(("call", "body", "named"), BAD)
def test_malformed_input_is_told_in_a_sentence_and_reaches_nobody(
    client: TestClient, machine: Any, call: str, body: str, named: str
) -> None:
    headers = {"content-type": "application/json"}
    answer = client.post(f"/api/{call}", content=body, headers=headers)
    assert answer.status_code == 422
    assert answer.json().keys() == {"detail"}
    detail = answer.json()["detail"]
    assert named in detail
    assert detail.endswith(".")
    assert "\n" not in detail
    assert len(detail) < 300
    assert machine.told == []


def test_a_body_that_is_not_said_to_be_json_is_not_taken(client: TestClient, machine: Any) -> None:
    answer = client.post(
        "/api/move", content=json.dumps(POINT), headers={"content-type": "text/plain"}
    )
    assert answer.status_code == 422
    assert machine.told == []


@pytest.mark.parametrize(
    ("method", "path", "status"),
    [
        ("GET", "/api/nothing", 404),
        ("GET", "/nothing.js", 404),
        ("GET", "/api/stop", 405),  # no GET acts
        ("GET", "/api/move", 405),
        ("PUT", "/api/stop", 405),
        ("POST", "/api/state", 405),
        ("DELETE", "/api/robot", 405),
    ],
)
def test_what_is_not_there(
    client: TestClient, machine: Any, method: str, path: str, status: int
) -> None:
    answer = client.request(method, path)
    assert answer.status_code == status
    assert answer.json().keys() == {"detail"}
    assert machine.told == []


def test_inverse_and_forward_are_each_others(client: TestClient) -> None:
    points = [[0, 0, -300], [30.5, -20, -350]]
    angles = client.post("/api/ik", json={"xyz_mm": points}).json()["theta_deg"]
    back = client.post("/api/fk", json={"theta_deg": angles}).json()["xyz_mm"]
    for point, found in zip(points, back, strict=True):
        assert found == pytest.approx(point, abs=1e-9)
    one = client.post("/api/ik", json={"xyz_mm": points[1]}).json()["theta_deg"]
    assert one == angles[1]
    assert client.post("/api/fk", json={"theta_deg": one}).json()["xyz_mm"] == back[1]


def test_kinematics_know_geometry_only(client: TestClient, robot: Any) -> None:
    beyond = math.degrees(robot.joints.min[0]) - 5
    answer = client.post("/api/fk", json={"theta_deg": [beyond] * 3})
    assert answer.status_code == 200
    point = answer.json()["xyz_mm"]
    assert not robot.reach(point).legal
    assert client.post("/api/ik", json={"xyz_mm": point}).status_code == 200


def test_out_of_reach_names_the_first_of_a_list(client: TestClient, robot: Any) -> None:
    far = [0, 0, -5000]
    one = client.post("/api/ik", json={"xyz_mm": far})
    assert one.status_code == 422
    assert one.json()["detail"] == str(robot.reach(far))
    many = client.post("/api/ik", json={"xyz_mm": [[0, 0, -300], far, far]})
    assert many.status_code == 422
    assert many.json()["detail"].startswith("xyz_mm[1]: ")


def test_angles_without_a_pose(client: TestClient) -> None:
    sets = [[0, 0, 0], [0, -180, 0]]
    answer = client.post("/api/fk", json={"theta_deg": sets})
    assert answer.status_code == 422
    assert answer.json()["detail"].startswith("theta_deg[1]: ")
    assert client.post("/api/fk", json={"theta_deg": sets[1]}).status_code == 422


def test_the_robot_is_described_for_people_and_programs(client: TestClient, robot: Any) -> None:
    told = client.get("/api/robot").json()
    assert told["name"] == "stm32"
    assert told["joints"] == 3
    assert told["geometry"]["upper_arm"] == [125.0] * 3
    assert told["limits"]["joint"]["min_deg"] == [-45.0] * 3
    assert told["limits"]["cartesian"]["velocity"] == robot.limits.cartesian.velocity
    assert told["workspace"]["z"] == list(robot.zone.z)
    assert "stm32" in told["presets"]


def test_a_robot_from_a_file_can_be_chosen_again(machine: Any, robot: Robot) -> None:
    app = FastAPI()
    machine = type(machine)(load_robot(TOOL_AXIS))
    name = machine.robot.name
    app.include_router(make_api(machine))
    with TestClient(app) as client:
        machine.robot = robot  # another was chosen
        told = client.get("/api/robot").json()
    assert told["name"] == "stm32"
    assert name in told["presets"]


def test_the_links_are_listed_by_id_and_without_their_urls(client: TestClient) -> None:
    assert client.get("/api/ports").json() == [
        {"id": "sim", "description": "Simulated board"},
        {"id": "ttyusb0", "description": "A port"},
    ]


@pytest.mark.parametrize("link", ["ttyusb1", "emulate"])
def test_a_link_that_is_not_there_is_refused(client: TestClient, machine: Any, link: str) -> None:
    answer = client.post("/api/connect", json={"link": link})
    assert answer.status_code == 422
    assert answer.json()["detail"] == f"There is no link '{link}'; there is: sim, ttyusb0."
    assert machine.told == []
