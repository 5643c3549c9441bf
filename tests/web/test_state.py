"""The snapshot as JSON: every unit by its name, never NaN."""

from __future__ import annotations

import dataclasses
import json
import math
from typing import Any

import pytest

from deltaviz.machine.snapshot import LinkPhase, LinkStatus
from deltaviz.motion.held import Held
from deltaviz.web.state import state_json


@pytest.fixture
def tell(machine: Any, robot: Any) -> Any:
    def state(client: str = "me", waited: float = 0.0, **changes: Any) -> dict[str, Any]:
        snapshot = dataclasses.replace(machine.snapshot, **changes)
        told = state_json(snapshot, robot=robot, client=client, now=snapshot.at + waited)
        return json.loads(json.dumps(told, allow_nan=False))

    return state


def test_units(tell: Any, robot: Any) -> None:
    half = tuple(limit / 2 for limit in robot.limits.joint.velocity)
    fast = robot.limits.cartesian.velocity
    told = tell(
        theta=(math.radians(90), 0.0, -0.0),
        xyz=(1.25, -0.0, -300.0),
        theta_speed=half,
        xyz_speed=(-fast, 0.0, 2 * fast),
        target_xyz=(1.0, 2.0, -310.0),
        target_theta=(0.1, 0.2, 0.3),
        board_time=12.5,
        override=0.8,
    )
    assert told["theta_deg"] == [90.0, 0.0, 0.0]
    assert told["xyz_mm"] == [1.25, 0.0, -300.0]
    assert math.copysign(1, told["theta_deg"][2]) == math.copysign(1, told["xyz_mm"][1]) == 1
    assert told["theta_speed_share"] == [0.5, 0.5, 0.5]
    assert told["xyz_speed_share"] == [1.0, 0.0, 1.0]
    assert told["target_theta_deg"] == pytest.approx(
        [math.degrees(a) for a in (0.1, 0.2, 0.3)], abs=1e-4
    )
    assert (told["board_time_s"], told["override"], told["mode"]) == (12.5, 0.8, "idle")


def test_the_unknown_is_null(tell: Any) -> None:
    fields = ("theta", "xyz", "theta_speed", "xyz_speed", "command_theta", "command_xyz")
    told = tell(**dict.fromkeys((*fields, "target_theta", "target_xyz", "board_time")))
    nulls = [name for name, value in told.items() if value is None]
    assert {"theta_deg", "xyz_mm", "command_xyz_mm", "theta_speed_share"} <= set(nulls)
    assert tell(theta=(math.nan, math.inf, 1.0))["theta_deg"][:2] == [None, None]


def test_the_telemetry_s_age_grows_while_nothing_comes(tell: Any) -> None:
    link = LinkStatus(id="sim", phase=LinkPhase.READY, age=0.010, problem="Slow.")
    told = tell(link=link, waited=0.5)["link"]
    assert (told["id"], told["connected"], told["problem"]) == ("sim", True, "Slow.")
    assert told["age_ms"] == 510.0
    assert tell(link=LinkStatus(id="sim", phase=LinkPhase.CLOSED))["link"]["age_ms"] is None


def test_how_the_link_is_doing(tell: Any) -> None:
    link = LinkStatus(
        id="ttyusb0", phase=LinkPhase.READY, age=0.0042, board="stm32f407 1.2", note="Met again.",
        round_trip=0.00123, dropped=3, queued=6, queue_places=64, ahead=0.0587,
    )  # fmt: skip
    told = tell(link=link)["link"]
    assert told["phase"] == "ready"
    assert (told["age_ms"], told["round_trip_ms"], told["ahead_ms"]) == (4.2, 1.2, 58.7)
    assert (told["dropped"], told["queued"], told["queue_places"]) == (3, 6, 64)
    assert (told["board"], told["note"]) == ("stm32f407 1.2", "Met again.")
    unknown = tell(link=LinkStatus(id="ttyusb0", phase=LinkPhase.OPENING))["link"]
    assert (unknown["phase"], unknown["connected"]) == ("opening", False)
    assert unknown["round_trip_ms"] is None


@pytest.mark.parametrize(
    ("holder", "told"),
    [
        (None, {"holder": None, "you": False}),
        ("me", {"holder": "you", "you": True}),
        ("somebody", {"holder": "another", "you": False}),
    ],
)
def test_who_controls_without_naming_anybody(tell: Any, holder: str, told: Any) -> None:
    state = tell(holder=holder)
    assert state["control"] == told
    assert "somebody" not in json.dumps(state)


def test_what_holds_it(tell: Any) -> None:
    held = (Held("Arm 2 at its upper limit (90.0°)", 1, ("-X", "+Z")),)
    assert tell(held_by=held)["held_by"] == [
        {"limit": "Arm 2 at its upper limit (90.0°)", "arm": 1, "way_out": ["-X", "+Z"]}
    ]


def test_a_planar_robot_has_three_coordinates_too(tell: Any) -> None:
    told = tell(xyz=(5.0, -120.0), xyz_speed=(0.0, 0.0), theta=(0.1, 0.2))
    assert told["xyz_mm"] == [5.0, 0.0, -120.0]
    assert told["xyz_speed_share"] == [0.0, 0.0, 0.0]
    assert len(told["theta_deg"]) == 2
