"""The machine in its process: it runs, and it ends, whatever ends its parent."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import pytest

from deltaviz.link.transport import LinkError
from deltaviz.machine import intent as i
from deltaviz.machine.client import MachineClient
from deltaviz.machine.mode import Mode
from deltaviz.robots import RobotFileError

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="looks into /proc")
ME = "me"
PATIENCE = 60.0  # s; only how long a hopeless test waits


def wait_for(condition: Callable[[], object], what: str) -> None:
    end = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < end, f"not in {PATIENCE:g} s: {what}"
        time.sleep(0.005)


def children(pid: int) -> list[int]:
    task = Path(f"/proc/{pid}/task/{pid}/children")
    return [int(child) for child in task.read_text().split()] if task.exists() else []


def running(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


@pytest.fixture
def machine() -> Iterator[MachineClient]:
    """One of the test's own, to be ended by it."""
    with MachineClient.start() as client:
        assert client.ready(PATIENCE)
        wait_for(lambda: client.snapshot.mode is Mode.IDLE, "idle")
        yield client


@pytest.fixture(scope="module")
def one_for_all() -> Iterator[MachineClient]:
    with MachineClient.start() as client:
        yield client


@pytest.fixture
def shared(one_for_all: MachineClient) -> MachineClient:
    """One that goes on living: at rest, and in nobody's control."""
    client = one_for_all
    assert client.ready(PATIENCE)
    wait_for(lambda: client.snapshot.mode is not Mode.OFFLINE, "connected")
    client.stop("test", "a test begins")
    wait_for(lambda: client.snapshot.stop_reason == "a test begins", "the stop")
    wait_for(lambda: client.snapshot.mode is Mode.IDLE, "idle")
    return client


def move(client: MachineClient) -> None:
    """Be in the middle of a slow move; a computer too busy for it is given more tries."""
    end = time.monotonic() + PATIENCE
    while client.snapshot.mode is not Mode.MOVING:
        assert time.monotonic() < end, client.snapshot
        start = client.snapshot.xyz
        assert start is not None
        away = -90.0 if start[0] > 0 else 90.0
        target = (start[0] + away, start[1], start[2])
        client.post(i.MoveToPoint(ME, target, 0.1)).result(PATIENCE)
        under_way = partial(moved_or_ended, client, start)
        wait_for(under_way, "motion")


def moved_or_ended(client: MachineClient, start: tuple[float, ...]) -> bool:
    now = client.snapshot
    if now.stop_reason is not None and now.mode is Mode.IDLE:
        return True
    return now.xyz is not None and abs(now.xyz[0] - start[0]) > 2.0


def test_it_moves_stops_and_ends(machine: MachineClient) -> None:
    pids = [machine.pid, *children(machine.pid)]
    assert len(pids) == 2, "the machine's process and the board's"
    move(machine)
    machine.stop("another", "Stop pressed")
    wait_for(lambda: machine.snapshot.mode is Mode.IDLE, "idle")
    assert machine.snapshot.stop_reason == "Stop pressed"
    machine.close()
    assert not any(map(running, pids))
    assert machine.snapshot.mode is Mode.OFFLINE
    assert isinstance(machine.post(i.Home(ME)).result(0), i.Refused)
    machine.close()


def test_what_was_asked_for_before_a_stop_does_not_happen_after_it(
    shared: MachineClient,
) -> None:
    """Both wait in their pipes while the process is held; the stop is read first."""
    os.kill(shared.pid, signal.SIGSTOP)
    try:
        x, y, z = shared.snapshot.xyz or (0.0, 0.0, 0.0)
        before = shared.post(i.MoveToPoint(ME, (x + 50, y, z), 1.0))
        shared.stop(ME, "Stop pressed")
    finally:
        os.kill(shared.pid, signal.SIGCONT)
    answer = before.result(PATIENCE)
    assert isinstance(answer, i.Refused)
    assert "stopped" in answer.detail
    answered = time.monotonic()
    wait_for(lambda: shared.snapshot.at > answered, "a picture that knows of the stop")
    wait_for(lambda: shared.snapshot.mode is Mode.IDLE or shared.snapshot.link.problem, "rest")
    if shared.snapshot.mode is Mode.IDLE:
        fresh = shared.post(i.MoveToPoint(ME, (x + 5, y, z), 1.0)).result(PATIENCE)
        assert fresh == i.Accepted()


