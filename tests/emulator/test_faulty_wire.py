"""The real firmware at the end of a bad wire: its pulses are what was commanded, or the brake.

All kinds and rates: `python -m pytest -m long tests/emulator/test_faulty_wire.py`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from random import Random

import numpy as np
import pytest

from deltaviz.link.messages import BoardMessage, BoardState, Segment, Stop, StopCause, Telemetry
from deltaviz.link.wire.codec import decode_board, encode
from deltaviz.link.wire.frames import FrameReader, write_frame
from deltaviz.link.wire.stream import ByteStream
from tests.emulator.emulated_board import GRANT, EmulatedBoard
from tests.emulator.faulty_stream import FaultyStream
from tests.emulator.pulse_train import PulseTrain
from tests.emulator.test_motion import assert_within_limits
from tests.faults.executed import Executed, Sample
from tests.faults.faulty_line import Fault, Kind, Unit
from tests.faults.judge import MS, Judge
from tests.faults.wire_faults import FAULTS

RIDE = 0.8  # s
SPEED = 0.3  # rad/s
CHOSEN = [
    Fault(Kind.FLIPPED, Unit.BYTE, 0.01),
    Fault(Kind.LOST, Unit.FRAME, 0.05),
    Fault(Kind.DELAYED, Unit.FRAME, 0.05),
    Fault(Kind.REORDERED, Unit.FRAME, 0.05),
]
Wander = Callable[..., list]


class BadWire:
    """A homed board, and rides on it; one that was stopped is followed by a fresh one."""

    def __init__(self, start: Callable[..., EmulatedBoard], wander: Wander) -> None:
        self._wander = wander
        self.board = start(tap=self._tap)
        self.board.make_ready()
        self._began, self._ready = self.board.telemetry.now, self.board.telemetry.counts
        self._sent = len(self.board.sent)
        self._rides = 0
        self.stops: list[StopCause] = []

    def _tap(self, stream: ByteStream) -> FaultyStream:
        self.wire = FaultyStream(stream, turn=GRANT / 1000, seed=7)
        return self.wire

    def ride(
        self,
        fault: Fault | None,
        *,
        each: Callable[[], None] = lambda: None,
        knots: Wander | None = None,
    ) -> None:
        """For RIDE seconds of motion; then the wire is sound until all has been told."""
        board, end = self.board, self.board.now + RIDE
        while board.now < end:
            self._rides += 1
            self.wire.hurt(fault)
            seconds = end - board.now
            if knots is not None:
                board.begin(knots(board, seconds=seconds))
            else:
                board.begin(self._wander(board, seconds=seconds, seed=self._rides))
            board.until(lambda: self._has_ended(each), "an end")
            self.wire.hurt(None)
            self.wire.cut = False
            board.stop()
            assert board.session.stopped is not None
            self.stops.append(board.session.stopped.cause)

    def _has_ended(self, each: Callable[[], None]) -> bool:
        each()
        session, told = self.board.session, self.board.telemetry
        if session.flight is None or session.never_began:
            return True
        if told.state is BoardState.HALTED and told.epoch == session.flight.epoch:
            return True
        return not self.board._knots and session.standing

    def judge(self) -> Executed:
        """All pulses since it was homed, as a board's executed milliseconds."""
        board = self.board
        counts, arms, last = board.telemetry.counts, board.bench.state().arms, board.telemetry.now
        pulses = board.finish()
        executed = _executed(board, pulses, self._began, last, self._ready, self._sent)
        for frame in FrameReader().feed(self.wire.said):
            executed.note(_finer(decode_board(frame.type, frame.payload)))
        assert pulses.faults == ()
        assert arms[: len(counts)] == counts == executed.samples[-1].counts
        assert_within_limits(pulses, board, self._began, last)
        assert Judge(counted=True)(executed).wrong == []
        return executed


FINER = MS // 40  # of the judge's ticks in one of this board


def _finer(message: BoardMessage) -> BoardMessage:
    if not isinstance(message, Telemetry):
        return message
    return replace(message, now=message.now * FINER, t_queue_end=message.t_queue_end * FINER)


