"""The simulated board: messages in, messages out, time as an argument."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import isfinite
from typing import Any

from deltaviz.link.board.checks import Checks, Objection
from deltaviz.link.board.drive import Drive
from deltaviz.link.board.homing import Homing
from deltaviz.link.board.lease import Lease
from deltaviz.link.board.parameters import Parameters, parameters_from
from deltaviz.link.board.paths import Cubic
from deltaviz.link.board.plant import Plant, power_up_pose
from deltaviz.link.board.queue import SegmentQueue
from deltaviz.link.board.reports import Reports
from deltaviz.link.board.states import TRANSITIONS, BoardEvent
from deltaviz.link.board.turn import arm_refusal, segment_refusal, well_formed, well_timed
from deltaviz.link.configuration import configuration_hash
from deltaviz.link.messages import (
    PROTOCOL_VERSION,
    Arm,
    BoardMessage,
    BoardState,
    Configure,
    Configured,
    Enable,
    EStop,
    Fault,
    Hello,
    HelloReply,
    Home,
    HostMessage,
    Inputs,
    Keep,
    Refusal,
    Reset,
    Segment,
    Stop,
    StopCause,
    Stopped,
    Telemetry,
    TelemetryFlags,
    Tool,
)
from deltaviz.link.rules import LEASE_MS, QUEUE_PLACES, TELEMETRY_MS, TICK_HZ, since

_WITHOUT_CONFIGURATION = (Hello, Configure, Stop, EStop, Reset, Keep)
_WITHOUT_VERSION = (Hello, Stop, EStop)
_PASSED = (StopCause.NONE, StopCause.BOOT, StopCause.HOMED)  # not the cause of a stop


class SimulatedBoard:
    """A board with its arms, from power-up on. It knows its robot once it is configured.

    With `start_homed` the first configuration finds it enabled and homed at the ready pose;
    without, it is disabled and its arms hang at `theta` (rad), which it does not know.
    `now` is the tick at power-up; `boot` names the power-up.
    """

    def __init__(
        self,
        *,
        tick_hz: int = TICK_HZ,
        start_homed: bool = False,
        theta: Sequence[float] | None = None,
        boot: int = 1,
        now: int = 0,
        last_epoch: int = 0,
    ) -> None:
        self.now = now
        self.state = BoardState.DISABLED
        self.fault = Fault.NONE
        self.cause = StopCause.BOOT
        self.homed = False
        self.tool: Tool | None = None
        self._tick_hz = tick_hz
        self._ticks_per_ms = tick_hz // 1000
        self._start_homed = start_homed
        self._theta = theta
        self._boot = boot
        self._epoch = last_epoch
        self._speaks = True  # the host's version
        self._estop_input = False
        self._pressed: list[bool] = []
        self._parameters: Parameters | None = None
        self._checks: Checks | None = None
        self._drive: Drive | None = None
        self._hash = 0
        self._homing: Homing | None = None
        self._disable_pending = False
        self._knot: tuple[Sequence[int], Sequence[int]] = ((), ())  # where the path leads
        self._queue = SegmentQueue(QUEUE_PLACES)
        self._lease = Lease(LEASE_MS * self._ticks_per_ms)
        self._reports = Reports(TELEMETRY_MS * self._ticks_per_ms)
        self._handlers: dict[type, Callable[[Any], None]] = {
            Hello: self._hello,
            Configure: self._configure,
            Enable: self._enable,
            Home: self._home,
            Arm: self._arm,
            Segment: self._segment,
            Keep: self._keep,
            Stop: self._stop,
            EStop: self._estop,
            Reset: self._reset,
            Tool: self._tool,
        }

    # What is there to see.

    @property
    def moving(self) -> bool:
        return self._drive is not None and self._drive.moving

    @property
    def counts(self) -> tuple[int, ...]:
        return () if self._drive is None else self._drive.counts

    @property
    def positions(self) -> list[int]:
        """In 2^-32 microsteps, between counts: what tests and vectors compare."""
        return [] if self._drive is None else self._drive.positions

    @property
    def plant(self) -> Plant:
        """The arms on the board's pins, once it is configured."""
        if self._drive is None:
            raise RuntimeError("the board was not configured, so it has no arms yet")
        return self._drive.plant

    # Messages.

    def receive(self, message: HostMessage) -> None:
        if not self._speaks and not isinstance(message, _WITHOUT_VERSION):
            self._reports.refuse(message, Refusal.VERSION)
        elif self._parameters is None and not isinstance(message, _WITHOUT_CONFIGURATION):
            self._reports.refuse(message, Refusal.CONFIGURATION)
        else:
            self._handlers[type(message)](message)
        self._report()

    def take(self) -> list[BoardMessage]:
        """What the board has said since the last call."""
        return self._reports.take()

    def press_estop(self, pressed: bool) -> None:
        """The e-stop input."""
        self._estop_input = pressed
        if pressed:
            self._drivers_off(Fault.ESTOP_INPUT)
        self._reports.changed = True
        self._report()

    def _hello(self, message: Hello) -> None:
        self._speaks = message.version == PROTOCOL_VERSION
        self._halt(StopCause.HOST_STOP)
        self._lease.expire()
        self._reports.say(
            HelloReply(
                version=PROTOCOL_VERSION,
                board="simulated",
                build="python",
                joints=0 if self._parameters is None else self._parameters.joints,
                tick_hz=self._tick_hz,
                queue_places=QUEUE_PLACES,
                boot=self._boot,
                last_epoch=self._epoch,
                homed=self.homed,
                configuration=self._hash,
                last_stop=self.cause,
            )
        )

    def _configure(self, message: Configure) -> None:
        if self._parameters is not None and message == self._parameters.configure:
            self._reports.say(Configured(self._hash))
            return
        parameters = parameters_from(message, tick_hz=self._tick_hz)
        if self.state is not BoardState.DISABLED:
            self._reports.refuse(message, Refusal.STATE)
        elif parameters is None:
            self._reports.refuse(message, Refusal.CONFIGURATION)
        else:
            self._take_configuration(parameters)
            self._reports.say(Configured(self._hash))

    def _take_configuration(self, parameters: Parameters) -> None:
        first = self._parameters is None
        homed = first and self._start_homed
        theta = parameters.configure.ready if homed else self._theta or power_up_pose(parameters)
        plant = Plant(parameters, theta=theta)
        self._parameters = parameters
        self._checks = Checks(parameters, tick_hz=self._tick_hz)
        self._drive = Drive(parameters, plant, ticks_per_ms=self._ticks_per_ms)
        self._hash = configuration_hash(parameters.configure)
        self._pressed = plant.switches
        self._reports.changed = True
        if homed:
            self._drive.place([count << 32 for count in parameters.ready])
            self.homed = True
            self._change(BoardEvent.ENABLE)

    def _enable(self, message: Enable) -> None:
        if message.on:
            if self._estop_input:
                self._reports.refuse(message, Refusal.INPUT)
            elif self._allowed(message, BoardEvent.ENABLE):
                self._change(BoardEvent.ENABLE)
                self._reports.done(message)
            return
        if self.moving:
            self._disable_pending = True
            self._halt(StopCause.DISABLED)
        elif self._allowed(message, BoardEvent.DISABLE):
            self._halt(StopCause.DISABLED)
            self._change(BoardEvent.DISABLE)
            self.homed = False
            self._reports.done(message)

    def _home(self, message: Home) -> None:
        if not self._allowed(message, BoardEvent.HOME):
            return
        assert self._parameters is not None
        if self.moving or len(self._queue):
            self._reports.refuse(message, Refusal.MOVING)
        elif self._lease.remaining(self.now) is None:
            self._reports.refuse(message, Refusal.LEASE)
        else:
            self.homed = False
            self.cause = StopCause.NONE
            self._change(BoardEvent.HOME)
            self._homing = Homing(self._parameters, ticks_per_ms=self._ticks_per_ms)
            self._go_on_homing()

    def _arm(self, message: Arm) -> None:
        refusal = arm_refusal(
            message,
            now=self.now,
            last_epoch=self._epoch,
            counts=self.counts,
            moving=self.moving or len(self._queue) > 0,
            ticks_per_ms=self._ticks_per_ms,
        )
        if not self._allowed(message, BoardEvent.ARM):
            return
        if refusal is not None:
            self._reports.refuse(message, refusal)
            return
        assert self._drive is not None
        self._drive.place([count << 32 for count in message.counts])
        self._epoch = message.epoch
        self.cause = StopCause.NONE
        self._queue.open(tuple(count << 10 for count in message.counts), message.t_start)
        self._knot = (self._queue.p, self._queue.v)
        self._change(BoardEvent.ARM)
        self._reports.done(message)

    def _segment(self, message: Segment) -> None:
        refusal = segment_refusal(message, state=self.state, epoch=self._epoch, queue=self._queue)
        if refusal is not None:
            self._reports.refuse(message, refusal)
            return
        objection = self._objection(message)
        if objection is not None:
            self._reports.refuse(message, objection.reason, joint=objection.joint)
            self._halt(StopCause.BAD_SEGMENT)
            return
        self._lease.extend(message.seen, self.now)
        if self._idle and self._lease.remaining(self.now) is None:
            self._reports.refuse(message, Refusal.LEASE)
            self._halt(StopCause.LEASE)
            return
        self._queue.push(message, idle_at=self.now if self._idle else None)
        self._begin_what_is_due()

    def _objection(self, message: Segment) -> Objection | None:
        assert self._parameters is not None
        assert self._checks is not None
        if not well_formed(message, joints=self._parameters.joints):
            return Objection(Refusal.CONFIGURATION)
        idle_at = self.now if self._idle else None
        if not well_timed(message, now=idle_at, queue=self._queue, ticks_per_ms=self._ticks_per_ms):
            return Objection(Refusal.TIME)
        return self._checks.objection(
            p0=self._queue.p,
            v0=self._queue.v,
            p1=message.p,
            v1=message.v,
            ticks=message.duration,
            homed=self.homed,
        )

    def _keep(self, message: Keep) -> None:
        self._lease.extend(message.seen, self.now)

    def _stop(self, message: Stop) -> None:
        if self.moving or self.state is BoardState.ARMED:
            self._halt(StopCause.HOST_STOP)
        else:
            self._say_stopped()

    def _estop(self, message: EStop) -> None:
        self._drivers_off(Fault.NONE)

    def _reset(self, message: Reset) -> None:
        if self._estop_input:
            self._reports.refuse(message, Refusal.INPUT)
        elif self._allowed(message, BoardEvent.RESET):
            self.fault = Fault.NONE
            self.homed = False
            self._change(BoardEvent.RESET)
            self._reports.done(message)

    def _tool(self, message: Tool) -> None:
        if self.state in (BoardState.DISABLED, BoardState.ESTOP, BoardState.FAULT):
            self._reports.refuse(message, Refusal.STATE)
        elif not isfinite(message.servo_angle):
            self._reports.refuse(message, Refusal.CONFIGURATION)
        else:
            self.tool = message
            self._reports.done(message)

    # Time.

    def advance(self, ticks: int) -> None:
        """Lets `ticks` of board time pass."""
        while ticks > 0:
            step = min(ticks, self._quiet_ticks())
            self.now = (self.now + step) & 0xFFFF_FFFF
            ticks -= step
            if self._drive is not None and self._drive.moving and self._drive.advance(step):
                self._piece_ended(self._drive)
            if self._lease.remaining(self.now) == 0:
                self._lease.expire()
                if not self._idle:
                    self._halt(StopCause.LEASE)
            self._begin_what_is_due()
            self._reports.pass_time(step)
            self._report()

    def _quiet_ticks(self) -> int:
        """How long nothing happens but even motion."""
        ticks = self._reports.ticks_to_telemetry
        lease = self._lease.remaining(self.now)
        if lease is not None:
            ticks = min(ticks, lease)
        if self._drive is not None and self._drive.moving:
            ticks = min(ticks, self._drive.remaining)
        elif (head := self._queue.head) is not None:
            ticks = min(ticks, since(head.start, self.now))
        return ticks

    def _piece_ended(self, drive: Drive) -> None:
        """At each millisecond of motion: looks at the switches, and goes on."""
        pressed = drive.plant.switches
        if pressed != self._pressed:
            newly = any(is_ and not was for is_, was in zip(pressed, self._pressed, strict=True))
            self._pressed = pressed
            self._reports.changed = True
            if newly and self.state is not BoardState.HOMING:
                self._fail(Fault.LIMIT_SWITCH, StopCause.LIMIT_SWITCH, self._knot[1])
        if drive.moving:
            return
        if self.state is BoardState.BRAKING:
            self._came_to_rest()
        elif self.state is BoardState.HOMING:
            self._go_on_homing()
        elif self._queue.head is None and any(self._knot[1]):
            self._latch(StopCause.UNDERRUN)
            self._change(BoardEvent.BRAKE)
            drive.brake_from(self._knot[1])

    def _begin_what_is_due(self) -> None:
        head = self._queue.head
        if head is None or self._drive is None or self._drive.moving:
            return
        if since(head.start, self.now) > 0:
            return
        segment = self._queue.pop().segment
        p0, v0 = self._knot
        self._knot = (segment.p, segment.v)
        self._drive.follow(
            Cubic(
                start=p0,
                end=segment.p,
                v_start=v0,
                v_end=segment.v,
                ticks=segment.duration,
                ticks_per_ms=self._ticks_per_ms,
            )
        )

    def _go_on_homing(self) -> None:
        assert self._drive is not None
        if self._homing is None:
            self.homed = True
            self._latch(StopCause.HOMED)
            self._change(BoardEvent.HOMED)
            self._reports.done(Home())
            self._say_stopped()
            return
        positions = self._drive.positions
        velocities = self._homing.velocities
        path = self._homing.next_path(positions, self._pressed)
        if self._homing.fault is not Fault.NONE:
            self._fail(self._homing.fault, StopCause.HOMING_FAILED, velocities)
        elif path is not None:
            self._drive.follow(path)
        else:
            self._drive.place(self._homing.referenced(positions))
            self._drive.follow(self._homing.way_to_ready(self._drive.counts))
            self._homing = None

    # Stops.

    @property
    def _idle(self) -> bool:
        return not self.moving and not len(self._queue)

    def _halt(self, cause: StopCause) -> None:
        """Ends what the host had begun: by the brake if it moves. Without effect at rest."""
        self._queue.clear()
        if self.moving and self.state is not BoardState.BRAKING:
            assert self._drive is not None
            self._latch(cause)
            self._change(BoardEvent.BRAKE)
            self._drive.brake()
        elif self.state is BoardState.ARMED:
            self._latch(cause)
            self._change(BoardEvent.HALT)
            self._say_stopped()

    def _fail(self, fault: Fault, cause: StopCause, velocities: Sequence[int]) -> None:
        """Brakes into FAULT; `velocities` are those of a path that has just ended."""
        assert self._drive is not None
        if self.fault is Fault.NONE:
            self.fault = fault
        if self.state is BoardState.BRAKING:
            return
        self._queue.clear()
        self._latch(cause)
        self._change(BoardEvent.BRAKE)
        if self._drive.moving:
            self._drive.brake()
        else:
            self._drive.brake_from(velocities)

    def _came_to_rest(self) -> None:
        disable = Enable(on=False)
        if self.fault is not Fault.NONE:
            self._change(BoardEvent.RESTED_FAULT)
            if self._disable_pending:
                self._reports.refuse(disable, Refusal.STATE)
        elif self._disable_pending:
            self.homed = False
            self._change(BoardEvent.RESTED_DISABLE)
            self._reports.done(disable)
        else:
            self._change(BoardEvent.RESTED)
        self._disable_pending = False
        self._homing = None
        self._say_stopped()

    def _drivers_off(self, fault: Fault) -> None:
        if self._drive is not None:
            self._drive.cut()
        self._queue.clear()
        self._homing = None
        self._disable_pending = False
        self.homed = False
        self.fault = fault
        self.cause = StopCause.ESTOP
        self._change(BoardEvent.ESTOP)
        self._say_stopped()

    def _latch(self, cause: StopCause) -> None:
        if self.cause in _PASSED:
            self.cause = cause

    def _allowed(self, message: HostMessage, event: BoardEvent) -> bool:
        allowed = (self.state, event) in TRANSITIONS
        if not allowed:
            moving = self.state in (BoardState.BRAKING, BoardState.HOMING)
            self._reports.refuse(message, Refusal.MOVING if moving else Refusal.STATE)
        return allowed

    def _change(self, event: BoardEvent) -> None:
        self.state = TRANSITIONS[self.state, event]
        self._reports.changed = True

    # Reports.

    def _say_stopped(self) -> None:
        self._reports.say(
            Stopped(epoch=self._epoch, cause=self.cause, now=self.now, counts=self.counts)
        )

    def _report(self) -> None:
        if self._reports.telemetry_due:
            self._reports.telemetry(self._telemetry())

    def _telemetry(self) -> Telemetry:
        return Telemetry(
            now=self.now,
            state=self.state,
            fault=self.fault,
            epoch=self._epoch,
            last_index=(self._queue.next_index - 1) & 0xFFFF,
            t_queue_end=self.now if self._idle else self._queue.end,
            free=self._queue.free,
            inputs=self._inputs,
            flags=self._flags,
            counts=self.counts,
        )

    @property
    def _inputs(self) -> Inputs:
        inputs = Inputs.ESTOP if self._estop_input else Inputs.NONE
        for joint, pressed in enumerate(self._pressed):
            if pressed:
                inputs |= Inputs(Inputs.SWITCH_0 << joint)
        return inputs

    @property
    def _flags(self) -> TelemetryFlags:
        flags = TelemetryFlags.NONE
        if self.homed:
            flags |= TelemetryFlags.HOMED
        if self.moving:
            flags |= TelemetryFlags.MOVING
        if self._lease.remaining(self.now) is not None:
            flags |= TelemetryFlags.LEASE_ALIVE
        if self._parameters is not None:
            flags |= TelemetryFlags.CONFIGURED
        return flags
