"""A straight line from the host's session to the tool tip: every byte passes the wire."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from deltaviz import load_robot
from deltaviz.link.board import SimulatedBoard
from deltaviz.link.configuration import configuration_hash, configure_from
from deltaviz.link.memory import MemoryTransport
from deltaviz.link.messages import BoardState
from deltaviz.link.session import Session
from deltaviz.motion.knot import CartesianKnot

ROBOT = load_robot("stm32")
PER_RAD = np.array(ROBOT.drive.microsteps_per_rad)
STEP = 0.001  # s
UM = 1e-3  # mm


class Host:
    """A session and its board, on a clock that the test turns."""

    def __init__(self) -> None:
        self.now = 100.0
        self.board = SimulatedBoard(start_homed=True, now=2**32 - 30_000)
        configure = configure_from(ROBOT)
        self._link = MemoryTransport(self.board, lambda: self.now)
        self.session = Session(
            configuration=configure,
            digest=configuration_hash(configure),
            microsteps_per_rad=configure.microsteps_per_rad,
            now=self.now,
        )

    def step(self) -> None:
        self.now += STEP
        for message in self._link.receive():
            self.session.receive(message, self.now)
        self.session.keep(self.now)
        self.session.tick(self.now)
        for message in self.session.take():
            self._link.send(message)

    @property
    def tip(self) -> np.ndarray:
        return ROBOT.forward(np.array(self.board.positions) / 2**32 / PER_RAD)


def knots(start: np.ndarray, way: np.ndarray, ms: int) -> Iterator[CartesianKnot]:
    """From rest to rest with even jerk at both ends, each 10 ms."""
    for t in np.arange(10, ms + 5, 10) / ms:
        p = start + way * t**3 * (10 - 15 * t + 6 * t * t)
        v = way * 30 * t * t * (1 - t) ** 2 / (ms / 1000)
        yield CartesianKnot(0.010, (p[0], p[1], p[2]), (v[0], v[1], v[2]))


def test_the_tip_is_led_along_a_line():
    host = Host()
    while not host.session.ready:
        host.step()
    start, way = host.tip, np.array([-50.0, 40.0, -25.0])
    host.session.begin()
    waiting = list(knots(start, way, 500))
    points = []
    for _ in range(700):
        while waiting and host.session.wants_knot(host.now, horizon=0.060):
            host.session.segment(waiting.pop(0), host.now)
        host.step()
        points.append(host.tip)
    assert host.session.refused is None
    assert host.session.underruns == 0
    assert host.session.standing
    assert host.board.state is BoardState.ARMED
    along = way / np.linalg.norm(way)
    off = np.array(points) - start
    assert np.linalg.norm(off - np.outer(off @ along, along), axis=1).max() < 1.0 * UM
    assert np.linalg.norm(points[-1] - (start + way)) < 1.0 * UM