def test_a_flood_of_intents_holds_up_no_stop(shared: MachineClient) -> None:
    move(shared)
    for _ in range(3000):
        shared.post(i.SetOverride("another", 0.5))
    shared.stop("another", "Stop pressed")
    answered = shared.post(i.SetOverride("another", 0.5))
    wait_for(lambda: shared.snapshot.stop_reason == "Stop pressed", "the stop")
    answered.result(PATIENCE)


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGKILL])
def test_when_its_process_is_ended_the_board_rests_and_the_client_knows(
    machine: MachineClient, number: signal.Signals
) -> None:
    move(machine)
    pids = [machine.pid, *children(machine.pid)]
    os.kill(machine.pid, number)
    wait_for(lambda: not any(map(running, pids)), "both processes end")
    wait_for(lambda: machine.snapshot.mode is Mode.OFFLINE, "offline")
    assert "ended" in str(machine.snapshot.link.problem)
    assert isinstance(machine.post(i.Home(ME)).result(0), i.Refused)
    machine.stop(ME, "harmless")


def test_an_interrupt_is_the_parents_to_act_on(shared: MachineClient) -> None:
    move(shared)
    for pid in (shared.pid, *children(shared.pid)):
        os.kill(pid, signal.SIGINT)
    time.sleep(0.05)
    assert shared.post(i.SetOverride(ME, 0.9)).result(PATIENCE) == i.Accepted()


PARENT = """
import sys, time
from deltaviz.machine.client import MachineClient
from deltaviz.machine import intent as i
machine = MachineClient.start()
assert machine.ready(60)
while machine.snapshot.mode != "idle": time.sleep(.01)
x, y, z = machine.snapshot.xyz
assert machine.post(i.MoveToPoint("me", (x + 90, y, z), 0.1)).result(60) == i.Accepted()
while machine.snapshot.xyz[0] < x + 2: time.sleep(.005)
print(machine.pid, flush=True)
ENDING
"""


@pytest.mark.parametrize("ending", ["time.sleep(1000)", "raise ValueError"])
def test_when_the_parent_is_gone_everything_rests_and_ends(ending: str) -> None:
    """Killed or failed: without a word, the robot brakes and all ends."""
    parent = subprocess.Popen(
        [sys.executable, "-c", PARENT.replace("ENDING", ending)],
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    )
    assert parent.stdout is not None
    with parent.stdout as out:
        machine = int(out.readline())
    pids = [machine, *children(machine)]
    if ending.startswith("time"):
        assert len(pids) == 2
        parent.kill()
    parent.wait(PATIENCE)
    wait_for(lambda: not any(map(running, pids)), "all processes end")


def test_a_bad_robot_or_link_is_told_before_anything_starts() -> None:
    with pytest.raises(RobotFileError, match="stm32"):
        MachineClient.start(robot="stm33")
    with pytest.raises(LinkError):
        MachineClient.start(link="serial:///dev/ttyUSB0?speed=9600")


def test_a_robot_that_no_board_can_be_told_about_is_refused(tmp_path: Path) -> None:
    """At the start, and when its file was changed before it is chosen: nothing fails."""
    from deltaviz.robots import load

    preset = (Path(load.__file__).parent / "presets" / "stm32.toml").read_text()
    good = preset.replace('name = "stm32"', 'name = "mine"')
    bad = good.replace("acceleration_deg_s2 = 4500", "acceleration_deg_s2 = 1e9")
    assert bad != good
    file = tmp_path / "mine.toml"
    file.write_text(bad)
    with pytest.raises(RobotFileError, match="acceleration is too large"):
        MachineClient.start(robot=str(file))
    file.write_text(good)
    with MachineClient.start(robot=str(file)) as client:
        assert client.ready(PATIENCE)
        wait_for(lambda: client.snapshot.mode is Mode.IDLE, "idle")
        file.write_text(bad)
        answer = client.post(i.SelectRobot(ME, "mine")).result(PATIENCE)
        assert isinstance(answer, i.Refused)
        assert "acceleration is too large" in answer.detail
        assert client.snapshot.mode is Mode.IDLE


