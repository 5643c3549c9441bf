"""What a browser may say to viser: decoded, checked, and written anew.

viser takes what it is given: NaN, 1e9, attributes that no input of ours has. So no byte of a
browser reaches it; what fits one of the types below is encoded again and passed on.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Annotated, Literal

import msgspec

MAX_FRAME = 64 * 1024
_FAR = 1e5  # no camera or pointer of ours is further away, in metres

Name = Annotated[str, msgspec.Meta(max_length=128)]
Vector = tuple[float, float, float]
Screen = tuple[float, float]
Pixels = Annotated[int, msgspec.Meta(ge=1, le=32768)]


class FrameError(ValueError):
    """A frame that no page of ours sends; the text says why."""


class Camera(
    msgspec.Struct, tag="ViewerCameraMessage", tag_field="type", forbid_unknown_fields=True
):
    """Where this browser looks from (viser's ViewerCameraMessage)."""

    wxyz: tuple[float, float, float, float]
    position: Vector
    fov: Annotated[float, msgspec.Meta(gt=0.0, lt=math.pi)]
    near: float
    far: float
    image_height: Pixels
    image_width: Pixels
    look_at: Vector
    up_direction: Vector


class GuiUpdate(
    msgspec.Struct, tag="GuiUpdateMessage", tag_field="type", forbid_unknown_fields=True
):
    """A new value of one input of the panel."""

    uuid: Name
    updates: dict[Name, bool | float | str]

    @property
    def value(self) -> bool | float | str:
        return self.updates["value"]


class NodeDrag(
    msgspec.Struct, tag="SceneNodeDragMessage", tag_field="type", forbid_unknown_fields=True
):
    """A node of the scene grabbed, moved or let go."""

    phase: Literal["start", "update", "end"]
    name: Name
    instance_index: int | None
    start_position: Vector
    start_screen_pos: Screen
    end_position: Vector
    end_screen_pos: Screen
    button: Literal["left", "middle", "right"]
    modifier: Name | None
    owner: Name = ""


class Click(
    msgspec.Struct, tag="ScenePointerMessage", tag_field="type", forbid_unknown_fields=True
):
    """A click anywhere in the picture, as a ray from the camera (viser's ScenePointerMessage); it
    is sent only where this browser was asked to."""

    event_type: Literal["click"]
    ray_origin: Vector
    ray_direction: Vector
    screen_pos: tuple[Screen]
    modifier: None


Frame = Camera | GuiUpdate | NodeDrag | Click

_decoder = msgspec.msgpack.Decoder(Frame)
_encoder = msgspec.msgpack.Encoder()


def decode(data: bytes) -> Frame:
    """The message in one binary frame. Raises FrameError for anything else."""
    if len(data) > MAX_FRAME:
        raise FrameError(f"{len(data)} bytes; at most {MAX_FRAME} are taken")
    try:
        frame = _decoder.decode(data)
    except (msgspec.DecodeError, RecursionError) as error:
        raise FrameError(str(error)) from error
    for number in _numbers(msgspec.structs.astuple(frame)):
        if not abs(number) <= _FAR:  # also false for NaN
            raise FrameError(f"{number} is no value of this scene")
    if isinstance(frame, GuiUpdate) and frame.updates.keys() != {"value"}:
        raise FrameError("exactly one value was expected")
    if isinstance(frame, Camera) and not 0.5 < math.hypot(*frame.wxyz) < 2.0:
        raise FrameError("the camera's orientation is no rotation")
    if isinstance(frame, Click) and not 0.5 < math.hypot(*frame.ray_direction) < 2.0:
        raise FrameError("the ray has no direction")
    return frame


def encode(frame: Frame) -> bytes:
    """The frame as viser reads it."""
    return _encoder.encode(frame)


def _numbers(value: object) -> Iterator[float]:
    if isinstance(value, dict):
        value = tuple(value.values())
    if isinstance(value, tuple):
        for item in value:
            yield from _numbers(item)
    elif isinstance(value, (int, float)):
        yield value
