"""Whatever messages come, in whatever order: no limit is broken, and it ends at rest."""

from __future__ import annotations

import random
from dataclasses import replace
from itertools import pairwise

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from deltaviz.link.board.checks import Checks
from deltaviz.link.board.lease import Lease
from deltaviz.link.messages import (
    BoardState,
    Enable,
    EStop,
    Hello,
    Home,
    Keep,
    Reset,
    Segment,
    Stop,
    StopCause,
    Tool,
)
from tests.link.board.bench import simulated_only

ACCELERATION = 50_000.0
VELOCITY = 4000.0
LOW, HIGH = -300.0, 400.0
LIMITED = settings(
    deadline=None,
    derandomize=True,
    max_examples=12,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)


@pytest.fixture
def narrow(make_bench, make_configure):
    """Benches with little room: limits are near."""

    def make():
        room = {"joint_min": (LOW / 1000,) * 2, "joint_max": (HIGH / 1000,) * 2}
        return make_bench(make_configure(**room))

    return make


class Chaos:
    """A host that means well most of the time, and is wrong in every way the rest of it."""

    def __init__(self, bench, rng: random.Random, *, wild: float) -> None:
        self.bench = bench
        self.rng = rng
        self.wild = wild
        self.p = [0.0, 0.0]
        self.v = [0.0, 0.0]
        self.way = [1, -1]
        self.traces: list[list[list[float]]] = [[]]

    def run(self, actions: int) -> None:
        for _ in range(actions):
            self._act()
        self._pass_time(600, keep=False)

    def _act(self) -> None:
        rng, bench = self.rng, self.bench
        if bench.board.state is not BoardState.ARMED and not bench.board.moving:
            self._get_ready()
            return
        if rng.random() < self.wild:
            self._do_wrong()
        elif rng.random() < 0.75:
            for _ in range(rng.randint(1, 6)):
                self._send_segment()
        self._pass_time(rng.randint(0, 40), keep=rng.random() < 0.95)

    def _get_ready(self) -> None:
        """At rest: the fraction of a microstep is forgotten, so a new trace begins."""
        bench = self.bench
        bench.send(Reset())
        bench.send(Enable(on=True))
        bench.advance(self.rng.randint(1, 400))
        bench.send(Keep(bench.now))
        bench.arm()
        self.traces.append([])
        self.p = [float(count) for count in bench.board.counts]
        self.v = [0.0, 0.0]

    def _next_knot(self, h: float) -> None:
        rng = self.rng
        for joint in range(2):
            if rng.random() < 0.03:
                self.way[joint] = rng.choice([-1, 0, 1])
            reach = ACCELERATION * rng.choice([0.5, 0.95, 1.0]) * h
            v = self.v[joint]
            faster = max(
                -VELOCITY, min(VELOCITY, v + self.way[joint] * rng.random() ** 0.3 * reach)
            )
            # Like a host that knows its limits: brake when the way left is needed for it.
            if v == 0 and not LOW + 30 < self.p[joint] < HIGH - 30:
                self.way[joint] = 1 if self.p[joint] < 0 else -1
            left = (HIGH - self.p[joint]) if v > 0 else (self.p[joint] - LOW)
            if v * v / (2 * 0.9 * ACCELERATION) + abs(v) * h * 1.1 > left:
                faster = max(0.0, abs(v) - 0.95 * ACCELERATION * h) * (1 if v > 0 else -1)
            self.p[joint] += (v + faster) / 2 * h
            self.v[joint] = faster

    def _send_segment(self) -> None:
        bench, rng = self.bench, self.rng
        ms = rng.randint(4, 20)
        if not any(self.v) and not bench.board.moving:
            bench.t_end = bench.now
        self._next_knot(ms / 1000)
        changes = {}
        if rng.random() < self.wild / 3:
            field = rng.choice(["epoch", "index", "t_end", "duration", "seen"])
            changes[field] = rng.choice([0, 1, 799, 10_001, rng.getrandbits(16)])
        p, v = list(self.p), list(self.v)
        if rng.random() < self.wild / 3:
            joint = rng.randint(0, 1)
            p[joint] += rng.choice([0.3, -0.5, 3, -10, 2000])
        if rng.random() < self.wild / 3:
            v[rng.randint(0, 1)] += rng.choice([50, -100, 600, -5000])
        bench.segment(p, v, ms=ms, **changes)

    def _do_wrong(self) -> None:
        bench, rng = self.bench, self.rng
        joints = rng.randint(0, 3)
        wrong = Segment(
            bench.epoch, bench.index, rng.getrandbits(32), rng.getrandbits(14),
            rng.getrandbits(32), tuple(rng.randint(-2**31, 2**31 - 1) for _ in range(joints)),
            tuple(rng.randint(-2**31, 2**31 - 1) for _ in range(joints)),
        )  # fmt: skip
        bench.send(
            rng.choice(
                [
                    Stop(), Hello(1), Hello(9), Enable(on=False), Enable(on=True), Reset(),
                    Tool(on=True, servo_angle=float("nan")), Keep(rng.getrandbits(32)),
                    wrong, replace(wrong, epoch=0), bench.configure,
                ]
            )
        )  # fmt: skip
        bench.send(Hello(1))

    def _pass_time(self, ms: int, *, keep: bool) -> None:
        bench = self.bench
        for _ in range(ms):
            part = self.rng.randint(0, 199)
            bench.advance(part)
            if part % 7 == 0 and self.rng.random() < self.wild / 5:
                bench.send(Stop())  # in the middle of a millisecond
            bench.advance(200 - part)
            if keep:
                bench.send(Keep(bench.seen))
            self.traces[-1].append([p / 2**32 for p in bench.board.positions])


