"""A host at the emulated board: a real session, played by hand, and the pins under watch.

The board's time waits for this host: it goes on by some milliseconds each turn, so that a busy
computer makes nothing late.
"""

from __future__ import annotations

import select
import time
from collections import deque
from collections.abc import Callable, Iterable
from pathlib import Path

from deltaviz.link.configuration import configuration_hash, configure_from
from deltaviz.link.emulator.arms import arms_of
from deltaviz.link.emulator.emulator import Emulator
from deltaviz.link.emulator.firmware import built
from deltaviz.link.emulator.pace import Pace
from deltaviz.link.emulator.wire_pair import wire_pair
from deltaviz.link.messages import (
    BoardMessage,
    BoardState,
    HelloReply,
    HostMessage,
    Keep,
    Segment,
    Telemetry,
    TelemetryFlags,
)
from deltaviz.link.rules import since
from deltaviz.link.session import Session
from deltaviz.link.socket_stream import SocketStream
from deltaviz.link.tap import Tap, untapped
from deltaviz.link.wire.channel import Channel
from deltaviz.motion.knot import Knot
from deltaviz.robots import Robot
from tests.emulator.commanded_path import CommandedPath, commanded_path
from tests.emulator.pin_trace import PinTrace
from tests.emulator.pulse_train import PulseTrain, pulse_train

PATIENCE = 60.0  # s of ours in which nothing is heard: a loaded machine needs less
WITHIN = 30.0  # s of the board's time
TURN = 0.002  # s
HORIZON = 0.100  # s of motion that the board has ahead
GRANT = 5  # ms of the board's time, each turn


