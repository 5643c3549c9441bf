"""What a page says on /ws. Degrees and millimetres, as the names say."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import ConfigDict, Field, Strict, TypeAdapter, model_validator

from deltaviz.web.models import Angles, Model, Point

JogId = Annotated[str, Field(pattern=r"^[A-Za-z0-9_-]{1,64}$")]
Sequence = Annotated[int, Strict(), Field(ge=0, le=2**53)]
PageTime = Annotated[float, Strict(), Field(ge=0, le=1e15, allow_inf_nan=False)]  # ms
Override = Annotated[float, Strict(), Field(ge=0, le=1.5, allow_inf_nan=False)]

Frame = Literal["base", "camera", "joints"]


class _Velocity(Model):
    v_mm_s: Point | None = None
    v_deg_s: Angles | None = None

    @model_validator(mode="after")
    def _one_of_both(self) -> Self:
        if (self.v_mm_s is None) == (self.v_deg_s is None):
            raise ValueError("give either v_mm_s or v_deg_s")
        return self


class JogStart(_Velocity):
    type: Literal["jog_start"]
    id: JogId
    frame: Frame

    @model_validator(mode="after")
    def _units_of_the_frame(self) -> Self:
        if (self.frame == "joints") != (self.v_deg_s is not None):
            raise ValueError("frame 'joints' takes v_deg_s, the others v_mm_s")
        return self


class Jog(_Velocity):
    """The heartbeat of a held jog."""

    type: Literal["jog"]
    id: JogId
    seq: Sequence
    t_ms: PageTime


class JogEnd(Model):
    type: Literal["jog_end"]
    id: JogId


class DragAlive(Model):
    type: Literal["drag_alive"]
    seq: Sequence
    t_ms: PageTime


class SetOverride(Model):
    type: Literal["override"]
    value: Override


class _Stopping(Model):
    """Whatever else it says, it stops."""

    model_config = ConfigDict(extra="ignore")


class Stop(_Stopping):
    type: Literal["stop"]


class EStop(_Stopping):
    type: Literal["estop"]


class Control(Model):
    type: Literal["control"]
    action: Literal["request", "release"]


class Theme(Model):
    """How this page's scene is to look."""

    type: Literal["theme"]
    dark: Annotated[bool, Strict()]


class Show(Model):
    """Choose an item of this page's view of the scene, by its key."""

    type: Literal["show"]
    item: Annotated[str, Field(min_length=1, max_length=80)]
    value: (
        Annotated[bool, Strict()]
        | Annotated[float, Strict(), Field(allow_inf_nan=False)]
        | Annotated[str, Field(max_length=200)]
    )


PageMessage = (
    JogStart | Jog | JogEnd | DragAlive | SetOverride | Stop | EStop | Control | Theme | Show
)

PAGE_MESSAGE: TypeAdapter[PageMessage] = TypeAdapter(
    Annotated[PageMessage, Field(discriminator="type")]
)
TYPES = (
    "jog_start",
    "jog",
    "jog_end",
    "drag_alive",
    "override",
    "stop",
    "estop",
    "control",
    "theme",
    "show",
)
