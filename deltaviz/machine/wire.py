"""What passes between the machine's process and its parent, besides intents and snapshots."""

from __future__ import annotations

from dataclasses import dataclass

from deltaviz.machine import intent as i
from deltaviz.machine.loop_stats import LoopStats
from deltaviz.machine.snapshot import Snapshot

# What could begin a motion: of these, all that were posted before a stop are dead after it.
BEGINS_MOTION = (
    i.Enable,
    i.Home,
    i.Reset,
    i.Resume,
    i.MoveToPoint,
    i.MoveToAngles,
    i.StepPoint,
    i.StepAngles,
    i.JogStart,
    i.DragStart,
    i.DragTo,
    i.FollowPoint,
    i.FollowAngles,
)
STOPPED_SINCE = i.Refused(
    i.RefusalKind.MODE, "The robot was stopped after this was asked for; ask again."
)
LOADING = i.Refused(
    i.RefusalKind.MODE, "Another robot is being loaded; wait until it is shown, then ask again."
)


@dataclass(frozen=True, slots=True)
class Setup:
    """`robots` are names or paths by id; `link` is the URL that was given, `capture` a path."""

    robot: str
    robots: dict[str, str]
    link: str
    capture: str | None = None


@dataclass(frozen=True, slots=True)
class StatsRequest:
    """Asks for the loop's periods since the last request, and starts counting anew."""


@dataclass(frozen=True, slots=True)
class Posted:
    """`number` grows with each one posted."""

    number: int
    what: i.Intent | StatsRequest


@dataclass(frozen=True, slots=True)
class Halt:
    """A stop by the pipe of its own. `after` is the number of the last one posted before it."""

    after: int
    what: i.Stop | i.EStop


@dataclass(frozen=True, slots=True)
class Answered:
    number: int
    answer: i.Answer | LoopStats


@dataclass(frozen=True, slots=True)
class Failed:
    """The process ends because of an error of its own."""

    problem: str


@dataclass(frozen=True, slots=True)
class Driven:
    """The text of the robot that is driven from now on, as it was read; before all snapshots of it.

    A robot file may have changed since the parent read it, and may change or go at any time.
    """

    text: str


FromProcess = Answered | Driven | Failed | Snapshot
