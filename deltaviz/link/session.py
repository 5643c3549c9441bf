"""The host's side of the link, without IO: messages in, messages out, time passed in.

A session lasts from one opening of a link to its closing. It greets the board, gives it the
robot's configuration, names epochs, arms, keeps the board's lease, and repeats a stop until the
board rests. It never arms by itself: `begin` is called when a person begins a motion.
"""

from __future__ import annotations

from collections.abc import Sequence
from enum import Enum

from deltaviz.link import messages as m
from deltaviz.link.flight import Flight
from deltaviz.link.rules import LEASE_MS, since
from deltaviz.motion.knot import CartesianKnot, Knot

STOP_REPEAT = 0.010  # s
KEEP_PERIOD = 0.025  # s, well within the board's lease
HELLO_REPEAT = 0.5  # s; a board that is still starting misses the first
ANSWER_WITHIN = 1.0  # s, for what the board answers at once
NEVER_ARMED = 0.1  # s of board time after a stop: an Arm before it has come by then or was lost
STALE = LEASE_MS / 1000  # s: telemetry older than this can begin and continue no motion


class Phase(Enum):
    GREETING = "greeting"
    CONFIGURING = "configuring"
    READY = "ready"
    FAILED = "failed"


class Session:
    """One conversation with one board."""

    def __init__(
        self,
        *,
        configuration: m.Configure,
        digest: int,
        microsteps_per_rad: Sequence[float],
        now: float,
    ) -> None:
        self.phase = Phase.GREETING
        self.problem: str | None = None
        self.telemetry: m.Telemetry | None = None
        self.stopped: m.Stopped | None = None  # the newest
        self.refused: m.Refused | None = None  # what halted the motion under way
        self.underruns = 0
        self._configuration = configuration
        self._digest = digest
        self._scale = tuple(microsteps_per_rad)
        self._opened = now
        self._heard = now
        self._board: m.HelloReply | None = None
        self._epoch = 0
        self._flight: Flight | None = None
        self._ticks = 0  # board time since the first telemetry, unwrapped
        self._pending: dict[str, float] = {}  # command: when to give up
        self._settled = True  # telemetry has come since the last answer
        self._hello_next = now + HELLO_REPEAT
        self._underrun_epoch: int | None = None
        self._stop_next: float | None = None
        self._stopping_epoch: int | None = None
        self._stop_tick = 0
        self._estop_next: float | None = None
        self._kept = float("-inf")
        self._out: list[m.HostMessage] = [m.Hello(m.PROTOCOL_VERSION)]

    # What is known.

    @property
    def ready(self) -> bool:
        return self.phase is Phase.READY and self.telemetry is not None

    @property
    def homed(self) -> bool:
        telemetry = self.telemetry
        return telemetry is not None and m.TelemetryFlags.HOMED in telemetry.flags

    @property
    def moving(self) -> bool:
        telemetry = self.telemetry
        return telemetry is not None and (
            m.TelemetryFlags.MOVING in telemetry.flags
            or telemetry.state in (m.BoardState.BRAKING, m.BoardState.HOMING)
        )

    @property
    def theta(self) -> tuple[float, ...] | None:
        """Joint angles from the board's counts; before homing, from an unknown zero."""
        if self.telemetry is None or len(self.telemetry.counts) != len(self._scale):
            return None
        return tuple(
            count / scale for count, scale in zip(self.telemetry.counts, self._scale, strict=True)
        )

    @property
    def flight(self) -> Flight | None:
        """The open epoch."""
        return self._flight

    @property
    def board_time(self) -> float | None:
        """Seconds of board time since the first telemetry, as last reported."""
        return None if self._board is None else self._ticks / self._board.tick_hz

    def age(self, now: float) -> float | None:
        """Seconds since the last telemetry."""
        return None if self.telemetry is None else max(0.0, now - self._heard)

    def silence(self, now: float) -> float:
        """Seconds since the board last said anything, or since the link was opened."""
        return now - self._heard

    @property
    def stopping(self) -> bool:
        """A stop was sent and the board has not answered that it rests."""
        return self._stop_next is not None

    @property
    def estopping(self) -> bool:
        """An e-stop was sent and the board has not reported it."""
        return self._estop_next is not None

    @property
    def settled(self) -> bool:
        """Whether the telemetry shows what came of every command that is answered at once."""
        owed = self._pending.keys() - {"home"}
        return self._settled and not owed and not self.estopping

    @property
    def homing(self) -> bool:
        """Homing was asked for and has neither ended nor failed."""
        return "home" in self._pending

    @property
    def standing(self) -> bool:
        """At rest, with everything run that was sent."""
        if self.telemetry is None or self.moving or self.stopping:
            return False
        return self._flight is None or self._flight.all_taken(self.telemetry)

    def ahead(self, now: float) -> float:
        """Seconds of motion that the board still has."""
        if self._flight is None or self.telemetry is None:
            return 0.0
        return self._flight.ahead(self.telemetry, elapsed=max(0.0, now - self._heard))

    def wants_knot(self, now: float, *, horizon: float) -> bool:
        """One more knot is due: less than `horizon` (s) is queued, a place is free, news is new."""
        if self._flight is None or self.telemetry is None or now - self._heard >= STALE:
            return False
        return self._flight.free(self.telemetry) > 0 and self.ahead(now) < horizon

    # What is to be done.

    def begin(self) -> None:
        """Open a new epoch at the board's counts. Only at rest, HALTED, when a person asks."""
        telemetry = self.telemetry
        if self._board is None or telemetry is None or telemetry.state is not m.BoardState.HALTED:
            raise RuntimeError("an epoch is opened only while the board is halted")
        self._epoch = (self._epoch + 1) & 0xFFFF
        self._flight = Flight(
            epoch=self._epoch,
            telemetry=telemetry,
            tick_hz=self._board.tick_hz,
            microsteps_per_rad=self._scale,
        )
        self.stopped = None
        self.refused = None
        self._out.append(self._flight.arm())

    def segment(self, knot: Knot | CartesianKnot, now: float) -> None:
        """Send one knot of the open epoch."""
        if self._flight is None or self.telemetry is None:
            raise RuntimeError("no epoch is open")
        self._out.append(self._flight.segment(knot, self.telemetry))
        self._kept = now

    def keep(self, now: float) -> None:
        """Extend the board's lease, if that is due. Called by the control tick only."""
        if self.telemetry is None or now - self._kept < KEEP_PERIOD:
            return
        self._kept = now
        self._out.append(m.Keep(self.telemetry.now))

    def stop(self, now: float) -> None:
        """Brake and halt; repeated until the board says that it rests."""
        if not self.stopping:
            self._stopping_epoch = None if self._flight is None else self._flight.epoch
            self._stop_tick = 0 if self.telemetry is None else self.telemetry.now
        self._flight = None
        self.stopped = None
        for overruled in ("home", "enable", "reset"):  # they may never be answered
            self._pending.pop(overruled, None)
        self._out.append(m.Stop())
        self._stop_next = now + STOP_REPEAT

    def estop(self, now: float) -> None:
        """Drivers off; repeated until the board says that they are."""
        self._flight = None
        self._pending.clear()
        self._stop_next = None
        self._out.append(m.EStop())
        self._estop_next = now + STOP_REPEAT

    def enable(self, now: float, *, on: bool) -> None:
        if not on:
            self._flight = None
        self._command(m.Enable(on), now + ANSWER_WITHIN)

    def home(self, now: float) -> None:
        """Begin homing, which needs a live lease as any motion does."""
        if self.telemetry is not None:
            self._out.append(m.Keep(self.telemetry.now))
            self._kept = now
        self._flight = None
        self.stopped = None
        self._command(m.Home(), float("inf"))

    def reset(self, now: float) -> None:
        self._command(m.Reset(), now + ANSWER_WITHIN)

    def tick(self, now: float) -> None:
        """Repeat what has to be repeated, and notice what was never answered."""
        if self.phase is Phase.GREETING and now >= self._hello_next:
            self._out.append(m.Hello(m.PROTOCOL_VERSION))
            self._hello_next = now + HELLO_REPEAT
        if self._stop_next is not None and now >= self._stop_next:
            self._out.append(m.Stop())
            self._stop_next = now + STOP_REPEAT
        if self._estop_next is not None and now >= self._estop_next:
            self._out.append(m.EStop())
            self._estop_next = now + STOP_REPEAT
        for command, due in list(self._pending.items()):
            if now >= due:
                del self._pending[command]
                self._fail(f"The board did not answer '{command}'. Connect again.")

    def take(self) -> list[m.HostMessage]:
        """The messages to send now, in order."""
        out, self._out = self._out, []
        return out

    # What the board says.

    def receive(self, message: m.BoardMessage, now: float) -> None:
        match message:
            case m.HelloReply():
                if self.phase is Phase.GREETING:
                    self._greeted(message, now)
            case m.Configured():
                self._configured(message.configuration)
            case m.Telemetry():
                self._reported(message, now)
            case m.Stopped():
                self._has_stopped(message)
            case m.Done():
                self._answered(message.command)
            case m.Refused():
                self._was_refused(message)

    def _greeted(self, reply: m.HelloReply, now: float) -> None:
        self._board = reply
        self._epoch = reply.last_epoch
        self._heard = now
        if reply.version != m.PROTOCOL_VERSION:
            self._fail(
                f"The board speaks version {reply.version} of the protocol, this program "
                f"version {m.PROTOCOL_VERSION}. Update the older of the two."
            )
        elif reply.joints not in (0, len(self._scale)):  # 0: not configured yet
            self._fail(
                f"The board drives {reply.joints} joints, the robot has {len(self._scale)}. "
                "Choose the robot that is connected."
            )
        else:
            self.phase = Phase.CONFIGURING
            self._command(self._configuration, now + ANSWER_WITHIN)

    def _answered(self, command: str) -> None:
        if self._pending.pop(command, None) is not None:
            self._settled = False

    def _configured(self, digest: int) -> None:
        self._answered("configure")
        if digest != self._digest:
            self._fail(
                "The board took another configuration than it was given. Connect again; if it "
                "happens again, its firmware does not fit this program."
            )
        elif self.phase is Phase.CONFIGURING:
            self.phase = Phase.READY

    def _reported(self, telemetry: m.Telemetry, now: float) -> None:
        if self.telemetry is not None:
            self._ticks += max(0, since(telemetry.now, self.telemetry.now))
        self.telemetry = telemetry
        self._heard = now
        self._settled = True
        if self._flight is not None:
            self._flight.acknowledge(telemetry)
        if self.phase is Phase.READY and m.TelemetryFlags.CONFIGURED not in telemetry.flags:
            self._fail("The board has restarted. See to its power supply, then connect again.")
        if self.stopping and self._was_never_armed(telemetry):
            self._stopping_epoch = None
        if telemetry.state in (m.BoardState.ESTOP, m.BoardState.FAULT):
            self._stop_next = None
            self._flight = None
            self._pending.pop("home", None)
        if telemetry.state is m.BoardState.ESTOP:
            self._estop_next = None

    def _was_never_armed(self, telemetry: m.Telemetry) -> bool:
        """The stop overruled an Arm that was lost on its way: no answer will bear its epoch."""
        waited = since(telemetry.now, self._stop_tick)
        return (
            self._board is not None
            and telemetry.epoch != self._stopping_epoch
            and waited >= NEVER_ARMED * self._board.tick_hz
        )

    def _has_stopped(self, stopped: m.Stopped) -> None:
        """Late answers to a stop before the present epoch say nothing about this one."""
        if self.stopping:
            if self._stopping_epoch not in (None, stopped.epoch):
                return
            self._stop_next = None
        elif self._flight is not None and stopped.epoch != self._flight.epoch:
            return
        self._flight = None
        self.stopped = stopped
        if stopped.cause is m.StopCause.UNDERRUN and stopped.epoch != self._underrun_epoch:
            self._underrun_epoch = stopped.epoch  # the answer to our own stop tells it again
            self.underruns += 1

    def _was_refused(self, refused: m.Refused) -> None:
        self._answered(refused.command)
        if refused.command == "configure":
            self._fail(
                "The board is set up for another robot and its drivers are on. Switch it off and "
                "on again, then connect."
            )
        elif refused.of_segment:
            if self._flight is not None:
                self.refused = refused
        else:
            self.refused = refused
            if refused.command == "arm":  # no epoch was opened, so none will be stopped
                self._flight = None
                self._stopping_epoch = None

    def _command(self, message: m.HostMessage, due: float) -> None:
        self._pending[type(message).__name__.lower()] = due
        self._out.append(message)

    def _fail(self, problem: str) -> None:
        self.phase = Phase.FAILED
        self.problem = problem
