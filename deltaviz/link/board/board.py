"""The simulated board: messages in, messages out, time as an argument."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import isfinite
from typing import Any

from deltaviz.link.board.checks import Objection
from deltaviz.link.board.core import ConfiguredBoard, Core
from deltaviz.link.board.parameters import Parameters, parameters_from
from deltaviz.link.board.plant import Plant, power_up_pose
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
        self.tool: Tool | None = None
        self._core = Core(tick_hz=tick_hz, now=now, last_epoch=last_epoch)
        self._reports = self._core.reports
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
            Tool: self._tool,
        }

    # What is there to see.

    @property
    def now(self) -> int:
        return self._core.now

    @property
    def state(self) -> BoardState:
        return self._core.state

    @property
    def fault(self) -> Fault:
        return self._core.fault

    @property
    def cause(self) -> StopCause:
        return self._core.cause

    @property
    def homed(self) -> bool:
        return self._core.homed

    @property
    def moving(self) -> bool:
        return self._core.moving

    @property
    def counts(self) -> tuple[int, ...]:
        return self._core.counts

    @property
    def positions(self) -> list[int]:
        """In 2^-32 microsteps, between counts: what tests and vectors compare."""
        robot = self._core.robot
        return [] if robot is None else robot.drive.positions

    @property
    def plant(self) -> Plant:
        """The arms on the board's pins, once it is configured."""
        if self._core.robot is None:
            raise RuntimeError("the board was not configured, so it has no arms yet")
        return self._core.robot.drive.plant

    # Time and messages.

    def advance(self, ticks: int) -> None:
        """Lets `ticks` of board time pass."""
        self._core.advance(ticks)

    def receive(self, message: HostMessage) -> None:
        kind, robot = type(message), self._core.robot
        if not self._speaks and kind not in _WITHOUT_VERSION:
            self._reports.refuse(message, Refusal.VERSION)
        elif kind in self._handlers:
            self._handlers[kind](message)
        elif robot is None:
            self._reports.refuse(message, Refusal.CONFIGURATION)
        else:
            self._robot_handlers[kind](message, robot)
        self._core.report()

    def take(self) -> list[BoardMessage]:
        """What the board has said since the last call."""
        return self._reports.take()

    def press_estop(self, pressed: bool) -> None:
        """The e-stop input."""
        self._core.estop_input = pressed
        if pressed:
            self._core.drivers_off(Fault.ESTOP_INPUT)
        self._reports.changed = True
        self._core.report()

    def _hello(self, message: Hello) -> None:
        core = self._core
        self._speaks = message.version == PROTOCOL_VERSION
        core.halt(StopCause.HOST_STOP)
        core.lease.expire()
        self._reports.say(
            HelloReply(
                version=PROTOCOL_VERSION,
                board="simulated",
                build="python",
                joints=0 if core.robot is None else core.robot.parameters.joints,
                tick_hz=self._tick_hz,
                queue_places=QUEUE_PLACES,
                boot=self._boot,
                last_epoch=core.epoch,
                homed=core.homed,
                configuration=0 if core.robot is None else core.robot.hash,
                last_stop=core.cause,
            )
        )

    def _configure(self, message: Configure) -> None:
        robot = self._core.robot
        if robot is not None and configuration_hash(message) == robot.hash:
            self._reports.say(Configured(robot.hash))
            return
        parameters = parameters_from(message, tick_hz=self._tick_hz)
        if self.state is not BoardState.DISABLED:
            self._reports.refuse(message, Refusal.STATE)
        elif parameters is None:
            self._reports.refuse(message, Refusal.CONFIGURATION)
        else:
            self._take_configuration(parameters)

    def _take_configuration(self, parameters: Parameters) -> None:
        homed = self._start_homed and self._core.robot is None
        configure = parameters.configure
        ready = [r / m for r, m in zip(configure.ready, configure.microsteps_per_rad, strict=True)]
        robot = ConfiguredBoard(
            parameters,
            theta=ready if homed else self._theta or power_up_pose(parameters),
            hash_=configuration_hash(configure),
            tick_hz=self._tick_hz,
        )
        self._core.configure(robot, homed=homed)
        self._reports.say(Configured(robot.hash))

    def _enable(self, message: Enable, robot: ConfiguredBoard) -> None:
        core = self._core
        if message.on:
            if core.estop_input:
                self._reports.refuse(message, Refusal.INPUT)
            elif self._allowed(message, BoardEvent.ENABLE):
                core.change(BoardEvent.ENABLE)
                self._reports.done(message)
        elif core.moving:
            core.disable_pending = True
            core.halt(StopCause.DISABLED)
        elif self._allowed(message, BoardEvent.DISABLE):
            core.halt(StopCause.DISABLED)
            core.change(BoardEvent.DISABLE)
            core.homed = False
            self._reports.done(message)

    def _home(self, message: Home, robot: ConfiguredBoard) -> None:
        core = self._core
        if not self._allowed(message, BoardEvent.HOME):
            return
        if not core.idle:
            self._reports.refuse(message, Refusal.MOVING)
        elif core.lease.remaining(core.now) is None:
            self._reports.refuse(message, Refusal.LEASE)
        else:
            core.begin_homing(robot)

    def _arm(self, message: Arm, robot: ConfiguredBoard) -> None:
        core = self._core
        if not self._allowed(message, BoardEvent.ARM):
            return
        refusal = arm_refusal(
            message,
            now=core.now,
            last_epoch=core.epoch,
            counts=core.counts,
            idle=core.idle,
            ticks_per_ms=core.ticks_per_ms,
        )
        if refusal is not None:
            self._reports.refuse(message, refusal)
            return
        core.open_epoch(robot, message)
        self._reports.done(message)

    def _segment(self, message: Segment, robot: ConfiguredBoard) -> None:
        core = self._core
        refusal = segment_refusal(message, state=core.state, epoch=core.epoch, queue=core.queue)
        if refusal is not None:
            self._reports.refuse(message, refusal)
            return
        objection = self._objection(message, robot)
        if objection is not None:
            self._reports.refuse(message, objection.reason, joint=objection.joint)
            core.halt(StopCause.BAD_SEGMENT)
            return
        core.lease.extend(message.seen, core.now)
        if core.idle and core.lease.remaining(core.now) is None:
            self._reports.refuse(message, Refusal.LEASE)
            core.halt(StopCause.LEASE)
            return
        core.enqueue(message)

    def _objection(self, message: Segment, robot: ConfiguredBoard) -> Objection | None:
        core = self._core
        if not well_formed(message, joints=robot.parameters.joints):
            return Objection(Refusal.CONFIGURATION)
        idle_at = core.now if core.idle else None
        if not well_timed(
            message, idle_at=idle_at, queue=core.queue, ticks_per_ms=core.ticks_per_ms
        ):
            return Objection(Refusal.TIME)
        return robot.checks.objection(
            p0=core.queue.p,
            v0=core.queue.v,
            p1=message.p,
            v1=message.v,
            ticks=message.duration,
            homed=core.homed,
        )

    def _keep(self, message: Keep) -> None:
        self._core.lease.extend(message.seen, self._core.now)

    def _stop(self, message: Stop) -> None:
        if self._core.moving or self.state is BoardState.ARMED:
            self._core.halt(StopCause.HOST_STOP)
        else:
            self._core.say_stopped()

    def _estop(self, message: EStop) -> None:
        self._core.drivers_off(Fault.NONE)

    def _reset(self, message: Reset) -> None:
        core = self._core
        if core.estop_input:
            self._reports.refuse(message, Refusal.INPUT)
        elif self._allowed(message, BoardEvent.RESET):
            core.fault = Fault.NONE
            core.homed = False
            core.change(BoardEvent.RESET)
            self._reports.done(message)

    def _tool(self, message: Tool, robot: ConfiguredBoard) -> None:
        if self.state in (BoardState.DISABLED, BoardState.ESTOP, BoardState.FAULT):
            self._reports.refuse(message, Refusal.STATE)
        elif not isfinite(message.servo_angle):
            self._reports.refuse(message, Refusal.CONFIGURATION)
        else:
            self.tool = message
            self._reports.done(message)

    def _allowed(self, message: HostMessage, event: BoardEvent) -> bool:
        allowed = (self.state, event) in TRANSITIONS
        if not allowed:
            busy = self.state in (BoardState.BRAKING, BoardState.HOMING)
            self._reports.refuse(message, Refusal.MOVING if busy else Refusal.STATE)
        return allowed
