"""A bench: controller and simulated board in this process, on a clock that tests turn."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from deltaviz.link.board import SimulatedBoard
from deltaviz.link.messages import BoardMessage, HostMessage, Segment
from deltaviz.link.rules import TICK_HZ
from deltaviz.machine import intent as i
from deltaviz.machine.controller import Controller
from deltaviz.machine.core import CloseLink, OpenLink
from deltaviz.machine.drive import FollowerMaker, Follows
from deltaviz.machine.mode import Mode
from deltaviz.machine.snapshot import Snapshot
from deltaviz.mechanism.margin import Margin, MarginKind
from deltaviz.motion import Follower
from deltaviz.robots import Robot, load_robot

EXAMPLES = Path(__file__).parents[2] / "docs" / "examples"
STEP = 0.002  # s between turns of the loop
ME = "me"


def steady_follower(robot: Robot, theta: Sequence[float]) -> Follows:
    """A follower that never runs out of time, whatever this computer is busy with."""
    follower = Follower(cast("Any", robot), theta, period=0.010, clock=lambda: 0.0)
    return cast("Follows", follower)


class Bench:
    """`cut` pulls the plug: nothing passes either way, the board goes on by itself."""

    def __init__(
        self,
        robot: Robot,
        *,
        homed: bool = True,
        link: str = "sim",
        follower: FollowerMaker = steady_follower,
        robots: dict[str, Callable[[], Robot]] | None = None,
    ) -> None:
        self.now = 1000.0
        self.homed = homed
        self.cut = False
        self.board: SimulatedBoard = None  # type: ignore[assignment]
        self.boards: list[SimulatedBoard] = []
        self.open = False
        self.sent: list[HostMessage] = []
        self.heard: list[BoardMessage] = []
        self.path: list[tuple[float, tuple[float, ...]]] = []  # time, position in microsteps
        self._ticks = 0
        self.robots = {"first": lambda: robot} | (robots or {})
        self.controller = Controller(
            robot,
            link=link,
            robots=self.robots,
            robot_id="first",
            follower=follower,
        )
        self.run(0.020)

    @property
    def robot(self) -> Robot:
        return self.controller.robot

    @property
    def mode(self) -> Mode:
        return self.controller.mode

    @property
    def snapshot(self) -> Snapshot:
        return self.controller.snapshot(self.now)

    def do(self, intent: i.Intent) -> i.Answer:
        return self.controller.handle(intent, self.now)

    def run(self, seconds: float, *, each: Callable[[], None] | None = None) -> None:
        """Let time pass; `each` is called before every turn."""
        for _ in range(round(seconds / STEP)):
            self.now += STEP
            self._advance_board()
            if each is not None:
                each()
            self._turn()

    def run_until(self, condition: Callable[[], bool], *, within: float = 5.0) -> None:
        end = self.now + within
        while not condition():
            assert self.now < end, f"still {self.mode} after {within} s: {self.snapshot}"
            self.run(STEP)

    def run_to_rest(self) -> None:
        """Until nothing moves any more, board included."""
        self.run_until(lambda: self.controller.at_rest and not self.board.moving)
        self.run(0.020)

    def jog(self, velocity: tuple[float, ...], seconds: float, *, press: str = "p") -> None:
        """Hold a jog in the base frame, with its heartbeats; it is still held afterwards."""
        answer = self.do(i.JogStart(ME, press, i.JogFrame.BASE, velocity, self.now))
        assert answer == i.Accepted(), answer
        self.hold(velocity, seconds, press=press)

    def hold(self, velocity: tuple[float, ...], seconds: float, *, press: str = "p") -> None:
        count = 0

        def beat() -> None:
            nonlocal count
            count += 1
            if count % 25 == 0:
                self.beat(velocity, press=press)

        self.run(seconds, each=beat)

    def beat(self, velocity: tuple[float, ...], *, press: str = "p") -> i.Answer:
        return self.do(
            i.JogBeat(ME, press, round(self.now * 1000), self.now * 1000, velocity, self.now)
        )

    def distance_moved(self, since: float) -> float:
        """The furthest that any motor has gone since then, in microsteps."""
        positions = [p for t, p in self.path if t >= since]
        return max(abs(a - b) for a, b in zip(positions[0], positions[-1], strict=True))

    def check_limits(self) -> None:
        """What the board executed stays within the joints' velocity and acceleration."""
        scale = np.array(self.robot.drive.microsteps_per_rad)
        theta = np.array([p for _, p in self.path]) / scale
        rate = np.diff(theta, axis=0) / STEP
        turn = np.diff(rate, axis=0) / STEP
        limits = self.robot.limits.joint
        assert np.all(np.abs(rate) <= np.array(limits.velocity) * 1.01)
        assert np.all(np.abs(turn) <= np.array(limits.acceleration) * 1.05)

    def segments(self) -> list[Segment]:
        return [message for message in self.sent if isinstance(message, Segment)]

    def _advance_board(self) -> None:
        if self.board is None:
            return
        due = round(self.now * TICK_HZ)
        homed = self.board.homed
        self.board.advance(due - self._ticks)
        self._ticks = due
        if self.board.homed != homed:
            self.path.clear()  # the counts were set anew, without a step
        if self.board.positions:
            self.path.append((self.now, tuple(p / 2**32 for p in self.board.positions)))

    def _turn(self) -> None:
        if self.open and not self.cut:
            heard = self.board.take()
            self.heard += heard
            self.controller.receive(heard, self.now)
        self._send(self._messages())
        self._follow_link()

    def _messages(self) -> list[HostMessage]:
        """What the controller says in one turn."""
        messages = self.controller.tick(self.now)
        for _ in range(100):
            if not self.controller.hungry(self.now):
                break
            messages += self.controller.tick(self.now)
        return messages

    def _send(self, messages: list[HostMessage]) -> None:
        self.sent += messages
        if self.open and not self.cut:
            for message in messages:
                self.board.receive(message)

    def _follow_link(self) -> None:
        action = self.controller.link_action()
        if isinstance(action, CloseLink | OpenLink):
            self.open = False
        if isinstance(action, OpenLink):
            self.board = SimulatedBoard(
                start_homed=self.homed, boot=len(self.boards) + 1, now=0xFFFF_FFFF - 1000
            )
            self.boards.append(self.board)
            self.path.clear()
            self._ticks = round(self.now * TICK_HZ)
            self.open = True
            self.controller.link_opened(self.now)

    def reconnect_same_board(self) -> None:
        """The cable is back: the same board, a new session."""
        board = self.board
        assert self.do(i.Connect(ME, "sim")) == i.Accepted()
        self._follow_link()
        self.board = board
        self.cut = False


