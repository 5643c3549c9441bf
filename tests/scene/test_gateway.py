"""What browsers may do to viser through the gateway, spoken by hand over real sockets."""

from __future__ import annotations

import contextlib
import itertools
import logging
import math
import socket
from collections.abc import Callable
from typing import Any

import httpx
import msgspec
import numpy as np
import pytest
import viser
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect

from deltaviz.machine.intent import DragStart, FollowAngles, FollowPoint
from deltaviz.scene import gateway

_new_values = itertools.count(11.0, 0.1)  # a slider that is where it was says nothing
Visit = Callable[[str | None], Any]


def at_ease(stand: Any, visit: Visit, session: str | None) -> Any:
    """A browser that viser counts as there."""
    before = len(stand.server.get_clients())
    visitor = visit(session)
    visitor.look()
    stand.eventually(lambda: len(stand.server.get_clients()) == before + 1)
    return visitor


def shows(node: str) -> Callable[[dict[str, Any]], bool]:
    return lambda m: m.get("name") == node and m.get("visible") is True


def still_answers(stand: Any, visitor: Any, label: str = "X mm") -> bool:
    count = len(stand.machine.of(FollowPoint))
    uuid = visitor.input(label)
    visitor.send(type="GuiUpdateMessage", uuid=uuid, updates={"value": next(_new_values)})
    return stand.eventually(lambda: len(stand.machine.of(FollowPoint)) > count)


@pytest.mark.parametrize(
    ("query", "served"),
    [
        ("", True),
        ("?fixedDpr=1", True),
        ("?fixedDpr=1.5", True),
        ("?websocket=ws://elsewhere", False),
        ("?playbackPath=/api/files/x", False),
        ("?fixedDpr=1&websocket=ws://elsewhere", False),
        ("?fixedDpr=", False),
        ("?fixedDpr=1;playbackPath=/x", False),
        ("?darkMode", False),
        ("?FIXEDDPR=1", False),
        ("?x", False),
    ],
)
def test_the_page_is_served_without_a_source_of_its_own(
    stand: Any, query: str, served: bool
) -> None:
    answer = httpx.get(stand.url + query)
    if served:
        assert answer.status_code == 200
        assert answer.headers["content-security-policy"].startswith("default-src 'none'; script")
    else:
        assert answer.status_code == 307
        assert answer.headers["location"] == "/scene/"


def test_the_page_without_its_slash_leads_to_it(stand: Any) -> None:
    answer = httpx.get(stand.url.removesuffix("/"))
    assert (answer.status_code, answer.headers["location"]) == (307, "/scene/")


def test_a_dark_session_gets_a_dark_page(stand: Any) -> None:
    stand.scene.set_theme("night", True)
    dark = httpx.get(stand.url, cookies={"session": "night"}).text
    light = httpx.get(stand.url, cookies={"session": "day"}).text
    assert len(dark) > len(light)


def test_the_subprotocol_is_viser_s(visit: Visit) -> None:
    assert visit("a").socket.subprotocol == f"viser-v{viser.__version__}"


def test_a_slider_posts_the_target_of_its_session(stand: Any, visit: Visit) -> None:
    visitor = at_ease(stand, visit, "anna")
    uuid = visitor.input("θ2 °")
    visitor.send(type="GuiUpdateMessage", uuid=uuid, updates={"value": 12})
    (intent,) = stand.eventually(lambda: stand.machine.of(FollowAngles))
    assert intent.client == "anna"
    assert intent.theta[1] == pytest.approx(math.radians(12))
    assert intent.theta[0] == pytest.approx(intent.theta[2])


@pytest.mark.parametrize(
    "frame",
    [
        b"garbage",
        "text",
        msgspec.msgpack.encode({"type": "ShareUrlRequest"}),
        msgspec.msgpack.encode({"type": "GuiUpdateMessage", "uuid": "no", "updates": {"value": 1}}),
        b"\x00" * (gateway.frames.MAX_FRAME + 1),
    ],
    ids=["garbage", "text", "sharing", "unknown input", "too large"],
)
def test_what_no_page_sends_closes_that_socket_only(
    stand: Any, visit: Visit, caplog: pytest.LogCaptureFixture, frame: bytes | str
) -> None:
    bystander, villain = at_ease(stand, visit, "anna"), visit("boris")
    with caplog.at_level(logging.WARNING, logger=gateway.__name__):
        villain.socket.send(frame)
        code, _ = villain.closed()
    assert code == 1008
    assert len(caplog.records) == 1
    assert still_answers(stand, bystander)


@pytest.mark.parametrize("value", [math.nan, math.inf, 1e9, -46.0, 90.2, True, "12", None, [1.0]])
def test_a_slider_takes_only_a_finite_value_in_its_range(
    stand: Any, visit: Visit, value: Any
) -> None:
    visitor = at_ease(stand, visit, "anna")
    uuid = visitor.input("θ1 °")
    visitor.send(type="GuiUpdateMessage", uuid=uuid, updates={"value": value})
    assert visitor.closed()[0] == 1008
    assert stand.machine.posted == []