def _executed(
    board: EmulatedBoard,
    pulses: PulseTrain,
    begin: int,
    end: int,
    ready: tuple[int, ...],
    sent: int,
) -> Executed:
    """In the judge's ticks, of which a millisecond has more."""
    ticks = np.arange(begin, end + 1, MS // FINER, dtype=np.int64)
    joints = range(len(ready))
    steps = [pulses.joints[joint].between(begin, end).counts(ticks) for joint in joints]
    counts = np.array(ready) + np.array(steps).T
    executed = Executed()
    for message in board.sent[sent:]:
        if isinstance(message, Segment):
            t_end, duration = message.t_end * FINER, message.duration * FINER
            executed.command(replace(message, t_end=t_end, duration=duration))
        else:
            executed.command(message)
    epochs = sorted((arm.t_start, epoch) for epoch, arm in executed.arms.items())
    per_rad = board.configure.microsteps_per_rad
    epoch = 0
    for tick, row in zip(ticks, counts, strict=True):
        while epochs and epochs[0][0] <= tick:
            _, epoch = epochs.pop(0)
        whole = tuple(int(count) for count in row)
        angles = tuple(count / m for count, m in zip(whole, per_rad, strict=True))
        state, wide = BoardState.ARMED, tuple(count << 32 for count in whole)
        executed.samples.append(
            Sample(int(tick) * FINER, state, epoch, wide, whole, angles, moving=False, unheard=0)
        )
    return executed


def cut_in_motion(bad_wire: BadWire) -> Callable[[], None]:
    """For 60 reports of the board, of 5 ms each, once it has been moving for a while."""
    wire, board, began = bad_wire.wire, bad_wire.board, bad_wire.board.now

    def each() -> None:
        wire.cut = board.now - began > RIDE / 4 and wire.missed < 60

    return each


def towards_the_middle(steady: Wander) -> Wander:
    """Up or down without a rest on the way, so that a cut always finds the board in motion."""

    def knots(board: EmulatedBoard, *, seconds: float) -> list:
        assert board.session.theta is not None
        height = board.robot.forward(board.session.theta)[2]
        low = height < sum(board.robot.zone.z) / 2
        return steady(board, seconds=seconds, speed=-SPEED if low else SPEED, rests=True)

    return knots


def assert_a_lost_pulse_is_noticed(executed: Executed) -> None:
    counts = [sample.counts[0] for sample in executed.samples]
    step = max(range(1, len(counts)), key=lambda k: abs(counts[k] - counts[k - 1]))
    lost = counts[step] - counts[step - 1]
    for k in range(step, len(counts)):
        sample = executed.samples[k]
        first, *others = sample.positions
        executed.samples[k] = replace(
            sample,
            positions=(first - (lost << 32), *others),
            counts=(sample.counts[0] - lost, *sample.counts[1:]),
        )
    assert Judge(counted=True)(executed).wrong != []


@pytest.fixture
def bad_wire(emulated_board: Callable[..., EmulatedBoard], wander: Wander) -> BadWire:
    return BadWire(emulated_board, wander)


def test_a_bad_wire_a_cut_and_floods(bad_wire: BadWire, steady: Wander) -> None:
    board, random = bad_wire.board, Random(1)
    for fault in CHOSEN:
        bad_wire.ride(fault)
    assert bad_wire.wire.injected > 20
    stops = len(bad_wire.stops)
    bad_wire.ride(None, each=cut_in_motion(bad_wire), knots=towards_the_middle(steady))
    assert StopCause.UNDERRUN in bad_wire.stops[stops:]
    old = [write_frame(encode(m)[0], 0, encode(m)[1]) for m in board.sent if isinstance(m, Segment)]
    bad_wire.ride(None, each=lambda: board.send_bytes(random.choice(old)))
    bad_wire.ride(None, each=lambda: board.send_bytes(random.randbytes(20)))
    board.send_bytes(b"\0")
    stop = write_frame(encode(Stop())[0], 0, b"")
    bad_wire.ride(None, each=lambda: board.send_bytes(stop))
    assert bad_wire.stops[-1] is StopCause.HOST_STOP
    assert_a_lost_pulse_is_noticed(bad_wire.judge())


@pytest.mark.long
@pytest.mark.timeout(3600)
@pytest.mark.parametrize("unit", Unit)
@pytest.mark.parametrize("kind", Kind)
def test_every_kind_and_rate(bad_wire: BadWire, kind: Kind, unit: Unit) -> None:
    for fault in FAULTS:
        if (fault.kind, fault.unit) == (kind, unit):
            for _ in range(5):
                bad_wire.ride(fault)
    bad_wire.judge()
