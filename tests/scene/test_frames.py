from __future__ import annotations

import math
from typing import Any

import msgspec
import pytest
import viser._messages as messages

from deltaviz.scene import frames

NAN, INF = math.nan, math.inf


def encoded(message: dict[str, Any], **changes: Any) -> bytes:
    return msgspec.msgpack.encode({**message, **changes})


GUI = {"type": "GuiUpdateMessage", "uuid": "a", "updates": {"value": 1.5}}

CLICK = {
    "type": "ScenePointerMessage",
    "event_type": "click",
    "ray_origin": [0.9, -1.1, 0.3],
    "ray_direction": [-0.6, 0.7, -0.4],
    "screen_pos": [[0.4, 0.6]],
    "modifier": None,
}


def test_what_a_page_sends_reaches_viser_unchanged(
    camera_message: dict[str, Any], drag_message: dict[str, Any]
) -> None:
    for message in (camera_message, drag_message, GUI, CLICK):
        passed = frames.encode(frames.decode(encoded(message)))
        assert messages.Message.deserialize(passed) == messages.Message.deserialize(
            encoded(message)
        )


@pytest.mark.parametrize(
    "changes",
    [
        {"fov": NAN},
        {"fov": 0.0},
        {"fov": 4.0},
        {"position": [NAN, 0, 0]},
        {"position": [0, INF, 0]},
        {"position": [0, 0, 1e9]},
        {"position": [0, 0]},
        {"wxyz": [0, 0, 0, 0]},
        {"image_height": 0},
        {"image_height": "752"},
        {"extra": 1},
        {"type": "RunJavascriptMessage"},
    ],
)
def test_a_bad_camera_is_refused(camera_message: dict[str, Any], changes: dict[str, Any]) -> None:
    with pytest.raises(frames.FrameError):
        frames.decode(encoded(camera_message, **changes))


@pytest.mark.parametrize(
    "updates",
    [
        {},
        {"value": NAN},
        {"value": -INF},
        {"value": 1e9},
        {"value": None},
        {"value": [1.0]},
        {"value": 1.0, "label": "x"},
        {"disabled": False},
        {"content": "<script>"},
    ],
)
def test_an_update_of_anything_but_one_value_is_refused(updates: dict[str, Any]) -> None:
    with pytest.raises(frames.FrameError):
        frames.decode(encoded(GUI, updates=updates))


@pytest.mark.parametrize(
    "changes",
    [
        {"phase": "begin"},
        {"button": "any"},
        {"end_screen_pos": [NAN, 0.5]},
        {"start_position": [0, 0, INF]},
        {"name": "x" * 200},
        {"name": None},
    ],
)
def test_a_bad_drag_is_refused(drag_message: dict[str, Any], changes: dict[str, Any]) -> None:
    with pytest.raises(frames.FrameError):
        frames.decode(encoded(drag_message, **changes))


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"\xc1",
        b"\x00" * 10,
        b"\x91" * 60_000,
        msgspec.msgpack.encode([1, 2]),
        msgspec.msgpack.encode({"type": ["GuiUpdateMessage"]}),
        msgspec.msgpack.encode({"type": "ShareUrlRequest"}),
        msgspec.msgpack.encode({"type": "GuiButtonHoldMessage", "uuid": "a", "frequency": 1e9}),
        msgspec.msgpack.encode(GUI) + b"\x00",
        msgspec.msgpack.encode(GUI | {"updates": {"value": "x" * frames.MAX_FRAME}}),
    ],
    ids=range(10),
)
def test_garbage_is_refused(data: bytes) -> None:
    with pytest.raises(frames.FrameError):
        frames.decode(data)