def test_a_slider_has_no_other_attribute(stand: Any, visit: Visit) -> None:
    visitor = at_ease(stand, visit, "anna")
    uuid = visitor.input("θ1 °")
    visitor.send(type="GuiUpdateMessage", uuid=uuid, updates={"value": 1.0, "disabled": True})
    assert visitor.closed()[0] == 1008


@pytest.mark.parametrize("session", ["boris", None])
def test_who_has_no_control_cannot_steer(
    stand: Any, visit: Visit, drag_message: dict[str, Any], session: str | None
) -> None:
    stand.machine.be_held_by("anna")
    by_slider, by_drag = at_ease(stand, visit, session), at_ease(stand, visit, session)
    uuid = by_slider.input("θ1 °")
    by_slider.send(type="GuiUpdateMessage", uuid=uuid, updates={"value": 1.0})
    by_drag.send(**drag_message)
    assert by_slider.closed()[0] == by_drag.closed()[0] == 1008
    assert stand.machine.posted == []


def test_who_lost_control_a_moment_ago_is_not_thrown_out(
    stand: Any, visit: Visit, drag_message: dict[str, Any]
) -> None:
    visitor = at_ease(stand, visit, "anna")
    visitor.send(**drag_message)
    stand.eventually(lambda: stand.machine.of(DragStart))
    stand.machine.be_held_by("boris")
    slider, toggle = visitor.input("X mm"), visitor.input("Joint labels")
    visitor.send(type="GuiUpdateMessage", uuid=slider, updates={"value": 1.0})
    visitor.send(type="GuiUpdateMessage", uuid=toggle, updates={"value": True})
    visitor.read(shows("/labels"))  # the socket lives, and has dealt with both
    assert stand.machine.of(FollowPoint) == []


def test_anyone_may_choose_what_to_see(stand: Any, visit: Visit) -> None:
    stand.machine.be_held_by("anna")
    viewer = at_ease(stand, visit, "boris")
    uuid = viewer.input("Joint labels")
    viewer.send(type="GuiUpdateMessage", uuid=uuid, updates={"value": True})
    shown = viewer.read(
        lambda m: (
            m["type"] == "SetSceneNodeVisibilityMessage" and m["name"] == "/labels" and m["visible"]
        )
    )
    assert shown["visible"] is True


def test_what_one_browser_hides_others_still_see(stand: Any, visit: Visit) -> None:
    other, viewer = at_ease(stand, visit, "anna"), at_ease(stand, visit, "boris")
    uuid = viewer.input("Trail")
    viewer.send(type="GuiUpdateMessage", uuid=uuid, updates={"value": False})
    viewer.read(lambda m: m.get("name") == "/trail" and m.get("visible") is False)
    assert still_answers(stand, other)
    assert not [m for m in other.seen if m.get("name") == "/trail" and m.get("visible") is False]


def test_only_the_effector_can_be_dragged(
    stand: Any, visit: Visit, drag_message: dict[str, Any]
) -> None:
    visitor = at_ease(stand, visit, "anna")
    visitor.send(**{**drag_message, "name": "/robot/base"})
    assert visitor.closed()[0] == 1008


def flood(visitor: Any, frame: bytes) -> None:
    with contextlib.suppress(ConnectionClosed):
        for _ in range(20_000):
            visitor.socket.send(frame)


def test_a_flood_closes_its_own_socket(
    stand: Any, visit: Visit, camera_message: dict[str, Any]
) -> None:
    bystander, flooder = at_ease(stand, visit, "anna"), visit("boris")
    frame = msgspec.msgpack.encode(camera_message)
    flood(flooder, frame)
    assert flooder.closed()[0] == 1008
    assert still_answers(stand, bystander)


def moved_effector(message: dict[str, Any]) -> bool:
    return message["type"] == "SetPositionMessage" and message["name"] == "/robot/effector"


def test_a_browser_that_does_not_read_holds_up_nobody(stand: Any, visit: Visit) -> None:
    stuck, visitor = at_ease(stand, visit, "boris"), at_ease(stand, visit, "anna")
    stuck.socket.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    points = np.zeros((40_000, 3), dtype=np.float32)
    cloud = stand.server.scene.add_point_cloud("/load", points, (0, 0, 0))
    try:
        for i in range(40):  # 19 MB, more than all buffers on the way
            cloud.points = points + i
            stand.machine.be_at((0.1 * i + 0.1, 0.0, -330.0))
            visitor.read(moved_effector)
    finally:
        cloud.remove()
    assert still_answers(stand, visitor)


def test_without_viser_a_browser_is_turned_away(own_stand: Any) -> None:
    own_stand.scene._listener.close()
    with pytest.raises(InvalidStatus):
        connect(f"ws://127.0.0.1:{own_stand.port}/scene")
