"""The simulated board as a process: it starts, keeps time, survives its host to come to rest."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import textwrap
import time
from multiprocessing.connection import wait

import pytest

from deltaviz import load_robot
from deltaviz.link.configuration import configuration_hash, configure_from
from deltaviz.link.messages import (
    Arm,
    BoardState,
    Configured,
    Hello,
    HelloReply,
    Keep,
    Segment,
    Stop,
    Stopped,
    Telemetry,
    TelemetryFlags,
)
from deltaviz.link.sim import SimTransport
from deltaviz.link.sim_process import MOST_AT_ONCE, Pace
from tests.link.hearing import PATIENCE, hear


def is_gone(pid: int) -> bool:
    try:
        with open(f"/proc/{pid}/stat") as stat:
            return stat.read().rsplit(")", 1)[1].split()[0] == "Z"
    except FileNotFoundError:
        return True


def wait_until_gone(pid: int) -> None:
    deadline = time.monotonic() + PATIENCE
    while not is_gone(pid):
        assert time.monotonic() < deadline, "the process lives on"
        time.sleep(0.02)


@pytest.fixture
def link():
    transport = SimTransport.start()
    yield transport
    transport.close()
    assert is_gone(transport.pid)


def test_it_answers_and_starts_homed_at_the_ready_pose(link):
    configure = configure_from(load_robot("stm32"))
    link.send(Hello(1))
    assert hear(link, HelloReply).board == "simulated"
    link.send(configure)
    configured = hear(link, Configured)
    assert configured.configuration == configuration_hash(configure)
    told = hear(link, Telemetry, lambda m: m.counts)
    assert told.state is BoardState.HALTED
    assert TelemetryFlags.HOMED in told.flags


def test_without_homing_it_starts_disabled():
    link = SimTransport.start(homed=False)
    try:
        link.send(Hello(1))
        link.send(configure_from(load_robot("stm32")))
        told = hear(link, Telemetry, lambda m: m.counts)
        assert told.state is BoardState.DISABLED
        assert TelemetryFlags.HOMED not in told.flags
    finally:
        link.close()


def test_an_interrupt_is_not_for_it(link):
    link.send(Hello(1))
    hear(link, HelloReply)
    os.kill(link.pid, signal.SIGINT)
    link.send(Stop())
    hear(link, Stopped)


def test_what_is_read_after_its_death_is_the_reason(link):
    link.send(Hello(1))
    hear(link, HelloReply)
    os.kill(link.pid, signal.SIGKILL)
    deadline = time.monotonic() + PATIENCE
    while not link.closed:
        assert time.monotonic() < deadline
        wait([link.fileno()], 0.1)
        link.receive()
    assert "Connect again" in link.problem
    link.send(Stop())  # lost, and no error


def move(link):
    """Puts 200 ms of motion at constant speed into the queue; the board is moving when it ends.

    On a loaded machine the host may be too late for the board: then it tries again.
    """
    link.send(Hello(1))
    link.send(configure_from(load_robot("stm32")))
    hear(link, Telemetry, lambda m: m.counts)
    for epoch in range(1, 50):
        link.receive()
        told = hear(link, Telemetry)
        link.send(Keep(told.now))
        link.send(Arm(epoch, told.now, told.counts))
        send_motion(link, epoch, told)
        if was_moving(link, epoch):
            return
    raise AssertionError("this machine is too slow to move anything")


def was_moving(link, epoch):
    """What the first telemetry of this epoch says, or the next one."""
    hear(link, Telemetry, lambda m: m.epoch == epoch)
    return TelemetryFlags.MOVING in hear(link, Telemetry).flags


def send_motion(link, epoch, told):
    per_microstep = 1024
    start = [count * per_microstep for count in told.counts]
    travelled, speed, t_end = 0.0, 0.0, told.now
    for index in range(20):
        faster = min(100.0, speed + 50.0)
        travelled += (speed + faster) / 2 * 0.010
        speed = faster
        t_end = (t_end + 2000) & 0xFFFF_FFFF
        link.send(
            Segment(
                epoch,
                index,
                t_end,
                2000,
                told.now,
                tuple(round(travelled * per_microstep) + p for p in start),
                (round(speed * 65.536),) * 3,
            )
        )


def test_closing_in_motion_waits_for_the_board_to_rest(link):
    move(link)
    link.close()
    assert is_gone(link.pid)
    assert link.closed
    assert link.problem is None


def test_left_alone_it_brakes_and_says_why(link):
    move(link)
    stopped = hear(link, Stopped)
    assert stopped.cause.name in ("LEASE", "UNDERRUN")


def test_it_ends_by_itself_when_its_host_is_killed_in_motion():
    source = textwrap.dedent(
        """
        import sys, time
        sys.path.insert(0, sys.argv[1])
        from test_sim_process import move
        from deltaviz.link.sim import SimTransport
        link = SimTransport.start()
        move(link)
        print(link.pid, flush=True)
        time.sleep(60)
        """
    )
    host = subprocess.Popen(
        [sys.executable, "-c", source, os.path.dirname(__file__)], stdout=subprocess.PIPE
    )
    assert host.stdout is not None
    try:
        board = int(host.stdout.readline())
    finally:
        host.kill()
        host.wait()
        host.stdout.close()
    wait_until_gone(board)


def test_a_host_that_reads_nothing_does_not_block_the_board_nor_the_other_way_round(link):
    link.send(Hello(1))
    hear(link, HelloReply)
    os.kill(link.pid, signal.SIGSTOP)
    try:
        for _ in range(5000):  # far more than a socket holds: none of these may wait
            link.send(Keep(1))
    finally:
        os.kill(link.pid, signal.SIGCONT)
    link.send(Stop())
    hear(link, Stopped)


def test_board_time_follows_the_clock():
    pace = Pace(10.0)
    assert pace.due(10.005) == 1000
    assert pace.due(10.005) == 0
    total = 1000 + sum(pace.due(10.005 + 0.001 * step) for step in range(1, 1001))
    assert total == pytest.approx(200_000 + 1000, abs=1)


def test_after_a_stall_it_makes_up_for_20_ms_and_forgets_the_rest():
    pace = Pace(0.0)
    assert pace.due(0.019) == 3800
    assert pace.due(0.500) == MOST_AT_ONCE
    assert pace.due(0.501) == pytest.approx(200, abs=1)


def test_its_imports_are_light():
    """The board must be there soon after the command: no numpy in its process."""
    code = "import sys, deltaviz.link.sim_process; print('numpy' in sys.modules)"
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert out.stdout.strip() == "False"
