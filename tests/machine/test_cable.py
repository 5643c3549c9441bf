"""The plug is pulled, and put in again, in every phase of a session and in the middle of every
kind of motion: the robot rests within its limits, the page is told, and nothing is resumed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest

from deltaviz.link import messages as m
from deltaviz.link.board import SimulatedBoard
from deltaviz.machine import intent as i
from deltaviz.machine.mode import Mode
from deltaviz.machine.snapshot import LinkPhase
from deltaviz.machine.transitions import AT_REST
from deltaviz.robots import Robot
from tests.link.cable import SocketCable
from tests.machine.cable_bench import LINK, CableBench
from tests.machine.test_broken import (
    ACCEPTED,
    ME,
    dragging,
    homing,
    jogging,
    moving,
    sliding,
    stepping,
)


@pytest.fixture
def bench(stm32: Robot) -> Iterator[CableBench]:
    bench = CableBench(stm32)
    yield bench
    bench.close()


def connect(bench: CableBench) -> None:
    assert bench.do(i.Connect(ME, LINK)) == ACCEPTED


def assert_lost(bench: CableBench) -> None:
    """The machine is offline with a reason, the board at rest within its limits."""
    bench.run_until(lambda: bench.mode is Mode.OFFLINE, within=1.1)
    bench.run_until(lambda: not bench.board.moving, within=0.45)
    bench.check_limits()
    link = bench.snapshot.link
    assert link.phase is LinkPhase.CLOSED
    assert "unplugged" in str(link.problem)
    assert "connect" in str(link.problem)
    assert bench.snapshot.xyz is None


def assert_nothing_resumes(bench: CableBench) -> None:
    rested = bench.now
    bench.run(0.5)
    assert bench.mode in AT_REST
    if bench.board.positions:  # a new board has no arms before it is configured
        assert bench.distance_moved(rested) == 0
    assert not any(isinstance(x, m.Arm) for x in bench.sent)


def paused(bench: CableBench) -> None:
    moving(bench)
    bench.run(0.1)
    assert bench.do(i.Pause(ME)) == ACCEPTED


def stopping(bench: CableBench) -> None:
    moving(bench)
    bench.run(0.15)
    bench.do(i.Stop(ME, "Stop pressed"))
    bench.run(0.004)


def estopping(bench: CableBench) -> None:
    jogging(bench)
    bench.do(i.EStop(ME, "E-stop pressed"))


def resting(bench: CableBench) -> None:
    pass


def disabled(bench: CableBench) -> None:
    assert bench.do(i.Disable(ME)) == ACCEPTED


def enabling(bench: CableBench) -> None:
    disabled(bench)
    bench.run(0.02)
    assert bench.do(i.Enable(ME)) == ACCEPTED


WAYS = [
    jogging, stepping, dragging, sliding, moving, homing, paused, stopping, estopping, resting,
    disabled, enabling,
]  # fmt: skip


@pytest.mark.parametrize("same_board", [True, False])
@pytest.mark.parametrize("lead", WAYS, ids=lambda way: way.__name__)
def test_in_the_middle_of_everything(
    bench: CableBench, lead: Callable[[CableBench], None], same_board: bool
) -> None:
    bench.run_until(lambda: bench.mode is Mode.IDLE)
    lead(bench)
    bench.unplug()
    assert_lost(bench)
    knew = bench.board.homed
    bench.sent.clear()
    bench.plug_in(bench.board if same_board else None)
    assert_nothing_resumes(bench)
    assert bench.mode is Mode.OFFLINE, "not connected by itself"
    connect(bench)
    bench.run_until(lambda: bench.snapshot.link.connected)
    bench.run(0.02)
    assert bench.snapshot.homed is (knew and same_board)
    note = bench.snapshot.link.note
    if bench.snapshot.homed:
        assert "kept its position" in str(note)
    elif knew:
        assert "home it" in str(note)
    assert_nothing_resumes(bench)


PHASES: list[tuple[str, Callable[[CableBench], bool]]] = [
    ("before the hello is sent", lambda b: True),
    ("before it is answered", lambda b: b.sent != []),
    ("when it is answered", lambda b: b.snapshot.link.board is not None),
    ("when it is configured", lambda b: any(isinstance(x, m.Configure) for x in b.sent)),
    ("when it has reported", lambda b: b.snapshot.link.connected),
]


@pytest.mark.parametrize(("_name", "reached"), PHASES, ids=[name for name, _ in PHASES])
def test_in_every_phase_of_a_session(
    stm32: Robot, _name: str, reached: Callable[[CableBench], bool]
) -> None:
    bench = CableBench(stm32)
    assert bench.do(i.Disconnect(ME)) == ACCEPTED
    bench.run(0.01)
    bench.plug_in()
    bench.sent.clear()
    connect(bench)
    bench.run_until(lambda: reached(bench))
    bench.unplug()
    bench.run_until(lambda: bench.mode is Mode.OFFLINE and bench.snapshot.link.problem is not None)
    assert "connect" in str(bench.snapshot.link.problem)
    bench.plug_in()
    connect(bench)
    bench.run_until(lambda: bench.mode is Mode.DISABLED)
    bench.close()


def test_after_a_pull_the_robot_is_moved_again_by_a_fresh_press_only(bench: CableBench) -> None:
    bench.run_until(lambda: bench.mode is Mode.IDLE)
    jogging(bench)
    epochs = [x.epoch for x in bench.sent if isinstance(x, m.Arm)]
    bench.unplug()
    assert_lost(bench)
    bench.plug_in(bench.board)
    connect(bench)
    bench.run_until(lambda: bench.mode is Mode.IDLE)
    assert isinstance(bench.beat((300.0, 0.0, 0.0)), i.Refused), "the old press is dead"
    bench.sent.clear()
    bench.jog((-30.0, 0.0, 0.0), 0.2, press="fresh")
    assert bench.board.moving
    assert not {x.epoch for x in bench.sent if isinstance(x, m.Arm)} & set(epochs)


def test_a_port_that_is_gone_says_so_and_works_when_it_is_back(bench: CableBench) -> None:
    bench.run_until(lambda: bench.mode is Mode.IDLE)
    bench.unplug()
    assert_lost(bench)
    connect(bench)
    bench.run(0.01)
    assert str(bench.snapshot.link.problem).startswith("There is no /dev/pts/")
    bench.plug_in()
    connect(bench)
    bench.run_until(lambda: bench.mode is Mode.DISABLED)
    assert bench.snapshot.link.problem is None


def test_a_board_that_was_switched_off_meanwhile_has_to_be_homed(bench: CableBench) -> None:
    bench.run_until(lambda: bench.mode is Mode.IDLE)
    bench.unplug()
    assert_lost(bench)
    bench.plug_in(SimulatedBoard(boot=77))
    connect(bench)
    bench.run_until(lambda: bench.mode is Mode.DISABLED)
    assert not bench.snapshot.homed
    assert bench.do(i.Enable(ME)) == ACCEPTED
    bench.run_until(lambda: bench.mode is Mode.UNHOMED)


def test_a_serial_server_that_goes_away(stm32: Robot) -> None:
    bench = CableBench(stm32, cable=SocketCable)
    bench.run_until(lambda: bench.mode is Mode.IDLE)
    jogging(bench)
    bench.unplug()
    bench.run_until(lambda: bench.mode is Mode.OFFLINE, within=1.1)
    bench.run_until(lambda: not bench.board.moving, within=0.45)
    bench.check_limits()
    assert "broke: it has ended" in str(bench.snapshot.link.problem)
    bench.plug_in(bench.board)
    connect(bench)
    bench.run_until(lambda: bench.mode is Mode.IDLE)
    bench.close()


def test_a_stop_waits_behind_no_more_than_the_horizon(bench: CableBench) -> None:
    """The board reads nothing while the robot jogs: what stands before the stop is bounded by
    the horizon, not by what the system would hold.
    """
    bench.run_until(lambda: bench.mode is Mode.IDLE)
    jogging(bench)
    host = bench._host
    assert host is not None
    before = host.written
    count = 0

    def beat() -> None:
        nonlocal count
        count += 1
        if count % 25 == 0:
            bench.beat((300.0, 0.0, 0.0))

    bench.port = None  # neither reads nor answers, while the bytes lie in the system
    for _ in range(70):
        bench.now += 0.002
        beat()
        bench._turn()
    bench.do(i.Stop(ME, "Stop pressed"))
    bench._turn()
    segment, keep, stop = 57, 13, 8  # bytes, at most
    assert host.written - before <= 6 * segment + 6 * keep + stop
