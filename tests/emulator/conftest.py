"""The real firmware in QEMU, for a test to use: `emulated_board` starts boards, `wander` drives."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from random import Random
from typing import Any

import pytest

from deltaviz import load_robot
from deltaviz.machine.drive import make_follower, warm_up
from deltaviz.motion.goal import Goal, Rest, ToPoint
from deltaviz.motion.knot import Knot
from deltaviz.robots import Robot
from tests.emulator.emulated_board import EmulatedBoard
from tests.quick_homing import with_quick_homing

STEP, RAMP = 0.01, 0.1  # s


@pytest.fixture(scope="session")
def robot() -> Robot:
    """The stm32 preset, which homes in two seconds rather than ten, and has one motor reversed."""
    robot = load_robot("stm32")
    warm_up(robot)
    drive = replace(robot.drive, invert=(False, True, False))
    return replace(with_quick_homing(robot), drive=drive)


@pytest.fixture
def emulated_board(robot: Robot) -> Iterator[Callable[..., EmulatedBoard]]:
    """Start boards, switched on, that end with the test."""
    boards: list[EmulatedBoard] = []

    def start(**how: Any) -> EmulatedBoard:
        boards.append(EmulatedBoard(robot, **how))
        return boards[-1]

    yield start
    for board in boards:
        board.close()


@pytest.fixture
def ready_board(emulated_board: Callable[..., EmulatedBoard]) -> EmulatedBoard:
    """One that is connected, enabled and homed."""
    board = emulated_board()
    board.make_ready()
    return board


@pytest.fixture
def wander(robot: Robot) -> Callable[..., list[Knot]]:
    """Knots from the board's pose to random targets, at full speed, and to rest."""

    def knots(board: EmulatedBoard, *, seconds: float, seed: int) -> list[Knot]:
        assert board.session.theta is not None
        random, follower = Random(seed), make_follower(robot, board.session.theta)
        made: list[Knot] = []
        while sum(knot.duration for knot in made) < seconds:
            goal: Goal = ToPoint(_somewhere(robot, random))
            made += [follower.step(goal) for _ in range(random.randint(5, 40))]
        while any(made[-1].velocity):
            made.append(follower.step(Rest()))
        return made

    return knots


def _somewhere(robot: Robot, random: Random) -> tuple[float, float, float]:
    low, high = robot.zone.z
    radius = 0.7 * (robot.zone.radius or 0.0)
    return (
        random.uniform(-radius, radius),
        random.uniform(-radius, radius),
        random.uniform(low, high),
    )


@pytest.fixture
def steady() -> Callable[..., list[Knot]]:
    """Knots of all joints that get going in 0.1 s, go on at `speed` (rad/s), and with `rests` come
    to rest in 0.1 s.
    """

    def knots(
        board: EmulatedBoard, *, seconds: float, speed: float, rests: bool = False
    ) -> list[Knot]:
        start = board.session.theta
        assert start is not None
        made: list[Knot] = []
        way = before = 0.0
        count = round(seconds / STEP)
        for number in range(1, count + 1):
            left = (count - number) * STEP if rests else seconds
            now = speed * min(1.0, number * STEP / RAMP, left / RAMP)
            way += (before + now) / 2 * STEP
            before = now
            theta = tuple(angle + way for angle in start)
            made.append(Knot(duration=STEP, theta=theta, velocity=(now,) * len(start)))
        return made

    return knots