@pytest.fixture(scope="session")
def stm32() -> Robot:
    return load_robot("stm32")


@pytest.fixture(scope="session")
def named_robot() -> Callable[[str], Robot]:
    """A preset, or "stm32-tool": the one with a tool that turns."""

    @cache
    def load(name: str) -> Robot:
        return load_robot(EXAMPLES / f"{name}.toml" if name == "stm32-tool" else name)

    return load


@pytest.fixture
def make_follower() -> FollowerMaker:
    return steady_follower


@pytest.fixture
def bench(stm32: Robot) -> Bench:
    return Bench(stm32)


@pytest.fixture
def make_bench(stm32: Robot) -> Callable[..., Bench]:
    def make(robot: Robot | None = None, **options: Any) -> Bench:
        return Bench(robot or stm32, **options)

    return make


@dataclass(frozen=True)
class Slides:
    """The kernel of a machine of n slides: axis i of the tip is 100 mm per rad of joint i."""

    joints: int
    reach: float = 1.0  # rad, both ways

    def inverse(self, xyz: np.ndarray) -> np.ndarray:
        return xyz / 100.0

    def forward(self, theta: np.ndarray) -> np.ndarray:
        return theta * 100.0

    def margins(self, xyz: np.ndarray, theta: np.ndarray) -> np.ndarray:
        inverse = xyz / 100.0
        return np.concatenate(((inverse + self.reach) * 100, (self.reach - inverse) * 100), axis=1)

    def joint_velocity(self, xyz: Any, theta: Any, velocity: np.ndarray) -> np.ndarray:
        return velocity / 100.0

    def tip_velocity(self, xyz: Any, theta: Any, rate: np.ndarray) -> np.ndarray:
        return rate * 100.0

    def warm_up(self) -> None:
        pass


def slides(joints: int) -> Robot:
    """A robot of `joints` slides, with the presets' limits."""
    base = load_robot("stm32")
    same = dict.fromkeys(range(joints), 0)

    def each(value: float) -> tuple[float, ...]:
        return tuple(value for _ in same)

    kernel = Slides(joints)
    robot = SimpleNamespace(
        name=f"slides{joints}",
        kind="slides",
        mechanism=SimpleNamespace(joints=joints),
        tool_offset=each(0.0),
        joint_count=joints,
        axes=("X", "Y", "Z", "U")[:joints],
        tool_axis=False,
        pose=lambda xyz, tool=None: np.asarray(xyz, dtype=float),
        joints=replace(base.joints, min=each(-1.0), max=each(1.0)),
        zone=SimpleNamespace(z=None, radius=None, x=None, y=None),
        limits=replace(
            base.limits,
            joint=replace(
                base.limits.joint,
                velocity=each(6.0),
                acceleration=each(80.0),
                unhomed_velocity=each(0.1),
            ),
        ),
        drive=replace(base.drive, microsteps_per_rad=each(509.3), invert=each(False)),
        homing=replace(
            base.homing,
            switch=each(-1.2),
            ready=each(0.0),
            fast=each(2.0),
            slow=each(0.5),
            backoff=each(base.homing.backoff[0]),
            max_travel=each(base.homing.max_travel[0]),
        ),
        kernel=kernel,
        margin_names=tuple(
            Margin(kind, arm)
            for kind in (MarginKind.JOINT_MIN, MarginKind.JOINT_MAX)
            for arm in range(joints)
        ),
        reach=lambda xyz: SimpleNamespace(legal=bool(np.all(np.abs(xyz) <= 100.0))),
        margins=lambda xyz, theta: kernel.margins(np.atleast_2d(xyz), np.atleast_2d(theta))[0],
        inverse=lambda xyz: np.asarray(xyz) / 100.0,
        forward=lambda theta: np.asarray(theta) * 100.0,
    )
    return cast("Robot", robot)


@pytest.fixture(params=[2, 4])
def slide_robot(request: pytest.FixtureRequest) -> Robot:
    return slides(request.param)