def judge(chaos: Chaos, accelerations) -> tuple[float, float, float]:
    """The highest acceleration, speed and distance beyond a joint limit that were seen."""
    top = speed = 0.0
    beyond = float("-inf")
    for trace in chaos.traces:
        top = max(top, accelerations(trace))
        for before, here in pairwise(trace):
            for a, b in zip(before, here, strict=True):
                speed = max(speed, abs(b - a) * 1000)
                beyond = max(beyond, b - HIGH, LOW - b)
    return top, speed, beyond


@LIMITED
@given(seed=st.integers(0, 2**32 - 1), wild=st.sampled_from([0.0, 0.05, 0.3]))
def test_no_limit_is_broken_whatever_comes(narrow, accelerations, seed, wild):
    bench = narrow()
    chaos = Chaos(bench, random.Random(seed), wild=wild)
    chaos.run(25)
    top, speed, beyond = judge(chaos, accelerations)
    # 5 ms windows: rounding to the units of the messages may add a hundredth at 4 ms segments.
    assert top <= ACCELERATION * 1.02
    assert speed <= VELOCITY * 1.002
    # A brake from the middle of a segment may end a little past the brake from its knot.
    assert beyond <= 3.0
    assert not bench.board.moving
    assert bench.board.state in (BoardState.HALTED, BoardState.ARMED, BoardState.DISABLED)
    arms = [round(theta * 1000) for theta in bench.board.plant.theta]
    if bench.board.homed:
        assert tuple(arms) == bench.board.counts  # no step was lost


def test_the_fuzz_reaches_the_limits(narrow, accelerations):
    """It would prove nothing if the motions were tame."""
    seen = [0.0, 0.0, -1000.0]
    causes = set()
    for seed in range(6):
        bench = narrow()
        chaos = Chaos(bench, random.Random(seed), wild=0.1)
        chaos.run(25)
        top, speed, beyond = judge(chaos, accelerations)
        seen = [max(seen[0], top), max(seen[1], speed), max(seen[2], beyond)]
        causes |= {getattr(m, "cause", None) for m in bench.said}
    assert seen[0] > 0.95 * ACCELERATION
    assert seen[1] > 0.9 * VELOCITY
    assert seen[2] > -40.0  # microsteps from a joint limit
    assert {StopCause.UNDERRUN, StopCause.BAD_SEGMENT, StopCause.HOST_STOP} <= causes


@simulated_only
def test_without_the_boards_checks_the_fuzz_finds_broken_limits(narrow, accelerations, monkeypatch):
    monkeypatch.setattr(Checks, "objection", lambda *_, **__: None)
    bench = narrow()
    chaos = Chaos(bench, random.Random(1), wild=0.3)
    chaos.run(25)
    top, speed, beyond = judge(chaos, accelerations)
    assert top > 2 * ACCELERATION or speed > 2 * VELOCITY or beyond > 50


@simulated_only
def test_without_the_lease_a_silent_host_keeps_it_moving(bench, monkeypatch):
    monkeypatch.setattr(Lease, "remaining", lambda *_: 1_000_000)
    bench.speed_up(500)
    bench.go_on(40)
    bench.run(300, keep=False)
    assert bench.board.state is BoardState.ARMED


@LIMITED
@given(seed=st.integers(0, 2**32 - 1))
def test_every_message_in_every_state_is_answered_or_taken_and_it_comes_to_rest(make_bench, seed):
    rng = random.Random(seed)
    bench = make_bench(homed=rng.random() < 0.5)
    for _ in range(80):
        bench.send(
            rng.choice(
                [Stop(), EStop(), Home(), Reset(), Enable(on=True), Enable(on=True),
                 Enable(on=False), Hello(1), Keep(bench.now), Keep(bench.seen)]
            )
        )  # fmt: skip
        if rng.random() < 0.3:
            bench.arm()
        if rng.random() < 0.1:
            bench.board.press_estop(rng.random() < 0.5)
        bench.run(rng.randint(0, 60), keep=rng.random() < 0.8)
    bench.run(400, keep=False)
    assert not bench.board.moving


@pytest.mark.parametrize("ms", range(1, 90, 4))
def test_a_stop_at_any_moment_of_a_move_is_a_brake(make_bench, accelerations, ms):
    bench = make_bench()
    bench.speed_up(3000)
    bench.go_on(2)
    bench.run(ms)
    bench.advance(ms % 200)
    bench.send(Stop())
    trace = [[p / 2**32 for p in bench.board.positions]]
    while bench.board.moving:
        bench.advance(200)
        trace.append([p / 2**32 for p in bench.board.positions])
    assert len(trace) <= 3000 / ACCELERATION * 1000 + 3
    assert accelerations(bench.trace) <= ACCELERATION * 1.02
    assert accelerations(trace, window=3) <= ACCELERATION * 1.06
