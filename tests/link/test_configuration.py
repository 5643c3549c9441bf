"""What a board is told, and the number that names it; the links inside one process."""

from __future__ import annotations

import socket
import subprocess
import sys
from dataclasses import fields, replace

import pytest

from deltaviz import load_robot
from deltaviz.link.board import SimulatedBoard
from deltaviz.link.configuration import configuration_hash, configure_from
from deltaviz.link.memory import MemoryTransport
from deltaviz.link.messages import BoardState, Configured, Hello, HelloReply, Telemetry
from deltaviz.link.pickles import PickleSocket

PRESETS = ["stm32", "trossen", "zheng2023", "deltadraw"]


@pytest.mark.parametrize("name", PRESETS)
def test_every_preset_is_a_configuration_that_the_board_takes(name):
    configure = configure_from(load_robot(name))
    board = SimulatedBoard(start_homed=True)
    board.receive(configure)
    assert Configured(configuration_hash(configure)) in board.take()
    assert board.state is BoardState.HALTED
    assert board.homed


def test_the_hash_is_the_same_in_another_process():
    code = (
        "from deltaviz import load_robot\n"
        "from deltaviz.link.configuration import configuration_hash, configure_from\n"
        "print(configuration_hash(configure_from(load_robot('stm32'))))"
    )
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert int(out.stdout) == configuration_hash(configure_from(load_robot("stm32")))


def test_each_field_counts():
    configure = configure_from(load_robot("stm32"))
    hashes = {configuration_hash(configure)}
    changed = {
        "kind": "other",
        "geometry": (),
        "homing_together": not configure.homing_together,
        "homing_direction": -configure.homing_direction,
        "inverted": (True, False, False),
        "workspace_x": (-1.0, 1.0),
        "workspace_y": (-1.0, 1.0),
        "workspace_radius": None,
        "workspace_z": None,
    }
    for field in fields(configure):
        value = getattr(configure, field.name)
        if field.name in changed:
            other = changed[field.name]
        elif isinstance(value, tuple):
            other = (value[0] + 1e-12, *value[1:])
        else:
            other = value + 1e-12
        hashes.add(configuration_hash(replace(configure, **{field.name: other})))
    assert len(hashes) == 1 + len(fields(configure))


def test_presets_differ():
    assert len({configuration_hash(configure_from(load_robot(name))) for name in PRESETS}) == 4


class Clock:
    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now


def test_a_board_in_memory_follows_the_clock_it_is_given():
    clock = Clock()
    link = MemoryTransport(SimulatedBoard(), clock)
    clock.now += 0.012
    told = link.receive()
    assert [m.now for m in told if isinstance(m, Telemetry)] == [1000, 2000]
    link.send(Hello(1))
    assert any(isinstance(m, HelloReply) for m in link.receive())
    link.close()
    assert link.closed
    assert link.receive() == []


@pytest.fixture
def pair():
    left, right = socket.socketpair()
    ends = PickleSocket(left), PickleSocket(right)
    yield ends
    for end in ends:
        end.close()


def test_messages_arrive_whole_and_in_order(pair):
    left, right = pair
    for number in range(500):
        left.send(("message", number, "x" * number))
    got = []
    while len(got) < 500:
        got += right.receive()
        left.receive()  # sends on what the socket had no room for
    assert [message[1] for message in got] == list(range(500))


def test_what_was_sent_before_the_end_still_arrives(pair):
    left, right = pair
    left.send("last words")
    left.close()
    assert right.receive() == ["last words"]
    assert right.ended is not None
    right.send("to nobody")
    assert right.receive() == []


def test_a_peer_that_stops_reading_ends_the_connection_instead_of_blocking(pair):
    left, _ = pair
    for _ in range(400):
        left.send("x" * 10_000)
    assert left.ended is not None
