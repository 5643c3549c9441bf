"""What the firmware costs: instructions and estimated cycles of each context, on the real image.

A rotary delta (with a fourth joint: one that turns its tool) at the top of what is promised:
99.8 kHz of steps on every axis at once, through turns of direction, ends of pieces and segments.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cache

from deltaviz import load_robot
from deltaviz.link.configuration import configure_from
from deltaviz.link.emulator.firmware import built
from deltaviz.link.messages import (
    Arm,
    BoardState,
    CartesianSegment,
    Configure,
    Enable,
    EStop,
    Hello,
    Home,
    Keep,
    Refused,
    Reset,
    Segment,
    Stop,
    Tool,
)
from tests.firmware.board_processor import SteppedBoard
from tests.firmware.clock_tree import ClockTree
from tests.firmware.processor import Cost

CPU_HZ, TICK_HZ, BYTES_HZ = 168_000_000, 200_000, 92_160
MS = TICK_HZ // 1000
TOP = 99_800  # microsteps/s: what a board with this tick admits
ACCELERATION = 20_000_000  # microsteps/s²
INTERRUPT = 24  # cycles to enter and leave one: Cortex-M4 technical reference manual, 3.9
STEP, SERIAL = "step interrupt", "serial interrupt, a byte"
CONTROL, LINE_CONTROL = "control interrupt", "control interrupt, straight line"
SEGMENT, LINE_SEGMENT = "main loop, a segment", "main loop, a Cartesian segment"
LOCK = "main loop, keeping control waiting"
SEGMENTS_HZ = 100  # as the controller sends them
CALLED = ("dv_forward", "dv_inverse", "dv_frame_read")

# Duration (ms) and velocity at the end, of a motion of constant accelerations from rest to rest.
LINE = ((50, 200.0), (50, 0.0))  # the longest there are; mm/s
MOTION = ((6, TOP), (10, TOP), (12, -TOP), (10, -TOP), (6, 0))


@dataclass(frozen=True)
class Spread:
    """Of one context or function: what it costs on average, and at worst."""

    mean: Cost
    worst: Cost


def spread(costs: Iterable[Cost]) -> Spread:
    known = list(costs)
    mean = Cost(
        round(sum(c.instructions for c in known) / len(known)),
        round(sum(c.cycles for c in known) / len(known)),
    )
    worst = Cost(max(c.instructions for c in known), max(c.cycles for c in known))
    return Spread(mean, worst)


def configuration(joints: int) -> Configure:
    """The stm32 preset with as many microsteps as make 100 kHz of its top speed."""
    plain = configure_from(load_robot("stm32"))
    scale = 33

    def each(value: int) -> tuple[int, ...]:
        return (value,) * joints

    def resized(values: tuple[float, ...]) -> tuple[float, ...]:
        return values + (0.0,) * (joints - len(values))

    return replace(
        plain,
        joint_min=each(plain.joint_min[0] * scale),
        joint_max=each(plain.joint_max[0] * scale),
        velocity=each(round(TOP * 65.536)),
        unhomed_velocity=each(round(TOP * 65.536)),
        acceleration=each(round(ACCELERATION * 2**24 / 1e6)),
        microsteps_per_rad=(plain.microsteps_per_rad[0] * scale,) * joints,
        inverted=(False,) * joints,
        homing_switch=each(0),
        homing_fast=each(round(TOP / 5 * 65.536)),
        homing_slow=each(round(TOP / 5 * 65.536)),
        homing_backoff=each(150),
        homing_max_travel=each(10_000),
        ready=each(0),
        base_radius=resized(plain.base_radius),
        effector_radius=resized(plain.effector_radius),
        upper_arm=resized(plain.upper_arm),
        forearm=resized(plain.forearm),
        azimuth=resized(plain.azimuth),
    )


def homed_board(joints: int) -> SteppedBoard:
    """Enabled, and homed by switches that are pressed in their turn."""
    board = SteppedBoard(built("f407vet6.elf"), ClockTree(25_000_000))
    for command in (Hello(1), configuration(joints), Enable(on=True)):
        board.send(command)
    board.run(10)
    board.send(Keep(board.now))
    board.send(Home())
    for pressed in (True, False, True):
        board.press_switches(pressed)
        board.run(10)
        board.send(Keep(board.now))
    board.press_switches(False)
    board.run(100)
    board.send(Keep(board.now))
    assert board.state() is BoardState.HALTED, board.telemetry
    return board


def segments(board: SteppedBoard, joints: int) -> list[Segment]:
    """MOTION, all joints alike, from now on."""
    built_up: list[Segment] = []
    t_end, place, speed = board.now, 0.0, 0
    for index, (ms, end_speed) in enumerate(MOTION):
        t_end, place = t_end + ms * MS, place + (speed + end_speed) / 2 * ms / 1000
        speed = end_speed
        built_up.append(
            Segment(
                epoch=1,
                index=index,
                t_end=t_end,
                duration=ms * MS,
                seen=board.now,
                p=(round(place * 1024),) * joints,
                v=(round(speed * 65.536),) * joints,
            )
        )
    return built_up


def line(board: SteppedBoard, *, epoch: int) -> list[CartesianSegment]:
    """LINE along x, from now on."""
    x, y, z = load_robot("stm32").forward((0.0,) * 3)
    made: list[CartesianSegment] = []
    t_end, speed = board.now, 0.0
    for index, (ms, end_speed) in enumerate(LINE):
        t_end, x = t_end + ms * MS, x + (speed + end_speed) / 2 * ms / 1000
        speed = end_speed
        made.append(
            CartesianSegment(
                epoch=epoch,
                index=index,
                t_end=t_end,
                duration=ms * MS,
                seen=board.now,
                p=(round(x * 256_000), round(y * 256_000), round(z * 256_000)),
                v=(round(speed * 65_536), 0, 0),
            )
        )
    return made


def drive(
    board: SteppedBoard, arm: Arm, made: Sequence[Segment | CartesianSegment]
) -> tuple[list[Cost], list[Cost], list[Cost], dict[str, list[Cost]]]:
    """Costs of receiving each segment, of the steps and of the pieces of their motion; and of what
    is called in these.
    """
    board.send(arm)
    board.processor.watch(*CALLED)
    received = [board.send(segment) for segment in made]
    steps: list[Cost] = []
    pieces: list[Cost] = []
    for _ in range(sum(segment.duration for segment in made)):
        step, piece = board.tick()
        steps.append(step)
        if piece is not None:
            pieces.append(piece)
            board.poll()
    board.run(3)
    assert not [message for message in board.said() if isinstance(message, Refused)]
    assert board.state() is BoardState.ARMED, board.telemetry
    return received, steps, pieces, board.processor.watched


def arm(board: SteppedBoard, *, epoch: int) -> Arm:
    """At rest, from now on."""
    board.send(Keep(board.now))
    board.run(10)
    board.said()
    assert board.telemetry is not None
    return Arm(epoch=epoch, t_start=board.now, counts=board.telemetry.counts)


def trouble(board: SteppedBoard) -> list[Cost]:
    """Costs of the pieces in which a line ends by a segment that leads nowhere. Then all the
    messages that have not been sent yet.
    """
    board.send(arm(board, epoch=3))
    good = line(board, epoch=3)
    last = good[-1]
    bad = replace(last, index=2, t_end=last.t_end + last.duration, p=(1 << 30, 0, 0))
    for segment in good:
        board.send(segment)
    pieces: list[Cost] = []
    for tick in range(100 * MS):
        if tick == 50 * MS:
            board.send(bad)
        _, piece = board.tick()
        if piece is not None:
            pieces.append(piece)
            board.poll()
    assert any(isinstance(m, Refused) for m in board.said())
    assert board.state() is BoardState.HALTED, board.telemetry
    tool = Tool(on=True, servo_angle=0.0)
    for message in (tool, Stop(), EStop(), Reset(), Enable(on=True), Enable(on=False)):
        board.send(message)
    return pieces


@cache
def budget(joints: int) -> dict[str, Spread]:
    """By name: contexts, and functions that are called in them."""
    board = homed_board(joints)
    byte = board.byte()
    turns = arm(board, epoch=1)
    received, steps, pieces, called = drive(board, turns, segments(board, joints))
    straight = arm(board, epoch=2)
    line_received, _, line_pieces, line_called = drive(board, straight, line(board, epoch=2))
    line_pieces += trouble(board)
    functions = {name: called[name] + line_called[name] for name in CALLED}
    return {
        STEP: spread(steps),
        CONTROL: spread(pieces),
        LINE_CONTROL: spread(line_pieces),
        SERIAL: spread([byte]),
        SEGMENT: spread(received),
        LINE_SEGMENT: spread(line_received),
        LOCK: spread(board.locks),
        **{name: spread(costs) for name, costs in functions.items()},
    }


def left(joints: int) -> float:
    """Of the processor's cycles, beside the interrupts of every axis at its top speed and of a link
    that is full both ways.
    """
    costs = budget(joints)
    per_second = {STEP: TICK_HZ, SERIAL: 2 * BYTES_HZ}
    return 1 - sum((costs[n].mean.cycles + INTERRUPT) * hz for n, hz in per_second.items()) / CPU_HZ


def share(joints: int) -> float:
    """Of the processor's cycles: every axis at its top speed, the link full in one direction."""
    costs = budget(joints)
    per_second = {STEP: TICK_HZ, CONTROL: 1000, SERIAL: BYTES_HZ}
    cycles = sum((costs[n].mean.cycles + INTERRUPT) * hz for n, hz in per_second.items())
    return (cycles + costs[SEGMENT].mean.cycles * SEGMENTS_HZ) / CPU_HZ
