"""What the board does with time, and what stops it. What it is told is `board`'s concern.

Time is cut into pieces of 1 ms, counted from power-up. Where one begins, control looks at the
inputs, judges the lease, notices rest, goes on with homing, and plans the piece after it.
"""

from __future__ import annotations

from deltaviz.link.board.configured import ConfiguredBoard
from deltaviz.link.board.homing import Homing
from deltaviz.link.board.lease import Lease
from deltaviz.link.board.limits import Leeway
from deltaviz.link.board.queue import Knot, SegmentQueue
from deltaviz.link.board.reports import Reports
from deltaviz.link.board.states import POWERED, TRANSITIONS, BoardEvent
from deltaviz.link.messages import (
    Arm,
    BoardState,
    CartesianSegment,
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
    Tool,
)
from deltaviz.link.rules import LEASE_MS, QUEUE_PLACES, since

MASK = 0xFFFF_FFFF
_PASSED = (StopCause.NONE, StopCause.BOOT, StopCause.HOMED)  # not the cause of a stop


class Control:
    """`planned` is the tick until which motion is planned, and nothing changes it any more."""

    def __init__(self, *, tick_hz: int, now: int, last_epoch: int) -> None:
        self.ticks_per_ms = tick_hz // 1000
        self.now = now
        self.planned = (now + 2 * self.ticks_per_ms) & MASK
        self.state = BoardState.DISABLED
        self.fault = Fault.NONE
        self.cause = StopCause.BOOT
        self.homed = False
        self.epoch = last_epoch
        self.queue = SegmentQueue(QUEUE_PLACES)
        self.leeway = Leeway((), 0.0)  # of the epoch
        self.lease = Lease(LEASE_MS * self.ticks_per_ms)
        self.reports = Reports()
        self.robot: ConfiguredBoard | None = None
        self.tool = Tool(on=False, servo_angle=0.0)
        self.estop_pin = False  # what the input reads at the next boundary
        self.estop_input = False  # what it read at the last one
        self.disable_pending = False
        self._left = self.ticks_per_ms  # until the next boundary
        self._homing: Homing | None = None
        self._switches: list[bool] = []  # empty until they were looked at

    @property
    def moving(self) -> bool:
        if self.state in (BoardState.BRAKING, BoardState.HOMING):
            return True
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
        if self.state not in POWERED and self.tool.on:
            self.tool = Tool(on=False, servo_angle=self.tool.servo_angle)

    # What commands begin.

    def configure(self, robot: ConfiguredBoard, *, homed: bool) -> None:
        """With `homed` the board has stood enabled at the ready pose before it could say so."""
        self.robot = robot
        self._switches = []
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

    def open_epoch(self, robot: ConfiguredBoard, arm: Arm) -> None:
        """Forgets fractions of a microstep, so that host and board start from the same point."""
        robot.drive.place([count << 32 for count in arm.counts])
        self.epoch = arm.epoch
        self.cause = StopCause.NONE
        p = tuple(count << 10 for count in arm.counts)
        self.queue.open(p, t_start=arm.t_start, planned=self.planned)
        self.leeway = robot.limits.leeway_at(self.queue.knot, homed=self.homed)
        self.change(BoardEvent.ARM)

    def enqueue(
        self, robot: ConfiguredBoard, segment: Segment | CartesianSegment, origin: Knot
    ) -> None:
        self.queue.push(segment, origin, planned=self.planned, idle=self.idle)
        self.leeway = robot.limits.come_to(self.queue.knot, self.leeway)

    # Time.

    def advance(self, ticks: int) -> None:
        while ticks >= self._left:
            quiet = min(self._quiet_pieces(), 1 + (ticks - self._left) // self.ticks_per_ms)
            ticks -= self._left
            if quiet:
                ticks -= (quiet - 1) * self.ticks_per_ms
                self._begin_quiet_pieces(quiet)
            else:
                self._pass(self._left)
                self._begin_piece()
        self._pass(ticks)

    def _pass(self, ticks: int) -> None:
        self.now = (self.now + ticks) & MASK
        self._left -= ticks
        if self.robot is not None:
            self.robot.drive.advance(ticks)

    def _begin_piece(self) -> None:
        self._left = self.ticks_per_ms
        if self.robot is not None:
            self.robot.drive.begin_piece()
        self._look()
        self._judge_lease()
        until = (self.planned + self.ticks_per_ms) & MASK
        if self.robot is not None and not self.idle:
            self._notice_rest(self.robot)
            if self._homing is not None:
                self._go_on_homing(self.robot, self._homing)
            self._plan(self.robot, until)
        self.planned = until
        self.reports.pieces -= 1
        self.report()

    def _quiet_pieces(self) -> int:
        """How many pieces may begin, the last with telemetry, with nothing else to be done."""
        robot = self.robot
        if not self.idle or self.estop_pin != self.estop_input:
            return 0
        if robot is not None and robot.drive.plant.switches is not self._switches:
            return 0
        pieces, lease = self.reports.pieces, self.lease.remaining(self.now)
        if lease is None:
            return pieces
        return min(pieces, max(0, (lease - self._left) // self.ticks_per_ms - 1))

    def _begin_quiet_pieces(self, pieces: int) -> None:
        ticks = (pieces - 1) * self.ticks_per_ms
        self.now = (self.now + self._left + ticks) & MASK
        self.planned = (self.planned + ticks + self.ticks_per_ms) & MASK
        self.reports.pieces -= pieces
        self._left = self.ticks_per_ms
        self.report()

    def _look(self) -> None:
        if self.estop_pin != self.estop_input:
            self.estop_input = self.estop_pin
            self.reports.changed = True
            if self.estop_input:
                self.drivers_off(Fault.ESTOP_INPUT)
        if self.robot is not None:
            self._look_at_switches(self.robot)

    def _look_at_switches(self, robot: ConfiguredBoard) -> None:
        switches, before = robot.drive.plant.switches, self._switches
        self._switches = switches
        if switches != before and (before or any(switches)):
            self.reports.changed = True
        if self._homing is not None or self.idle:
            return
        newly = any(is_ and not was for is_, was in zip(switches, before, strict=False))
        comes_from_one = self.state is BoardState.HOMING  # on its way to the ready pose
        goes_on = self.state is not BoardState.BRAKING and robot.drive.leads_into(switches)
        if (newly and not comes_from_one) or goes_on:
            self._fail(robot, Fault.LIMIT_SWITCH, StopCause.LIMIT_SWITCH)

    def _judge_lease(self) -> None:
        """Ends it at the last boundary from which the brake begins in time: a piece later."""
        left = self.lease.remaining(self.now)
        if left is not None and left < 2 * self.ticks_per_ms:
            self.lease.expire()
            if not self.idle:
                self.halt(StopCause.LEASE)

    def _notice_rest(self, robot: ConfiguredBoard) -> None:
        if robot.drive.moving:
            return
        if self.state is BoardState.BRAKING:
            self._came_to_rest()
        elif self.state is BoardState.HOMING and self._homing is None:
            self.homed = True
            self._latch(StopCause.HOMED)
            self.change(BoardEvent.HOMED)
            self.reports.done(Home())
            self.say_stopped()

    def _go_on_homing(self, robot: ConfiguredBoard, homing: Homing) -> None:
        drive = robot.drive
        if not homing.done:
            path = homing.next_path(drive.positions, self._switches, planned=drive.planned)
            if homing.fault is Fault.NONE:
                drive.follow(path, self.planned)
            else:
                self._fail(robot, homing.fault, StopCause.HOMING_FAILED)
        elif not drive.moving:
            drive.place(homing.referenced(drive.positions))
            drive.follow(homing.way_to_ready(drive.counts), self.planned)
            self._homing = None

    def _plan(self, robot: ConfiguredBoard, until: int) -> None:
        while self._changes_path(robot, until):
            pass
        if not robot.drive.plan(until):
            # A tip's path that was judged by looks leads out of reach between them.
            self.queue.clear()
            self._brake(robot, StopCause.BAD_SEGMENT)
            robot.drive.plan(until)

    def _changes_path(self, robot: ConfiguredBoard, until: int) -> bool:
        """Whether a path was left that ends before `until`, or taken up that begins before."""
        drive, head = robot.drive, self.queue.head
        if drive.path is None:
            if head is None or since(head.start, until) >= 0:
                return False
        elif since(drive.end, until) > 0:
            return False
        elif drive.path.rests:
            drive.rest()
            return True
        elif drive.end == until:
            return False
        elif head is None:
            self._latch(StopCause.UNDERRUN)
            self.change(BoardEvent.BRAKE)
            drive.brake(drive.end)
            return True
        drive.follow(robot.path(head), head.start)
        self.queue.pop()
        return True

    # Stops.

    def halt(self, cause: StopCause) -> None:
        """Ends what the host had begun: by the brake if it moves. Without effect at rest."""
        self.queue.clear()
        if self.robot is not None and self.moving:
            if self.state is not BoardState.BRAKING:
                self._brake(self.robot, cause)
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

    def _fail(self, robot: ConfiguredBoard, fault: Fault, cause: StopCause) -> None:
        """Brakes into FAULT."""
        if self.fault is Fault.NONE:
            self.fault = fault
        if self.state is not BoardState.BRAKING:
            self.queue.clear()
            self._brake(robot, cause)

    def _brake(self, robot: ConfiguredBoard, cause: StopCause) -> None:
        self._latch(cause)
        self._homing = None
        self.change(BoardEvent.BRAKE)
        robot.drive.brake(self.planned)

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
        return TelemetryFlags(
            TelemetryFlags.HOMED.value * self.homed
            | TelemetryFlags.MOVING.value * self.moving
            | TelemetryFlags.LEASE_ALIVE.value * self.lease.alive
            | TelemetryFlags.CONFIGURED.value * (self.robot is not None)
        )