class EmulatedBoard:
    """Switched on, with its arms hanging somewhere; `connect` begins a session."""

    def __init__(self, robot: Robot, *, image: Path | None = None, tap: Tap = untapped) -> None:
        self.robot = robot
        self.configure = configure_from(robot)
        self.arms = arms_of(self.configure)
        self._trace = PinTrace()
        link, board = wire_pair()
        self._pace, paced = Pace.pair()
        with board, paced:
            self._emulator = Emulator.start(
                self.configure,
                image=image or built(),
                link=board,
                trace=self._trace.descriptor,
                pace=paced,
            )
        self._trace.started()
        self.bench = self._emulator.bench
        self._channel = Channel(tap(SocketStream(link)))
        self._met: float | None = None  # when, by ours, the board's time began
        self._link = link
        self.sent: list[HostMessage] = []
        self.said: list[BoardMessage] = []
        self._closed = False
        self._knots: deque[Knot] = deque()
        self._horizon = HORIZON
        self._begun = 0
        self._counts: tuple[int, ...] = ()
        self.session = Session(
            configuration=self.configure,
            digest=configuration_hash(self.configure),
            microsteps_per_rad=robot.drive.microsteps_per_rad,
            now=time.monotonic(),
        )

    @property
    def telemetry(self) -> Telemetry:
        assert self.session.telemetry is not None
        return self.session.telemetry

    @property
    def now(self) -> float:
        """This host's clock (s). Once the board tells its time it follows that, so that nobody is
        late because this computer is busy.
        """
        if self._met is None:
            return time.monotonic()
        return self._met + (self.session.board_time or 0.0)

    # Turns of a host.

    def turn(self) -> None:
        """One round: hear what the board says, say what the session wants to."""
        now = self._listen()
        self.session.tick(now)
        while self._knots and self.session.wants_knot(now, horizon=self._horizon):
            self.session.segment(self._knots.popleft(), now)
        if self.session.moving:
            self.session.keep(now)
        for message in self.session.take():
            self.send(message)

    def send(self, message: HostMessage) -> None:
        self.sent.append(message)
        self._channel.send(message)

    def send_bytes(self, data: bytes) -> None:
        """Which need be no frames."""
        self._link.sendall(data)

    def _listen(self) -> float:
        self._pace.grant(GRANT)
        select.select([self._link], [], [], TURN)
        now = self.now
        for message in self._channel.receive():
            self.said.append(message)
            self.session.receive(message, now)
        if self._met is None and self.session.ready:
            self._met = now - (self.session.board_time or 0.0)
        assert self._channel.ended is None, self._emulator.last_words
        assert self.session.problem is None, self.session.problem
        return now

    def until(
        self,
        condition: Callable[[], object],
        what: str,
        *,
        within: float = WITHIN,
        silent: bool = False,
    ) -> None:
        """Turns, or with `silent` only listens; for at most `within` seconds of the board's time,
        and as long as that passes.
        """
        began = self.session.board_time or 0.0
        passed, last_passed = 0.0, time.monotonic()
        while not condition():
            told = f"{what} did not come: {self.session.telemetry}"
            now = (self.session.board_time or 0.0) - began
            if now > passed:
                passed, last_passed = now, time.monotonic()
            assert passed <= within, told
            assert time.monotonic() - last_passed < PATIENCE, told
            if silent:
                self._listen()
            else:
                self.turn()

    def until_state(self, state: BoardState, *, silent: bool = False) -> None:
        """And with nothing of this host's left to be answered."""
        self.until(lambda: self._is_in(state), state.name, silent=silent)

    def _is_in(self, state: BoardState) -> bool:
        told, session = self.session.telemetry, self.session
        return told is not None and told.state is state and session.settled and not session.stopping

    def let_pass(self, seconds: float) -> None:
        """Board time."""
        start, ticks = self.telemetry.now, seconds * self.tick_hz
        self.until(lambda: since(self.telemetry.now, start) >= ticks, "time")

    # What a person asks for.

    def connect(self) -> None:
        self.until(lambda: self.session.ready, "ready")

    def enable(self) -> None:
        self.session.enable(self.now, on=True)
        self.until_state(BoardState.HALTED)

    def begin_homing(self) -> None:
        self.session.home(self.now)

    def home(self) -> None:
        self.begin_homing()
        self.until(lambda: self.session.settled and not self.session.homing, "homed")

    def make_ready(self) -> None:
        self.connect()
        self.enable()
        self.home()
        assert self.session.homed

    def begin(self, knots: Iterable[Knot], *, horizon: float = HORIZON) -> None:
        """Arms; from now on turns send the knots, `horizon` (s) of them ahead."""
        self._begun, self._counts = len(self.sent), self.telemetry.counts
        self._knots, self._horizon = deque(knots), horizon
        self.session.begin()

    def drive(self, knots: Iterable[Knot]) -> CommandedPath:
        """All of them, the last of which is at rest; what was commanded."""
        self.begin(knots)
        duration = sum(knot.duration for knot in self._knots)
        self.until(self._has_run, "rest", within=duration + WITHIN)
        return self.path()

    def _has_run(self) -> bool:
        session = self.session
        assert session.stopped is session.refused is None, (session.stopped, session.refused)
        return not self._knots and session.standing

    def stop(self) -> None:
        self._knots.clear()
        self.session.stop(self.now)
        self.until_state(BoardState.HALTED)

    def path(self) -> CommandedPath:
        """What was commanded since `begin`, at the times at which the board has run it."""
        segments = [m for m in self.sent[self._begun :] if isinstance(m, Segment)]
        by_index = {segment.index: segment for segment in segments}
        late = next(
            since(told.t_queue_end, by_index[told.last_index].t_end)
            for told in reversed(self.said)
            if isinstance(told, Telemetry)
            and told.state is BoardState.ARMED
            and TelemetryFlags.MOVING in told.flags
        )
        return commanded_path(self._counts, segments, late=late, ticks_per_ms=self.tick_hz // 1000)

    @property
    def seen(self) -> int:
        """The newest board time that this host has said it had heard of."""
        return max(m.seen for m in self.sent[self._begun :] if isinstance(m, Segment | Keep))

    @property
    def tick_hz(self) -> int:
        return next(m.tick_hz for m in self.said if isinstance(m, HelloReply))

    # The end.

    def finish(self) -> PulseTrain:
        """Switches the board off; all pulses that have left."""
        self.close()
        return pulse_train(self._changes, inverted=self.configure.inverted)

    def close(self) -> None:
        if not self._closed:
            self._closed = True
            self._channel.close()
            self._pace.close()
            self._emulator.close()
            self._changes, self.last_tick = self._trace.finish()
