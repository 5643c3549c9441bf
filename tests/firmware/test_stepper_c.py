"""The step interrupt by the pulses that leave: each count a step, in time, and none lost."""

from __future__ import annotations

import ctypes as c
import random

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deltaviz.link.messages import BoardState
from tests.firmware.c_board import BOUNDARY, CBoard, library
from tests.firmware.pulses import Pulses, check_lag, nearest, pulses
from tests.link.board.bench import Bench, gantry

Q32 = 1 << 32
PIECE = 200  # ticks
JOINTS = 4
TOP = Q32 // 2  # a step every other tick


class CPiece(c.Structure):
    _fields_ = [("target", c.c_int64 * JOINTS), ("increment", c.c_int64 * JOINTS)]


class CAxis(c.Structure):
    _fields_ = [
        ("position", c.c_int64),
        ("increment", c.c_int64),
        ("target", c.c_int64),
        ("emitted", c.c_int32),
    ]


class CStepper(c.Structure):
    """`struct dv_stepper`."""

    _fields_ = [
        *((name, c.c_uint32) for name in ("now", "boundary", "left", "piece_ticks", "joints")),
        *((name, c.c_uint32) for name in ("high", "forward", "inverted")),
        ("axis", CAxis * JOINTS),
        ("next", CPiece),
        ("ready", c.c_bool),
        ("late", c.c_bool),
    ]


