"""Leads a bench to each phase of a session and each way of moving, to be hurt there."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

from deltaviz.link.messages import BoardState, Configure
from deltaviz.machine import intent as i
from deltaviz.machine.drive import warm_up
from deltaviz.machine.mode import Mode
from deltaviz.robots import Robot, load_robot
from tests.faults.wire_bench import LINK, WireBench
from tests.quick_homing import with_quick_homing

ME = "me"
ACCEPTED = i.Accepted()
SPEED = (150.0, 0.0, 0.0)  # mm/s

Phase = Callable[[WireBench], None]


@cache
def quick_robot() -> Robot:
    """The stm32 preset, which homes in two seconds rather than ten."""
    robot = load_robot("stm32")
    warm_up(robot)
    return with_quick_homing(robot)


def idle(bench: WireBench) -> None:
    bench.run_until(lambda: bench.mode is Mode.IDLE)


def greeting(bench: WireBench) -> None:
    idle(bench)
    assert bench.do(i.Disconnect(ME)) == ACCEPTED
    bench.run(0.01)
    assert bench.do(i.Connect(ME, LINK)) == ACCEPTED
    bench.run(0.004)


def configuring(bench: WireBench) -> None:
    greeting(bench)
    bench.sent.clear()
    bench.run_until(lambda: any(isinstance(x, Configure) for x in bench.sent))


def disabled(bench: WireBench) -> None:
    idle(bench)
    assert bench.do(i.Disable(ME)) == ACCEPTED
    bench.run_until(lambda: bench.mode is Mode.DISABLED)


def homing(bench: WireBench) -> None:
    idle(bench)
    assert bench.do(i.Home(ME)) == ACCEPTED
    bench.run(0.3)
    assert bench.board.state is BoardState.HOMING


def armed(bench: WireBench) -> None:
    idle(bench)
    assert bench.do(i.StepPoint(ME, (5.0, 0.0, 0.0))) == ACCEPTED
    bench.run_until(lambda: bench.mode is Mode.IDLE)
    assert bench.board.state is BoardState.ARMED


def jogging(bench: WireBench) -> None:
    idle(bench)
    bench.jog(SPEED, 0.2)


def moving(bench: WireBench, speed: float = 0.25) -> None:
    idle(bench)
    assert bench.do(i.MoveToPoint(ME, (90.0, -60.0, -320.0), speed)) == ACCEPTED
    bench.run(0.15)


def braking(bench: WireBench) -> None:
    moving(bench, 1.0)
    bench.do(i.Stop(ME, "Stop pressed"))
    bench.run(0.006)
    assert bench.board.state is BoardState.BRAKING


PHASES: dict[str, Phase] = {
    "greeting": greeting,
    "configuring": configuring,
    "disabled": disabled,
    "homing": homing,
    "armed at rest": armed,
    "jogging": jogging,
    "moving": moving,
    "braking": braking,
}
IN_MOTION = ("homing", "jogging", "moving", "braking")
