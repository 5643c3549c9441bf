"""Scripts of a host that mostly knows the way: for hypothesis to write and to shorten."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from hypothesis import strategies as st

from deltaviz.link.messages import (
    PROTOCOL_VERSION,
    Arm,
    BoardState,
    CartesianSegment,
    Enable,
    EStop,
    Hello,
    Home,
    HostMessage,
    Keep,
    Reset,
    RobotKind,
    Segment,
    Stop,
    StopCause,
    Tool,
)
from deltaviz.link.rules import TICK_HZ
from deltaviz.link.wire.frames import write_frame
from tests.firmware.both_boards import CONFIGURATIONS, Pair
from tests.firmware.two_judges import Knots

MASK = 0xFFFF_FFFF
EMULATOR_HZ = 40_000


@dataclass
class Player:
    """A host that knows the way, and does what the steps of a script say."""

    pair: Pair
    epoch: int = 65530
    index: int = 0
    t_end: int = 0
    p: Sequence[float] = ()
    v: Sequence[float] = ()
    last: bytes = b""

    def play(self, step: tuple[Any, ...]) -> None:
        name, *values = step
        getattr(self, f"_{name}")(*values)

    def finish(self) -> None:
        """Left alone, both come to rest, and say the same until then."""
        self.pair.advance(500 * self.pair.ms)
        assert not self.pair.simulated.moving

    # Steps.

    def _command(self, message: HostMessage) -> None:
        self.last = self.pair.send(message)

    def _keep(self, ago: int) -> None:
        self.pair.send(Keep((self._now - ago) & MASK))

    def _get_ready(self) -> None:
        """From whatever it is in."""
        self.pair.send(Reset())
        self.pair.send(Enable(on=True))
        self._keep(0)

    def _arm(self, later: int, off: int) -> None:
        counts = self.pair.simulated.counts
        self.epoch = (self.epoch + later) & 0xFFFF
        wrong = tuple(count + off for count in counts)
        self.last = self.pair.send(Arm(self.epoch, self._now, wrong))
        if self.pair.simulated.state is BoardState.ARMED:
            self.index, self.t_end = 0, self._now
            self.p, self.v = [float(count) for count in counts], [0.0] * len(counts)

    def _old_arm(self) -> None:
        """At rest, with the epoch that was open."""
        self.pair.send(Stop())
        self.pair.advance(100 * self.pair.ms)
        self._get_ready()
        self._arm(0, 0)

    def _move(self, pushes: Sequence[int], ms: int, segments: int, wait: int) -> None:
        if len(self.p) != len(self.pair.configure.ready):
            return
        for _ in range(segments):
            self._one_segment(pushes, ms, ("", 0))
        self.pair.advance(wait)

    def _spoilt(self, pushes: Sequence[int], ms: int, field: str, value: int) -> None:
        if len(self.p) == len(self.pair.configure.ready):
            self._one_segment(pushes, ms, (field, value))

    def _run_into_switch(self, joint: int, ticks: int) -> None:
        self._get_ready()
        self._arm(1, 0)
        self._move([5, -5], 10, 10, ticks)
        for pressed in (True, None):
            self._inputs(joint, pressed, False)
            self.pair.advance(2 * self.pair.ms)

    def _stand_on_switch(self, joint: int, ticks: int) -> None:
        """Pressed before anything moves, as a broken wire reads."""
        self._get_ready()
        self._inputs(joint, True, False)
        self.pair.advance(2 * self.pair.ms)
        self._arm(1, 0)
        self._move([5, -5], 10, 10, ticks)
        self._inputs(joint, None, False)

    def _interrupt(self, ticks: int, command: HostMessage) -> None:
        """In the middle of a motion that begins here."""
        self._get_ready()
        self._arm(1, 0)
        self._move([5, -5], 10, 10, ticks)
        self._command(command)

    def _tip(self, ms: int) -> None:
        """Where no tip is known; what follows from one is single precision's."""
        if self.pair.configure.kind is RobotKind.JOINTS_ONLY or not self.pair.simulated.homed:
            when = (
                self.epoch,
                self.index,
                (self._now + ms * self.pair.ms) & MASK,
                ms * self.pair.ms,
                self._now,
            )
            self.pair.send(CartesianSegment(*when, (0, 0, -77_000_000), (0, 0, 0)))

    def _wait(self, ticks: int) -> None:
        self.pair.advance(ticks)

    def _silence(self, off: int) -> None:
        """Longer than the lease, which is from about a boundary."""
        self.pair.advance((-self._now_in_piece) % self.pair.ms + self.pair.ms + off)
        self._keep(0)
        self.pair.advance(160 * self.pair.ms)

    def _home(self, ms: int, stuck: bool | None) -> None:
        """From rest; under way, or done, after `ms`. `stuck`: what the first switch reads then."""
        for joint in range(4):
            self._inputs(joint, None if joint else stuck, False)
        self.pair.send(Stop())
        self.pair.advance(100 * self.pair.ms)
        self._get_ready()
        self.pair.send(Home())
        for _ in range(ms // 50):
            self.pair.advance(50 * self.pair.ms)
            self._keep(5 * self.pair.ms)

    def _inputs(self, joint: int, pressed: bool | None, estop: bool) -> None:
        for board in self.pair.boards:
            if joint < len(self.pair.simulated.counts):
                board.plant.force_switch(joint, pressed)
            board.press_estop(estop)

    def _again(self) -> None:
        self.pair.feed(self.last)

    def _noise(self, data: bytes) -> None:
        self.pair.feed(data)

    def _damaged(self, message: HostMessage, at: int, change: int) -> None:
        """A frame of which a byte is another, or that is cut short."""
        frame = bytearray(self.pair.host.frame(message))
        frame[at % len(frame)] ^= change
        self.pair.feed(bytes(frame[: at % len(frame)]) if change == 0 else bytes(frame))

    def _raw(self, type_: int, sequence: int, payload: bytes) -> None:
        """A whole frame of anything."""
        self.pair.feed(write_frame(type_, sequence, payload))

    # Segments.

    @property
    def _now(self) -> int:
        return self.pair.simulated.now

    @property
    def _now_in_piece(self) -> int:
        return (self._now - self.pair.start) % (1 << 32) % self.pair.ms

    def _one_segment(self, pushes: Sequence[int], ms: int, spoil: tuple[str, int]) -> None:
        """What is not taken, the host takes back."""
        simulated, before = self.pair.simulated, (self.p, self.v)
        if not simulated.moving and not any(self.v):
            self.t_end = self._now
        self._next_knot(pushes, ms / 1000)
        message = self._segment(ms * self.pair.ms, *spoil)
        taken = False
        if self._is_clear(message):
            self.pair.send(message)
            queue = simulated._control.queue
            taken = queue.next_index != self.index and len(queue) > 0
        if taken:
            self.index = (self.index + 1) & 0xFFFF
            self.t_end = message.t_end
        else:
            self.p, self.v = before

    def _segment(self, duration: int, spoilt: str, by: int) -> Segment:
        """With one field that is off `by` so much."""
        values = {
            "epoch": self.epoch,
            "index": self.index,
            "t_end": self.t_end + duration,
            "duration": duration,
            "seen": self._now,
        }
        knot = {
            "p": [round(x * 1024) for x in self.p],
            "v": [round(x * 65.536) for x in self.v],
        }
        if spoilt in knot:
            knot[spoilt][0] = max(-(1 << 31), min((1 << 31) - 1, knot[spoilt][0] + by))
        elif spoilt:
            values[spoilt] += by
        return Segment(
            values["epoch"] & 0xFFFF,
            values["index"] & 0xFFFF,
            values["t_end"] & MASK,
            values["duration"] & MASK,
            values["seen"] & MASK,
            tuple(knot["p"]),
            tuple(knot["v"]),
        )

    def _is_clear(self, message: Segment) -> bool:
        control = self.pair.simulated._control  # its queue's knot is where the segment begins
        knot = control.queue.knot
        ticks = message.duration * 200 // self.pair.ms  # of the judge
        if len(knot.p) != len(message.p) or not 800 <= ticks <= 10_000:
            return True
        return self.pair.judge.is_clear(
            Knots(knot.p, knot.v, message.p, message.v, ticks, homed=control.homed)
        )

    def _next_knot(self, pushes: Sequence[int], h: float) -> None:
        """`pushes` in sevenths of an acceleration; near its limits a joint brakes."""
        c = self.pair.configure
        p, v = list(self.p), list(self.v)
        for i in range(len(p)):
            top, most = c.velocity[i] / 65.536, c.acceleration[i] * 1e6 / 2**24
            low, high = c.joint_min[i] / 1024, c.joint_max[i] / 1024
            if not self.pair.simulated.homed:
                top, low, high = c.unhomed_velocity[i] / 65.536, -(10**6), 10**6
            push = pushes[i % len(pushes)]
            faster = max(-top, min(top, v[i] + push / 7 * most * h * 0.98))
            left = high - p[i] if v[i] > 0 else p[i] - low
            if v[i] * v[i] / (1.8 * most) + abs(v[i]) * h * 1.2 > left:
                faster = max(0.0, abs(v[i]) - 0.95 * most * h) * (1 if v[i] > 0 else -1)
            if v[i] == 0 and not low + 20 < p[i] < high - 20:
                faster = 0.0
            p[i] += (v[i] + faster) / 2 * h
            v[i] = faster
        self.p, self.v = p, v


def _steps() -> st.SearchStrategy[tuple[Any, ...]]:
    def step(name: str, *values: st.SearchStrategy[Any]) -> st.SearchStrategy[tuple[Any, ...]]:
        return st.tuples(st.just(name), *values)

    ticks = st.sampled_from([1, 199, 200, 201, 1000, 3000]) | st.integers(0, 6000)
    pushes = st.lists(st.integers(-7, 7), min_size=1, max_size=4)
    ms = st.integers(4, 50) | st.sampled_from([4, 10, 10, 10, 20])
    commands: list[HostMessage] = [
        Stop(), Stop(), EStop(), Reset(), Enable(on=True), Enable(on=False), Home(),
        Hello(PROTOCOL_VERSION), Hello(PROTOCOL_VERSION + 1), Tool(on=True, servo_angle=0.25),
        Tool(on=False, servo_angle=float("inf")), *CONFIGURATIONS,
    ]  # fmt: skip
    joints, estops = st.integers(0, 3), st.sampled_from([False, False, True])
    field = st.sampled_from(["epoch", "index", "t_end", "duration", "seen", "p", "v"])
    later, off = st.sampled_from([1, 1, 1, 1, 0, -1, 32767, 32768]), st.sampled_from([0] * 7 + [1])
    amount = st.sampled_from([0, 1, -1, 799, 10_001, 65535, 1 << 20, -(1 << 30)])
    amount |= st.integers(-5000, 5000)
    return st.one_of(
        step("get_ready"),
        step("get_ready"),
        step("arm", later, off),
        step("arm", st.just(1), st.just(0)),
        step("old_arm"),
        step("move", pushes, ms, st.integers(1, 8), ticks),
        step("move", pushes, ms, st.integers(1, 8), ticks),
        step("move", pushes, ms, st.integers(1, 70), ticks),
        step("spoilt", pushes, ms, field, amount),
        step("tip", ms),
        step("wait", ticks),
        step("wait", st.integers(0, 40_000)),
        step("keep", st.sampled_from([0, 1, 200, 29_799, 29_800, 29_999, 30_000, -1]) | ticks),
        step("home", st.sampled_from([50, 300, 2500]), st.sampled_from([None, None, True, False])),
        step("interrupt", ticks, st.sampled_from([Stop(), Stop(), Enable(on=False), EStop()])),
        step("interrupt", ticks, st.sampled_from(commands)),
        step("run_into_switch", joints, ticks),
        step("stand_on_switch", joints, ticks),
        step("silence", st.sampled_from([0, 0, -1, 1])),
        step("command", st.sampled_from(commands)),
        step("inputs", joints, st.sampled_from([True, False, None, None]), estops),
        step("again"),
        step("noise", st.binary(max_size=40)),
        step("damaged", st.sampled_from(commands), st.integers(0, 60), st.integers(0, 255)),
        step("raw", st.integers(0, 255), st.integers(0, 255), st.binary(max_size=60)),
    )


@dataclass(frozen=True)
class Script:
    homed: bool
    configuration: int
    now: int
    tick_hz: int
    steps: list[tuple[Any, ...]]


def scripts(*, most: int = 40) -> st.SearchStrategy[Script]:
    return st.builds(
        Script,
        homed=st.sampled_from([True, True, False]),
        configuration=st.integers(0, len(CONFIGURATIONS) - 1),
        now=st.sampled_from([1000, 2**32 - 4000, 2**31 - 5001]),
        tick_hz=st.sampled_from([TICK_HZ, TICK_HZ, EMULATOR_HZ]),
        steps=st.lists(_steps(), min_size=15, max_size=most),
    )


# Each ends a motion in another way.
SITUATIONS = {
    StopCause.HOST_STOP: [("interrupt", 1317, Stop())],
    StopCause.UNDERRUN: [("move", [5, -3], 10, 5, 6000), ("wait", 20_000)],
    StopCause.LEASE: [("move", [1], 50, 20, 7), ("silence", 0)],
    StopCause.BAD_SEGMENT: [("move", [5], 10, 5, 777), ("spoilt", [1], 10, "t_end", 1)],
    StopCause.LIMIT_SWITCH: [
        ("run_into_switch", 1, 3001),
        ("wait", 10_000),
        *(("stand_on_switch", joint, 3001) for joint in (0, 1)),
        ("wait", 10_000),
    ],
    StopCause.ESTOP: [("interrupt", 4321, EStop()), ("get_ready",)],
    StopCause.DISABLED: [("interrupt", 2468, Enable(on=False)), ("wait", 20_000)],
    StopCause.HOMED: [("home", 2500, None), ("arm", 1, 0), ("move", [2], 10, 5, 2000)],
    StopCause.HOMING_FAILED: [("home", 2500, True), ("wait", 2000)],
}


def situations() -> list[Script]:
    """Of every make, and across the wraps of the counter."""
    starts = [
        (True, 0, 1000, TICK_HZ),
        (False, 1, 2**32 - 4000, EMULATOR_HZ),
        (True, 2, 2**31 - 5001, TICK_HZ),
    ]
    return [Script(*start, steps) for steps in SITUATIONS.values() for start in starts]


def play(script: Script) -> Pair:
    """Raises AssertionError where the boards differ."""
    pair = Pair(
        homed=script.homed,
        configuration=script.configuration,
        now=script.now,
        tick_hz=script.tick_hz,
    )
    player = Player(pair)
    player.play(("get_ready",))
    player.play(("arm", 1, 0))
    for step in script.steps:
        player.play(step)
    player.finish()
    return pair