class Stepper:
    """The stepper alone. `pins` and `positions` (Q32) of every tick."""

    def __init__(self, *, joints: int = JOINTS, now: int = 0) -> None:
        self._dv, self.state = library(), CStepper()
        self._self = c.byref(self.state)
        self._dv.dv_stepper_init(self._self, c.c_uint32(1000 * PIECE), c.c_uint32(now))
        self._dv.dv_stepper_use(self._self, c.c_uint32(joints), c.c_uint32(0))
        self._dv.dv_stepper_tick.restype = c.c_uint32
        self._dv.dv_stepper_position.restype = c.c_int64
        self.joints = joints
        self.pins: list[int] = []
        self.positions: list[list[int]] = []
        self._planned = [0] * joints

    def piece(self, targets: list[int]) -> None:
        """Plans a piece to `targets`, and runs the one before it."""
        self.plan(targets)
        for _ in range(PIECE):
            self.tick()

    def plan(self, targets: list[int]) -> None:
        numbers = c.c_int64 * JOINTS
        steps = [(t - p) // PIECE for t, p in zip(targets, self._planned, strict=True)]
        self._dv.dv_stepper_plan(self._self, numbers(*targets), numbers(*steps))
        self._planned = targets

    def tick(self) -> int:
        pins = self._dv.dv_stepper_tick(self._self)
        self.pins.append(pins)
        here = (self._dv.dv_stepper_position(self._self, c.c_uint32(i)) for i in range(self.joints))
        self.positions.append(list(here))
        return pins

    def train(self, joint: int) -> tuple[Pulses, np.ndarray]:
        """What left of a joint's pins, and its counts."""
        counts = nearest(np.array([at[joint] for at in self.positions]))
        return pulses(self.pins, joint), counts


def test_a_hundred_thousand_steps_a_second_on_every_joint():
    stepper = Stepper()
    targets = [0] * JOINTS
    for _ in range(50):
        targets = [t + sign * TOP * PIECE for t, sign in zip(targets, (1, -1, 1, -1), strict=True)]
        stepper.piece(targets)
    stepper.piece(targets)
    stepper.piece(targets)
    for joint in range(JOINTS):
        train, counts = stepper.train(joint)
        train.check_timing()
        check_lag(train, counts)
        assert abs(train.counts[-1]) == 50 * 100
        assert train.step[2 * PIECE : 50 * PIECE].sum() == 48 * 100


# Pieces of up to the top rate either way; standing, creeping and turning round among them.
paces = st.sampled_from([0, 1, -1, TOP, -TOP, TOP - 1, 3]) | st.integers(-TOP, TOP)
ends = st.integers(0, PIECE - 1)  # what the division drops


@settings(deadline=None, max_examples=60)
@given(st.lists(st.tuples(*[paces] * JOINTS, ends), min_size=1, max_size=12))
def test_any_pieces(pieces):
    """A real joint turns round at rest; here it does at full speed, and owes one more step."""
    stepper = Stepper(now=2**32 - 777)
    targets = [0] * JOINTS
    for *rates, end in pieces:
        targets = [t + rate * PIECE + end for t, rate in zip(targets, rates, strict=True)]
        stepper.piece(targets)
    stepper.piece(targets)
    stepper.piece(targets)
    assert stepper.positions[-1] == targets
    for joint in range(JOINTS):
        train, counts = stepper.train(joint)
        train.check_timing()
        check_lag(train, counts, ticks=4)
        assert train.counts[-1] == counts[-1] == stepper.state.axis[joint].emitted


def test_boundaries_come_every_piece_and_say_so():
    stepper = Stepper(now=2**32 - 300)
    marks = []
    for tick in range(1, 4 * PIECE + 1):
        if stepper.tick() & BOUNDARY:
            marks.append(tick)
            assert stepper.state.boundary == (2**32 - 300 + tick) % 2**32
            stepper.plan([0] * JOINTS)
    assert marks == [PIECE, 2 * PIECE, 3 * PIECE, 4 * PIECE]
    assert not stepper.state.late


def test_a_piece_that_was_not_planned_stands_still():
    stepper = Stepper()
    stepper.piece([TOP * PIECE] * JOINTS)
    for _ in range(3 * PIECE):
        stepper.tick()
    assert stepper.state.late
    assert stepper.positions[-1] == stepper.positions[2 * PIECE] == [TOP * PIECE] * JOINTS


@pytest.mark.parametrize(("share", "judge"), [(0.3, "lag"), (0.7, "timing")])
def test_the_judges_notice_one_edge_more_or_less(share, judge):
    stepper = Stepper(joints=1)
    targets = [0]
    for rate in (TOP // 2, TOP // 3, -TOP // 5):
        targets = [targets[0] + rate * PIECE]
        stepper.piece(targets)
    stepper.piece(targets)
    train, counts = stepper.train(0)
    steps = np.flatnonzero(train.step)
    at = steps[int(share * len(steps))]
    step = train.step.copy()
    if judge == "lag":
        step[at] = 0
    else:
        step[at + 1] = 1
    spoilt = Pulses(step, train.dir)
    with pytest.raises(AssertionError):
        check_lag(spoilt, counts) if judge == "lag" else spoilt.check_timing()


# On the whole board.


def drive(bench: Bench, chance: random.Random, knots: int) -> None:
    """Joints that go for now this speed, now that, 10 ms a knot; then the brake."""
    joints = len(bench.board.counts)
    p, v = [float(count) for count in bench.board.counts], [0.0] * joints
    aims = [0.0] * joints
    bench.arm()
    for number in range(knots):
        for i in range(joints):
            if chance.random() < 0.1:
                aims[i] = chance.choice([-3500.0, -200.0, 0.0, 90.0, 3500.0])
            faster = v[i] + max(-450.0, min(450.0, aims[i] - v[i]))
            p[i] += (v[i] + faster) / 2 * 0.010
            v[i] = faster
        bench.segment(p, v)
        if number > 3:
            bench.run(10)
    bench.run_to_rest()


def test_the_board_emits_what_it_counts():
    configure = gantry(JOINTS, joint_min=(-9.0,) * JOINTS, joint_max=(9.0,) * JOINTS)
    bench = Bench(configure, make_board=CBoard, now=2**32 - 5000)
    board = bench.board
    assert isinstance(board, CBoard)
    start, board.pins = np.array(board.positions), []
    places = [start]
    drive(bench, random.Random(3), 60)
    assert board.state is BoardState.HALTED
    pieces = len(board.pins) // PIECE
    places += [np.array(at) * Q32 for at in bench.trace]
    view = board.look()
    for joint in range(JOINTS):
        train = pulses(board.pins, joint)
        train.check_timing()
        assert train.step.sum() > 100
        assert train.counts[-1] == view.counts[joint] - nearest(start)[joint]
        assert view.emitted[joint] == view.counts[joint]
        # At each boundary, what has left is the count, but for two ticks.
        at = np.arange(1, pieces + 1) * PIECE - 1
        counts = nearest(np.array(places[1:])[:, joint].astype(np.int64)) - nearest(start)[joint]
        before, behind = train.counts[at - 2], train.counts[np.minimum(at + 2, len(board.pins) - 1)]
        assert ((counts == before) | (counts == train.counts[at]) | (counts == behind)).all()


@pytest.mark.parametrize(
    "minutes", [0.25, pytest.param(60, marks=[pytest.mark.long, pytest.mark.timeout(1200)])]
)
def test_nothing_drifts(minutes):
    """Round and round: the longest segments, of positions with fractions; then all that was sent is
    where the counter is, to the last 2^-32 of a microstep.
    """
    configure = gantry(3, joint_min=(-9.0,) * 3, joint_max=(9.0,) * 3)
    bench = Bench(configure, make_board=CBoard)
    chance = random.Random(7)
    bench.arm()
    start = np.array(bench.board.counts)
    ends = []
    for number in range(round(minutes * 60 / 0.050)):
        p = [float(at) + chance.randint(-6000, 6000) / 1024 for at in start]
        assert not [m for m in bench.segment(p, [0.0] * 3, ms=50) if hasattr(m, "reason")]
        ends.append([round(x * 1024) << 22 for x in p])
        if number > 3:
            bench.advance(50 * PIECE)
            bench.seen = bench.board.now
    bench.run_to_rest()
    board = bench.board
    assert isinstance(board, CBoard)
    view = board.look()
    assert board.positions == ends[-1]
    assert list(view.emitted[:3]) == list(view.counts[:3]) == list(board.counts)
    assert [t + s for t, s in zip(view.travelled, start, strict=False)] == list(view.counts[:3])
