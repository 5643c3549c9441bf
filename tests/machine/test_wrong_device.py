"""What stands at the port is not what it should be: the page says what it is and what to do, and
nothing moves.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

import pytest

from deltaviz.link import messages as m
from deltaviz.link.board import SimulatedBoard
from deltaviz.link.configuration import configuration_hash, configure_from
from deltaviz.machine import intent as i
from deltaviz.machine.mode import Mode
from deltaviz.machine.snapshot import LinkPhase
from deltaviz.robots import Robot, load_robot
from tests.link.cable import Cable, SocketCable
from tests.link.strangers import (
    Answering,
    Deaf,
    Gps,
    Machine,
    OtherBaud,
    OtherVersion,
    Stranger,
    echo,
    silent,
)
from tests.machine.cable_bench import LINK, CableBench
from tests.machine.test_broken import ACCEPTED, ME

HELLO = m.HelloReply(
    version=m.PROTOCOL_VERSION, board="b", build="1", joints=0, tick_hz=200_000, queue_places=64,
    boot=1, last_epoch=0, homed=False, configuration=0, last_stop=m.StopCause.BOOT,
)  # fmt: skip
MESSAGE_BOX = 200  # characters that it shows without being scrolled


class StrangerBench(CableBench):
    """Instead of a board, `stranger` is plugged in."""

    stranger: Stranger | None = None
    _answer = b""

    def _carry_to_board(self) -> None:
        if self.stranger is None or self._host is None or self.transport is None:
            super()._carry_to_board()
            return
        data = self.cable.hear_bytes(self._host.written - self._heard)
        self._heard += len(data)
        self._answer = self.stranger(data)

    def _carry_to_host(self) -> None:
        if self.stranger is None:
            super()._carry_to_host()
        elif self.transport is not None and not self.transport.closed:
            answer, self._answer = self._answer, b""
            self._tell(answer)


@pytest.fixture(params=[Cable, SocketCable], ids=["terminal", "socket"])
def make(stm32: Robot, request: pytest.FixtureRequest) -> Iterator[Callable[..., StrangerBench]]:
    benches: list[StrangerBench] = []

    def make(stranger: Stranger | None = None, robot: Robot | None = None) -> StrangerBench:
        bench = StrangerBench(robot or stm32, cable=request.param)
        benches.append(bench)
        assert bench.do(i.Disconnect(ME)) == ACCEPTED
        bench.run(0.01)
        bench.plug_in()
        bench.stranger = stranger
        bench.sent.clear()
        assert bench.do(i.Connect(ME, LINK)) == ACCEPTED
        return bench

    yield make
    for bench in benches:
        bench.close()


def problem(bench: StrangerBench, within: float) -> str:
    """What the page says once the link is given up."""
    bench.run_until(lambda: bench.snapshot.link.problem is not None, within=within)
    bench.run(0.01)
    assert bench.mode is Mode.OFFLINE
    assert bench.snapshot.link.phase is LinkPhase.CLOSED
    assert not [x for x in bench.sent if isinstance(x, m.Enable | m.Arm | m.Home | m.Segment)]
    said = str(bench.snapshot.link.problem)
    assert len(said) <= MESSAGE_BOX, said
    assert said.endswith(".")
    return said


STRANGERS: list[tuple[Callable[[], Stranger], float, str]] = [
    (lambda: silent, 10.1, "not a byte came"),
    (Machine, 2.1, "says 'Grbl 1.1h ['$' for help]'"),
    (Gps, 2.1, "says '$GPGGA"),
    (lambda: echo, 2.1, "sends back what it hears"),
    (OtherBaud, 2.1, "baud rate"),
    (Deaf, 10.1, "does not seem to hear this computer"),
    (lambda: OtherVersion(m.PROTOCOL_VERSION + 1), 0.1, "Update deltaviz"),
    (lambda: OtherVersion(m.PROTOCOL_VERSION - 1), 0.1, "Flash the firmware"),
    (lambda: Answering(replace(HELLO, joints=2)), 0.1, "drives 2 joints, the robot has 3"),
    (lambda: Answering(HELLO), 1.2, "did not answer 'configure'"),
]


@pytest.mark.parametrize(("stranger", "within", "says"), STRANGERS, ids=[x[2] for x in STRANGERS])
def test_a_stranger_is_told_with_the_way_out(
    make: Callable[..., StrangerBench],
    stranger: Callable[[], Stranger],
    within: float,
    says: str,
) -> None:
    bench = make(stranger())
    bench.run(0.03)
    assert says in problem(bench, within)


def test_while_it_is_waited_for_the_page_says_so_and_lets_it_be_given_up(
    make: Callable[..., StrangerBench],
) -> None:
    bench = make(silent)
    bench.run(1.0)
    assert bench.snapshot.link.phase is LinkPhase.GREETING
    assert bench.snapshot.next_step == f"Waiting for the board on {LINK} to answer."
    bench.do(i.Stop(ME, "Stop pressed"))
    assert bench.do(i.Disconnect(ME)) == ACCEPTED
    bench.run(0.01)
    assert bench.snapshot.link.phase is LinkPhase.CLOSED
    assert bench.snapshot.link.problem is None


def another_robots_board(robot: Robot, *, enabled: bool) -> SimulatedBoard:
    board = SimulatedBoard(boot=3)
    board.receive(m.Hello(m.PROTOCOL_VERSION))
    board.receive(configure_from(robot))
    if enabled:
        board.receive(m.Enable(on=True))
    board.take()
    return board


def test_a_board_that_is_on_for_another_robot(make: Callable[..., StrangerBench]) -> None:
    trossen = load_robot("trossen")
    digest = configuration_hash(configure_from(trossen))
    bench = make()
    bench.controller._robot_of = {digest: "trossen"}.get
    bench.plug_in(another_robots_board(trossen, enabled=True))
    assert bench.do(i.Connect(ME, LINK)) == ACCEPTED
    said = problem(bench, 0.1)
    assert "set up for trossen and its drivers are on. Choose trossen" in said
    assert bench.board.state is m.BoardState.HALTED, "and it was left as it is"


def test_a_board_that_is_on_for_a_robot_nobody_knows(make: Callable[..., StrangerBench]) -> None:
    bench = make()
    bench.plug_in(another_robots_board(load_robot("trossen"), enabled=True))
    assert bench.do(i.Connect(ME, LINK)) == ACCEPTED
    assert "another robot" in problem(bench, 0.1)


def test_a_board_that_is_off_is_set_up_anew(make: Callable[..., StrangerBench]) -> None:
    bench = make()
    bench.plug_in(another_robots_board(load_robot("trossen"), enabled=False))
    assert bench.do(i.Connect(ME, LINK)) == ACCEPTED
    bench.run_until(lambda: bench.mode is Mode.DISABLED, within=0.1)
    assert not bench.snapshot.homed


def with_drive(robot: Robot, **changes) -> Robot:
    return replace(robot, drive=replace(robot.drive, **changes))


def with_joints(robot: Robot, **changes) -> Robot:
    joint = replace(robot.limits.joint, **changes)
    return replace(robot, limits=replace(robot.limits, joint=joint))


CONTRADICTIONS: list[tuple[Callable[[Robot], Robot], str]] = [
    (
        lambda r: with_drive(r, microsteps_per_rad=(509.0, 50_000.0, 509.0)),
        "joint 2 would take 296706 steps a second, and 99800 is the most",
    ),
    (
        lambda r: with_joints(r, acceleration=(80.0, 80.0, 2.0)),
        "joint 3 would brake for 3.0 s, and 1 s is the most",
    ),
    (
        lambda r: replace(r, homing=replace(r.homing, max_travel=(3000.0,) * 3)),
        "joint 1 would home 1527887 microsteps far, and 1048576 is the most",
    ),
    (
        lambda r: replace(r, homing=replace(r.homing, slow=(0.001,) * 3)),
        "joint 1 would home for 50 minutes, and 10 are the most",
    ),
]


@pytest.mark.parametrize(("change", "says"), CONTRADICTIONS, ids=[x[1] for x in CONTRADICTIONS])
def test_a_robot_file_that_the_board_cannot_follow(
    make: Callable[..., StrangerBench], stm32: Robot, change: Callable[[Robot], Robot], says: str
) -> None:
    robot = change(stm32)
    bench = make(robot=robot)
    said = problem(bench, 0.2)
    assert said.startswith(f"The board cannot drive this robot: {says}")
    assert "in the robot file. Then restart deltaviz." in said
