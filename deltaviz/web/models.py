"""What the HTTP calls take and give. Degrees and millimetres, as the names say."""

from __future__ import annotations

from typing import Annotated, Any, Literal, Self

from pydantic import BaseModel, ConfigDict, Discriminator, Field, Strict, Tag, model_validator

ID_PATTERN = r"^[a-z0-9][a-z0-9_-]{0,63}$"

# Bounds far outside any robot: what lies beyond is a mistake, and overflows nothing here.
Millimetres = Annotated[float, Strict(), Field(ge=-1e5, le=1e5, allow_inf_nan=False)]
Degrees = Annotated[float, Strict(), Field(ge=-36000, le=36000, allow_inf_nan=False)]
Share = Annotated[float, Strict(), Field(gt=0, le=1, allow_inf_nan=False)]

Point = Annotated[list[Millimetres], Field(min_length=3, max_length=3)]
Angles = Annotated[list[Degrees], Field(min_length=2, max_length=4)]

ONE, MANY = "one", "many"  # tags of the two forms; they name no field
TAGS = (ONE, MANY)


def _one_or_many(value: Any) -> str:
    is_nested = isinstance(value, list) and value and isinstance(value[0], list)
    return MANY if is_nested else ONE


class Model(BaseModel):
    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)


class Nothing(Model):
    """An empty object, which may be left out."""


class InverseQuestion(Model):
    """One tool tip position, or a list of them."""

    xyz_mm: Annotated[
        Annotated[Point, Tag(ONE)] | Annotated[list[Point], Tag(MANY)],
        Discriminator(_one_or_many),
        Field(examples=[[0, 0, -300]]),
    ]


class InverseAnswer(Model):
    theta_deg: list[float] | list[list[float]]


class ForwardQuestion(Model):
    """One set of joint angles, or a list of them."""

    theta_deg: Annotated[
        Annotated[Angles, Tag(ONE)] | Annotated[list[Angles], Tag(MANY)],
        Discriminator(_one_or_many),
        Field(examples=[[0, 0, 0]]),
    ]


class ForwardAnswer(Model):
    xyz_mm: list[float] | list[list[float]]


class _PointOrAngles(Model):
    xyz_mm: Annotated[Point | None, Field(examples=[[0, 0, -300]])] = None
    theta_deg: Annotated[Angles | None, Field(examples=[None])] = None
    speed: Annotated[Share, Field(description="share of the robot's limits")] = 1.0

    @model_validator(mode="after")
    def _one_of_both(self) -> Self:
        if (self.xyz_mm is None) == (self.theta_deg is None):
            raise ValueError("give either xyz_mm or theta_deg")
        return self


class Move(_PointOrAngles):
    """Where to: the tool tip, straight, or the joints. `tool_deg`: to where a tool that turns
    turns on a straight way."""

    tool_deg: Annotated[Degrees | None, Field(examples=[None])] = None

    @model_validator(mode="after")
    def _tool_of_a_point(self) -> Self:
        if self.tool_deg is not None and self.xyz_mm is None:
            raise ValueError("tool_deg goes with xyz_mm; theta_deg has the tool's angle itself")
        return self


class Step(_PointOrAngles):
    """One relative step of the tool tip, or of the joints."""


class RobotChoice(Model):
    robot: Annotated[str, Field(pattern=ID_PATTERN, examples=["stm32"])]


class LinkChoice(Model):
    link: Annotated[str, Field(pattern=ID_PATTERN, examples=["sim"])]


class ControlChange(Model):
    action: Literal["request", "release"]


class Taken(Model):
    """The request was taken; the state shows what comes of it."""

    accepted: Literal[True] = True


class Error(Model):
    detail: str


class Port(Model):
    """A link that can be chosen by its id."""

    id: str
    description: str
