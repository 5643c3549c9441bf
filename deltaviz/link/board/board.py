"""The simulated board: messages in, messages out, time as an argument."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import isfinite
from typing import Any

from deltaviz.link.board.configured import ConfiguredBoard
from deltaviz.link.board.control import Control
from deltaviz.link.board.limits import Objection
from deltaviz.link.board.parameters import Parameters, parameters_from
from deltaviz.link.board.plant import Plant, power_up_pose
from deltaviz.link.board.queue import Knot
from deltaviz.link.board.states import TRANSITIONS, BoardEvent
from deltaviz.link.board.turn import HOMING_COUNTS, arm_refusal, segment_refusal, well_timed, within
from deltaviz.link.configuration import configuration_hash
from deltaviz.link.messages import (
    PROTOCOL_VERSION,
    Arm,
    BoardMessage,
    BoardState,
    CartesianSegment,
    Configure,
    Configured,
    Enable,
    EStop,
    Fault,
    Hello,
    HelloReply,
    Home,
    HostMessage,
    Keep,
    Refusal,
    Reset,
    Segment,
    Stop,
    StopCause,
    Tool,
)
from deltaviz.link.rules import QUEUE_PLACES, TICK_HZ

_WITHOUT_VERSION = (Hello, Stop, EStop)


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
        self._control = Control(tick_hz=tick_hz, now=now, last_epoch=last_epoch)
        self._reports = self._control.reports
        self._tick_hz = tick_hz
        self._start_homed = start_homed
        self._theta = theta
        self._boot = boot
        self._speaks = True  # the host's version
        self._handlers: dict[type, Callable[[Any], None]] = {
            Hello: self._hello,
            Configure: self._configure,
            Keep: self._keep,
            Stop: self._stop,
            EStop: self._estop,
            Reset: self._reset,
        }
        self._robot_handlers: dict[type, Callable[[Any, ConfiguredBoard], None]] = {
            Enable: self._enable,
            Home: self._home,
            Arm: self._arm,
            Segment: self._segment,
            CartesianSegment: self._segment,
            Tool: self._tool,
        }

    # What is there to see.

    @property
    def now(self) -> int:
        return self._control.now

    @property
    def state(self) -> BoardState:
        return self._control.state

    @property
    def fault(self) -> Fault:
        return self._control.fault

    @property
    def cause(self) -> StopCause:
        return self._control.cause

    @property
    def homed(self) -> bool:
        return self._control.homed

    @property
    def moving(self) -> bool:
        return self._control.moving

    @property
    def counts(self) -> tuple[int, ...]:
        return self._control.counts

    @property
    def tool(self) -> Tool:
        return self._control.tool

    @property
    def positions(self) -> list[int]:
        """In 2^-32 microsteps, between counts: what tests and vectors compare."""
        robot = self._control.robot
        return [] if robot is None else robot.drive.positions

    @property
    def plant(self) -> Plant:
        """The arms on the board's pins, once it is configured."""
        if self._control.robot is None:
            raise RuntimeError("the board was not configured, so it has no arms yet")
        return self._control.robot.drive.plant

    # Time and messages.

    def advance(self, ticks: int) -> None:
        """Lets `ticks` of board time pass."""
        self._control.advance(ticks)

    def receive(self, message: HostMessage) -> None:
        kind, robot = type(message), self._control.robot
        if not self._speaks and kind not in _WITHOUT_VERSION:
            self._reports.refuse(message, Refusal.VERSION)
        elif kind in self._handlers:
            self._handlers[kind](message)
        elif robot is None:
            self._reports.refuse(message, Refusal.CONFIGURATION)
        else:
            self._robot_handlers[kind](message, robot)
        self._control.report()

    def take(self) -> list[BoardMessage]:
        """What the board has said since the last call."""
        return self._reports.take()

    def press_estop(self, pressed: bool) -> None:
        """The e-stop input, as it reads from the next boundary on."""
        self._control.estop_pin = pressed

    def _hello(self, message: Hello) -> None:
        control = self._control
        self._speaks = message.version == PROTOCOL_VERSION
        control.halt(StopCause.HOST_STOP)
        control.lease.expire()
        self._reports.say(
            HelloReply(
                version=PROTOCOL_VERSION,
                board="simulated",
                build="python",
                joints=0 if control.robot is None else control.robot.parameters.joints,
                tick_hz=self._tick_hz,
                queue_places=QUEUE_PLACES,
                boot=self._boot,
                last_epoch=control.epoch,
                homed=control.homed,
                configuration=0 if control.robot is None else control.robot.hash,
                last_stop=control.cause,
            )
        )

    def _configure(self, message: Configure) -> None:
        robot = self._control.robot
        if robot is not None and configuration_hash(message) == robot.hash:
            self._reports.say(Configured(robot.hash))
            return
        parameters = parameters_from(message, tick_hz=self._tick_hz)
        if parameters is None:
            self._reports.refuse(message, Refusal.CONFIGURATION)
        elif self.state is not BoardState.DISABLED:
            self._reports.refuse(message, Refusal.STATE)
        else:
            self._take_configuration(parameters)

    def _take_configuration(self, parameters: Parameters) -> None:
        untouched = self._control.robot is None and self._control.cause is StopCause.BOOT
        homed = self._start_homed and untouched  # an e-stop before this has ended that
        configure = parameters.configure
        ready = [r / m for r, m in zip(configure.ready, configure.microsteps_per_rad, strict=True)]
        robot = ConfiguredBoard(
            parameters,
            theta=ready if homed else self._theta or power_up_pose(configure),
            hash_=configuration_hash(configure),
            tick_hz=self._tick_hz,
        )
        self._control.configure(robot, homed=homed)
        self._reports.say(Configured(robot.hash))

    def _enable(self, message: Enable, robot: ConfiguredBoard) -> None:
        control = self._control
        if message.on:
            if control.estop_input:
                self._reports.refuse(message, Refusal.INPUT)
            elif self._allowed(message, BoardEvent.ENABLE):
                control.change(BoardEvent.ENABLE)
                self._reports.done(message)
        elif control.moving:
            control.disable_pending = True
            control.halt(StopCause.DISABLED)
        elif self._allowed(message, BoardEvent.DISABLE):
            control.halt(StopCause.DISABLED)
            control.change(BoardEvent.DISABLE)
            control.homed = False
            self._reports.done(message)

    def _home(self, message: Home, robot: ConfiguredBoard) -> None:
        control = self._control
        if not self._allowed(message, BoardEvent.HOME):
            return
        if not control.idle:
            self._reports.refuse(message, Refusal.MOVING)
        elif not control.lease.alive:
            self._reports.refuse(message, Refusal.LEASE)
        elif not within(control.counts, HOMING_COUNTS):
            self._reports.refuse(message, Refusal.COUNTS)
        else:
            control.begin_homing(robot)

    def _arm(self, message: Arm, robot: ConfiguredBoard) -> None:
        control = self._control
        if not self._allowed(message, BoardEvent.ARM):
            return
        refusal = arm_refusal(
            message,
            now=control.now,
            last_epoch=control.epoch,
            counts=control.counts,
            idle=control.idle,
            ticks_per_ms=control.ticks_per_ms,
        )
        if refusal is not None:
            self._reports.refuse(message, refusal)
            return
        control.open_epoch(robot, message)
        self._reports.done(message)

    def _segment(self, message: Segment | CartesianSegment, robot: ConfiguredBoard) -> None:
        control = self._control
        refusal = segment_refusal(
            message, state=control.state, epoch=control.epoch, queue=control.queue
        )
        if refusal is not None:
            self._reports.refuse(message, refusal)
            return
        origin = robot.origin(message, control.queue.knot, homed=control.homed)
        objection = self._objection(message, origin, robot)
        if objection is not None or origin is None:
            objection = objection or Objection(Refusal.KIND)
            self._reports.refuse(message, objection.reason, joint=objection.joint)
            control.halt(StopCause.BAD_SEGMENT)
            return
        control.lease.extend(message.seen, control.now)
        if control.idle and not control.lease.alive:
            self._reports.refuse(message, Refusal.LEASE)
            control.halt(StopCause.LEASE)
            return
        control.enqueue(robot, message, origin)

    def _objection(
        self, message: Segment | CartesianSegment, origin: Knot | None, robot: ConfiguredBoard
    ) -> Objection | None:
        """`origin` is None where this kind of segment is not possible."""
        control = self._control
        if isinstance(message, Segment) and len(message.p) != robot.parameters.joints:
            return Objection(Refusal.CONFIGURATION)
        idle_at = control.now if control.idle else None
        if not well_timed(
            message, idle_at=idle_at, queue=control.queue, ticks_per_ms=control.ticks_per_ms
        ):
            return Objection(Refusal.TIME)
        if origin is None:
            return None
        return robot.objection(message, origin, control.leeway, homed=control.homed)

    def _keep(self, message: Keep) -> None:
        self._control.lease.extend(message.seen, self._control.now)

    def _stop(self, message: Stop) -> None:
        if self._control.moving or self.state is BoardState.ARMED:
            self._control.halt(StopCause.HOST_STOP)
        else:
            self._control.say_stopped()

    def _estop(self, message: EStop) -> None:
        self._control.drivers_off(Fault.NONE)

    def _reset(self, message: Reset) -> None:
        control = self._control
        if control.estop_input:
            self._reports.refuse(message, Refusal.INPUT)
        elif self._allowed(message, BoardEvent.RESET):
            control.fault = Fault.NONE
            control.homed = False
            control.change(BoardEvent.RESET)
            self._reports.done(message)

    def _tool(self, message: Tool, robot: ConfiguredBoard) -> None:
        if self.state in (BoardState.DISABLED, BoardState.ESTOP, BoardState.FAULT):
            self._reports.refuse(message, Refusal.STATE)
        elif not isfinite(message.servo_angle):
            self._reports.refuse(message, Refusal.CONFIGURATION)
        else:
            self._control.tool = message
            self._reports.done(message)

    def _allowed(self, message: HostMessage, event: BoardEvent) -> bool:
        allowed = (self.state, event) in TRANSITIONS
        if not allowed:
            busy = self.state in (BoardState.BRAKING, BoardState.HOMING)
            self._reports.refuse(message, Refusal.MOVING if busy else Refusal.STATE)
        return allowed
