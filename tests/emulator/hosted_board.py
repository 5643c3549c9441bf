"""An emulated board at the end of a wire, for a host that is a program of its own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from random import Random

import numpy as np

from deltaviz.link.configuration import configure_from
from deltaviz.link.emulator.arms import arms_of
from deltaviz.link.emulator.bench import Bench
from deltaviz.link.emulator.emulator import Emulator
from deltaviz.link.emulator.firmware import built
from deltaviz.link.emulator.pace import Pace
from deltaviz.link.emulator.wire_pair import wire_pair
from deltaviz.robots import Robot
from tests.emulator import judge
from tests.emulator.motions import Motion, motions
from tests.emulator.overheard import Stopped
from tests.emulator.pin_trace import PinTrace
from tests.emulator.priority import coming_first
from tests.emulator.pulse_train import PulseTrain, pulse_train
from tests.emulator.wire import Wire

LEASE = 150  # ms of board time
SURE = 1.0  # ms by which the fit of a brake may be late
TICKS_PER_MS = 40


class HostedBoard:
    """Switched on, with its arms hanging somewhere. A host connects to `wire.url`."""

    def __init__(self, robot: Robot) -> None:
        self.robot = robot
        self._configure = configure_from(robot)
        self._emulator, self._trace, link, pace = self._power_up()
        self._born = 0
        self.wire = Wire(link, pace)

    @property
    def bench(self) -> Bench:
        return self._emulator.bench

    @property
    def tick_hz(self) -> int:
        return 1000 * self.wire.ticks_per_ms

    def _power_up(self):
        with coming_first():
            trace = PinTrace()
        link, board = wire_pair()
        pace, paced = Pace.pair()
        with board, paced, coming_first():
            emulator = Emulator.start(
                self._configure,
                image=built(),
                link=board,
                trace=trace.descriptor,
                pace=paced,
            )
        trace.started()
        return emulator, trace, link, pace

    def restart(self) -> PulseTrain:
        """Its power fails for a moment; the cable stays where it is. All pulses until then."""
        placed = arms_of(self._configure)
        where = self.bench.state().arms
        self._emulator.close()
        changes, _ = self._trace.finish()
        self._emulator, self._trace, link, pace = self._power_up()
        for joint, arm in enumerate(placed):
            self.bench.place(joint, replace(arm, at=where[joint]))
        self._born = len(self.wire.passed)
        self.wire.change_board(link, pace)
        return pulse_train(changes, inverted=self._configure.inverted)

    def pulses(self) -> PulseTrain:
        """All that have left the pins so far, up to the newest tick that the board has told."""
        changes = self._trace.until(self.wire.now)
        return pulse_train(changes, inverted=self._configure.inverted)

    def motions(self) -> list[Motion]:
        """All that was commanded since it was switched on."""
        passed = self.wire.passed[self._born :]
        return motions(passed, ticks_per_ms=self.wire.ticks_per_ms)

    def rested(self, epoch: int) -> int:
        """When it came to rest after what has stopped this epoch."""
        stops = self.wire.all(Stopped, after=self._born)
        return next(stopped.now for stopped in stops if stopped.epoch == epoch)

    @property
    def offsets(self) -> list[int]:
        """How far, at rest, each arm is from its count: since homing always the same, by at most a
        microstep, as long as no step is lost.
        """
        arms, counts = self.bench.state().arms, self.wire.telemetry.counts
        return [arm - count for arm, count in zip(arms, counts, strict=False)]

    def close(self) -> None:
        self.wire.close()
        self._emulator.close()
        self._trace.finish()


def assert_obeyed(board: HostedBoard, pulses: PulseTrain, motion: Motion) -> None:
    """What left the pins is what was commanded, until the end of it or until something stopped it;
    also while it was stopped it was within its limits.
    """
    assert pulses.faults == ()
    assert motion.until > motion.path.begin
    error = judge.position_error(pulses, motion.path, until=motion.until)
    assert max(error) < 1.0, f"microsteps from the path: {error}"
    until = motion.until + board.tick_hz  # the longest brake takes less
    limits = {"begin": motion.path.begin, "end": until, "tick_hz": board.tick_hz}
    assert not judge.beyond_limits(pulses, board.robot, **limits)


def assert_all_obeyed(board: HostedBoard, pulses: PulseTrain, motions: Sequence[Motion]) -> None:
    """A whole story without homing in it, up to now: each motion was obeyed, between them nothing
    moved, and the board has counted each step.
    """
    rest = board.wire.telemetry.counts
    following = [motion.path for motion in motions[1:]]
    ends = [*((path.begin, path.counts) for path in following), (board.wire.now, rest)]
    for motion, (end, counts) in zip(motions, ends, strict=True):
        assert_obeyed(board, pulses, motion)
        stood = board.rested(motion.epoch) if motion.stopped else motion.until
        for joint, start in enumerate(motion.path.counts):
            steps = pulses.joints[joint].between(motion.path.begin, end)
            assert start + steps.directions.sum() == counts[joint]
            assert not (steps.ticks > stood).any(), "a step that nobody has asked for"


def assert_lost_edges_are_noticed(pulses: PulseTrain, motion: Motion, random: Random) -> int:
    """One pulse of each joint is taken away, with one behind it to tell; of how many joints there
    was one.
    """
    begin, end = motion.path.begin, motion.until
    tried = 0
    for joint, steps in enumerate(pulses.joints[: len(motion.path.counts)]):
        during = np.nonzero((steps.ticks > begin) & (steps.ticks < end))[0][:-1]
        if len(during):
            lost = list(pulses.joints)
            lost[joint] = steps.without(int(random.choice(during)))
            error = judge.position_error(PulseTrain(tuple(lost), ()), motion.path, until=end)
            assert error[joint] >= 1.0
            tried += 1
    return tried


def assert_still(pulses: PulseTrain, *, since: int) -> None:
    for joint, steps in enumerate(pulses.joints):
        assert not (steps.ticks > since).any(), f"joint {joint} has moved on"


def assert_slows_in_time(pulses: PulseTrain, motion: Motion, *, seen: int) -> None:
    """By the steps of its fastest joint, at most 150 ms after the newest telemetry that the host
    is known to have had.
    """
    velocities = motion.path.velocities_at_knots
    fastest = int(np.argmax(np.abs(velocities[-1])))
    steady = motion.path.going_on(int(motion.path.ticks.sum()))
    began = judge.brake_began(pulses, steady, fastest)
    assert began <= seen + (LEASE + SURE) * TICKS_PER_MS