def test_the_loop_tells_how_regular_it_is(shared: MachineClient) -> None:
    move(shared)
    stats = shared.stats().result(PATIENCE)
    assert stats.count > 0
    assert 0 < stats.p50 <= stats.p99 <= stats.worst
    wait_for(lambda: shared.snapshot.mode is Mode.IDLE, "idle")
    shared.stats().result(PATIENCE)
    assert shared.stats().result(PATIENCE).count == 0, "each request counts anew"


def test_a_robot_file_of_the_users_own(tmp_path: Path) -> None:
    from deltaviz.robots import load

    preset = Path(load.__file__).parent / "presets" / "stm32.toml"
    file = tmp_path / "mine.toml"
    file.write_text(preset.read_text().replace('name = "stm32"', 'name = "mine"'))
    with MachineClient.start(robot=str(file), link="sim://?homed=0") as client:
        assert client.ready(PATIENCE)
        wait_for(lambda: client.snapshot.mode is Mode.DISABLED, "disabled")
        assert client.snapshot.robot == "mine"
        assert client.robot.name == "mine"
        assert client.post(i.SelectRobot(ME, "trossen")).result(PATIENCE) == i.Accepted()
        wait_for(lambda: client.robot.name == "trossen", "the other robot")
        wait_for(lambda: client.snapshot.mode is Mode.DISABLED, "the new board")
        assert client.post(i.SelectRobot(ME, "mine")).result(PATIENCE) == i.Accepted()
        wait_for(lambda: client.robot.name == "mine", "back again")


def test_a_robot_file_that_was_changed_and_chosen_again(tmp_path: Path) -> None:
    """What is shown and computed is of the robot that is driven, not of the file as it was."""
    from deltaviz.robots import load

    preset = (Path(load.__file__).parent / "presets" / "stm32.toml").read_text()
    file = tmp_path / "mine.toml"
    file.write_text(preset.replace('name = "stm32"', 'name = "mine"'))
    with MachineClient.start(robot=str(file)) as client:
        assert client.ready(PATIENCE)
        file.write_text(file.read_text().replace("forearm = 338.0", "forearm = 300.0"))
        wait_for(lambda: client.snapshot.mode is Mode.IDLE, "idle")
        assert client.post(i.SelectRobot(ME, "mine")).result(PATIENCE) == i.Accepted()
        wait_for(lambda: "forearm = 300.0" in client.loaded.text, "the file as it is now")
        assert client.robot.mechanism.forearm == (300.0, 300.0, 300.0)
        file.unlink()
        assert client.post(i.SelectRobot(ME, "trossen")).result(PATIENCE) == i.Accepted()
        wait_for(lambda: client.snapshot.robot == "trossen", "another robot")
        assert client.robot.name == "trossen"


def test_no_descriptor_is_left_open() -> None:
    def open_descriptors() -> int:
        return len(os.listdir("/proc/self/fd"))

    with socket.socket():
        before = open_descriptors()
        with MachineClient.start() as client:
            client.ready(PATIENCE)
        assert open_descriptors() == before


def test_who_no_longer_waits_for_an_answer_does_not_stop_the_news(machine: MachineClient) -> None:
    """A web request that was given up cancels what it waits for."""
    assert not machine.post(i.Enable(ME)).cancel()
    assert isinstance(machine.post(i.Enable(ME)).result(PATIENCE), i.Accepted)
    seen = machine.snapshot.board_time or 0.0
    wait_for(lambda: (machine.snapshot.board_time or 0.0) > seen, "news after the cancelled answer")
