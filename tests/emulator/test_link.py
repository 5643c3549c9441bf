"""`emulate://` as a link: it starts, keeps to our time, and leaves nothing behind."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import textwrap
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from deltaviz.link.emulator.firmware import built
from deltaviz.link.messages import Hello, HelloReply, Stop, Telemetry
from deltaviz.link.rules import since
from deltaviz.link.transport import LinkError, Transport
from deltaviz.link.urls import check_link, open_link
from deltaviz.robots import Robot
from tests.link.hearing import PATIENCE, hear


def greet(link: Transport) -> HelloReply:
    """A board that has just been switched on misses what is said before it listens, and the link
    repeats it.
    """
    link.send(Hello(1))
    return hear(link, HelloReply)


def descendants(pid: int) -> set[int]:
    told = subprocess.run(["ps", "-o", "pid=", "--ppid", str(pid)], capture_output=True, text=True)
    children = {int(line) for line in told.stdout.split()}
    return children | {each for child in children for each in descendants(child)}


def emulators() -> set[int]:
    """QEMU's processes below this one."""
    names = {pid: Path(f"/proc/{pid}/comm") for pid in descendants(os.getpid())}
    return {pid for pid, name in names.items() if name.exists() and "qemu" in name.read_text()}


def wait_until_gone(pid: int) -> None:
    deadline = time.monotonic() + PATIENCE
    while Path(f"/proc/{pid}").exists() and " Z " not in Path(f"/proc/{pid}/stat").read_text():
        assert time.monotonic() < deadline, "the process lives on"
        time.sleep(0.02)


@pytest.fixture
def link(robot: Robot) -> Iterator[Transport]:
    transport = open_link("emulate://", robot)
    yield transport
    transport.close()


def test_it_answers_and_leaves_nothing_behind(link: Transport) -> None:
    assert greet(link).board == "emulated F407"
    running = emulators()
    assert len(running) == 1
    link.close()
    assert link.closed
    assert link.problem is None
    for pid in running:
        wait_until_gone(pid)


def test_its_time_does_not_run_ahead_of_ours(link: Transport) -> None:
    greet(link)
    first, began = hear(link, Telemetry), time.monotonic()
    half = 0.5 * 40_000
    last = hear(link, Telemetry, lambda told: since(told.now, first.now) >= half)
    passed = time.monotonic() - began
    assert since(last.now, first.now) / 40_000 <= passed + 0.05


def test_what_kills_it_is_no_secret(link: Transport) -> None:
    greet(link)
    for pid in emulators():
        os.kill(pid, signal.SIGKILL)
    deadline = time.monotonic() + PATIENCE
    while not link.closed:
        assert time.monotonic() < deadline
        link.receive()
    assert "The emulated board has ended: QEMU was ended from outside" in str(link.problem)
    assert "Connect again" in str(link.problem)
    link.send(Stop())  # lost, and no error


def test_it_dies_with_its_host_however_that_ends() -> None:
    host = textwrap.dedent("""
        import time
        from deltaviz import load_robot
        from deltaviz.link.messages import Hello
        from deltaviz.link.urls import open_link
        link = open_link("emulate://", load_robot("stm32"))
        link.send(Hello(1))
        while not link.receive():
            time.sleep(0.01)
        print("there", flush=True)
        time.sleep(600)
    """)
    with subprocess.Popen([sys.executable, "-c", host], stdout=subprocess.PIPE, text=True) as told:
        assert told.stdout is not None
        assert told.stdout.readline() == "there\n"
        left = descendants(told.pid)
        assert len(left) == 2
        told.kill()
    for pid in left:
        wait_until_gone(pid)


@pytest.mark.parametrize(
    ("url", "says"),
    [
        ("emulate://host", "nothing may stand"),
        ("emulate://?homed=1", "disabled and unhomed"),
        ("emulate://?image=/tmp/x", "no option image"),
    ],
)
def test_a_wrong_url_says_what_is_right(robot: Robot, url: str, says: str) -> None:
    for attempt in (check_link, lambda url: open_link(url, robot)):
        with pytest.raises(LinkError, match=says):
            attempt(url)


@pytest.mark.parametrize(
    ("there", "missing"),
    [((), "qemu-system-arm"), (("qemu-system-arm",), "gcc-arm-none-eabi")],
)
def test_what_is_not_installed_is_named_with_the_command(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, there: tuple[str, ...], missing: str
) -> None:
    for program in there:
        (tmp_path / program).symlink_to("/bin/true")
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(LinkError, match=rf"sudo apt install .*{missing}.*sim://"):
        check_link("emulate://")
    if there:
        with pytest.raises(LinkError, match="sudo apt install"):
            built()
