"""What the simulated board does: motion, time, stops. What it is told is `board`'s concern."""

from __future__ import annotations

from collections.abc import Sequence

from deltaviz.link.board.checks import Checks
from deltaviz.link.board.drive import Drive
from deltaviz.link.board.homing import Homing
from deltaviz.link.board.lease import Lease
from deltaviz.link.board.parameters import Parameters
from deltaviz.link.board.paths import Cubic
from deltaviz.link.board.plant import Plant
from deltaviz.link.board.queue import SegmentQueue
from deltaviz.link.board.reports import Reports
from deltaviz.link.board.states import TRANSITIONS, BoardEvent
from deltaviz.link.messages import (
    Arm,
    BoardState,
    Enable,
    Fault,
    Home,
    Inputs,
    Refusal,
    Segment,
    StopCause,
    Stopped,
    Telemetry,
    TelemetryFlags,
)
from deltaviz.link.rules import LEASE_MS, QUEUE_PLACES, TELEMETRY_MS, since

_PASSED = (StopCause.NONE, StopCause.BOOT, StopCause.HOMED)  # not the cause of a stop


class ConfiguredBoard:
    """A board that knows its robot: the parts that depend on it."""

    def __init__(
        self, parameters: Parameters, *, theta: Sequence[float], hash_: int, tick_hz: int
    ) -> None:
        """`theta` is the hidden pose of the arms (rad)."""
        self.parameters = parameters
        self.hash = hash_
        self.checks = Checks(parameters, tick_hz=tick_hz)
        plant = Plant(parameters, theta=theta)
        self.drive = Drive(parameters, plant, ticks_per_ms=tick_hz // 1000)


class Core:
    def __init__(self, *, tick_hz: int, now: int, last_epoch: int) -> None:
        self.now = now
        self.state = BoardState.DISABLED
        self.fault = Fault.NONE
        self.cause = StopCause.BOOT
        self.homed = False
        self.epoch = last_epoch
        self.ticks_per_ms = tick_hz // 1000
        self.queue = SegmentQueue(QUEUE_PLACES)
        self.lease = Lease(LEASE_MS * self.ticks_per_ms)
        self.reports = Reports(TELEMETRY_MS * self.ticks_per_ms)
        self.robot: ConfiguredBoard | None = None
        self.estop_input = False
        self.disable_pending = False
        self._homing: Homing | None = None
        self._switches: list[bool] = []
        self._knot: tuple[Sequence[int], Sequence[int]] = ((), ())  # where the path leads

    @property
    def moving(self) -> bool:
        return self.robot is not None and self.robot.drive.moving

    @property
    def idle(self) -> bool:
        """Nothing moves and nothing waits to."""
        return not self.moving and not len(self.queue)

    @property
    def counts(self) -> tuple[int, ...]:
        return () if self.robot is None else self.robot.drive.counts

    def change(self, event: BoardEvent) -> None:
        self.state = TRANSITIONS[self.state, event]
        self.reports.changed = True

    # What commands begin.

    def configure(self, robot: ConfiguredBoard, *, homed: bool) -> None:
        """With `homed` the board has stood enabled at the ready pose before it could say so."""
        self.robot = robot
        self._switches = robot.drive.switches
        self.reports.changed = True
        if homed:
            robot.drive.place([count << 32 for count in robot.parameters.configure.ready])
            self.homed = True
            self.change(BoardEvent.ENABLE)

    def begin_homing(self, robot: ConfiguredBoard) -> None:
        self.homed = False
        self.cause = StopCause.NONE
        self.change(BoardEvent.HOME)
        self._homing = Homing(robot.parameters, ticks_per_ms=self.ticks_per_ms)
        self._go_on_homing(robot)

    def open_epoch(self, robot: ConfiguredBoard, arm: Arm) -> None:
        """Forgets fractions of a microstep, so that host and board start from the same point."""
        robot.drive.place([count << 32 for count in arm.counts])
        self.epoch = arm.epoch
        self.cause = StopCause.NONE
        self.queue.open(tuple(count << 10 for count in arm.counts), arm.t_start)
        self._knot = (self.queue.p, self.queue.v)
        self.change(BoardEvent.ARM)

    def enqueue(self, segment: Segment) -> None:
        self.queue.push(segment, idle_at=self.now if self.idle else None)
        self._begin_what_is_due()

    # Time.

    def advance(self, ticks: int) -> None:
        while ticks > 0:
            step = min(ticks, self._quiet_ticks())
            if self.robot is not None and self.robot.drive.moving:
                step = self.robot.drive.advance(step)
                self.now = (self.now + step) & 0xFFFF_FFFF
                self._look(self.robot)
            else:
                self.now = (self.now + step) & 0xFFFF_FFFF
            ticks -= step
            self._end_lease()
            self._begin_what_is_due()
            self.reports.pass_time(step)
            self.report()

    def _quiet_ticks(self) -> int:
        """How long nothing happens but motion."""
        ticks = self.reports.ticks_to_telemetry
        lease = self.lease.remaining(self.now)
        if lease is not None:
            ticks = min(ticks, lease)
        if not self.moving and (head := self.queue.head) is not None:
            ticks = min(ticks, since(head.start, self.now))
        return ticks

    def _look(self, robot: ConfiguredBoard) -> None:
        """After motion: what the switches say, and whether the path has ended."""
        switches = robot.drive.switches
        if switches != self._switches:
            newly = any(is_ and not was for is_, was in zip(switches, self._switches, strict=True))
            self._switches = switches
            self.reports.changed = True
            if newly and self.state is not BoardState.HOMING:
                self._fail(robot, Fault.LIMIT_SWITCH, StopCause.LIMIT_SWITCH, self._knot[1])
        if robot.drive.moving:
            return
        if self.state is BoardState.BRAKING:
            self._came_to_rest()
        elif self.state is BoardState.HOMING:
            self._go_on_homing(robot)
        elif self.queue.head is None and any(self._knot[1]):
            self._latch(StopCause.UNDERRUN)
            self.change(BoardEvent.BRAKE)
            robot.drive.brake_from(self._knot[1])

    def _end_lease(self) -> None:
        if self.lease.remaining(self.now) == 0:
            self.lease.expire()
            if not self.idle:
                self.halt(StopCause.LEASE)

    def _begin_what_is_due(self) -> None:
        head = self.queue.head
        if head is None or self.robot is None or self.robot.drive.moving:
            return
        if since(head.start, self.now) > 0:
            return
        segment = self.queue.pop().segment
        p0, v0 = self._knot
        self._knot = (segment.p, segment.v)
        self.robot.drive.follow(
            Cubic(
                start=p0,
                end=segment.p,
                v_start=v0,
                v_end=segment.v,
                ticks=segment.duration,
                ticks_per_ms=self.ticks_per_ms,
            )
        )

    def _go_on_homing(self, robot: ConfiguredBoard) -> None:
        drive = robot.drive
        if self._homing is None:
            self.homed = True
            self._latch(StopCause.HOMED)
            self.change(BoardEvent.HOMED)
            self.reports.done(Home())
            self.say_stopped()
            return
        positions = drive.positions
        velocities = self._homing.velocities
        path = self._homing.next_path(positions, self._switches)
        if self._homing.fault is not Fault.NONE:
            self._fail(robot, self._homing.fault, StopCause.HOMING_FAILED, velocities)
        elif path is not None:
            drive.follow(path)
        else:
            drive.place(self._homing.referenced(positions))
            drive.follow(self._homing.way_to_ready(drive.counts))
            self._homing = None

    # Stops.

    def halt(self, cause: StopCause) -> None:
        """Ends what the host had begun: by the brake if it moves. Without effect at rest."""
        self.queue.clear()
        if self.robot is not None and self.moving:
            if self.state is not BoardState.BRAKING:
                self._latch(cause)
                self.change(BoardEvent.BRAKE)
                self.robot.drive.brake()
        elif self.state is BoardState.ARMED:
            self._latch(cause)
            self.change(BoardEvent.HALT)
            self.say_stopped()

    def drivers_off(self, fault: Fault) -> None:
        """The e-stop. The arms of the model stay where they are; real ones may drop."""
        if self.robot is not None:
            self.robot.drive.cut()
        self.queue.clear()
        self._homing = None
        self.disable_pending = False
        self.homed = False
        self.fault = fault
        self.cause = StopCause.ESTOP
        self.change(BoardEvent.ESTOP)
        self.say_stopped()

    def _fail(
        self, robot: ConfiguredBoard, fault: Fault, cause: StopCause, velocities: Sequence[int]
    ) -> None:
        """Brakes into FAULT; `velocities` are those of a path that has just ended."""
        if self.fault is Fault.NONE:
            self.fault = fault
        if self.state is BoardState.BRAKING:
            return
        self.queue.clear()
        self._latch(cause)
        self.change(BoardEvent.BRAKE)
        if robot.drive.moving:
            robot.drive.brake()
        else:
            robot.drive.brake_from(velocities)

    def _came_to_rest(self) -> None:
        disable = Enable(on=False)
        if self.fault is not Fault.NONE:
            self.change(BoardEvent.RESTED_FAULT)
            if self.disable_pending:
                self.reports.refuse(disable, Refusal.STATE)
        elif self.disable_pending:
            self.homed = False
            self.change(BoardEvent.RESTED_DISABLE)
            self.reports.done(disable)
        else:
            self.change(BoardEvent.RESTED)
        self.disable_pending = False
        self._homing = None
        self.say_stopped()

    def _latch(self, cause: StopCause) -> None:
        """The first cause wins until the next Arm or Home."""
        if self.cause in _PASSED:
            self.cause = cause

    # Reports.

    def say_stopped(self) -> None:
        self.reports.say(
            Stopped(epoch=self.epoch, cause=self.cause, now=self.now, counts=self.counts)
        )

    def report(self) -> None:
        if self.reports.telemetry_due:
            self.reports.telemetry(self._telemetry())

    def _telemetry(self) -> Telemetry:
        return Telemetry(
            now=self.now,
            state=self.state,
            fault=self.fault,
            epoch=self.epoch,
            last_index=(self.queue.next_index - 1) & 0xFFFF,
            t_queue_end=self.now if self.idle else self.queue.end,
            free=self.queue.free,
            inputs=self._inputs(),
            flags=self._flags(),
            counts=self.counts,
        )

    def _inputs(self) -> Inputs:
        bits = Inputs.ESTOP.value if self.estop_input else 0
        for joint, pressed in enumerate(self._switches):
            bits |= pressed * Inputs.SWITCH_0.value << joint
        return Inputs(bits)

    def _flags(self) -> TelemetryFlags:
        alive = self.lease.remaining(self.now) is not None
        return TelemetryFlags(
            TelemetryFlags.HOMED.value * self.homed
            | TelemetryFlags.MOVING.value * self.moving
            | TelemetryFlags.LEASE_ALIVE.value * alive
            | TelemetryFlags.CONFIGURED.value * (self.robot is not None)
        )
