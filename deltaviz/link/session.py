"""The host's side of the link, without IO: messages in, messages out, time passed in.

A session lasts from one opening of a link to its closing. It greets the board, gives it the
robot's configuration, names epochs, arms, keeps the board's lease, and repeats a stop until the
board rests. It never arms by itself: `begin` is called when a person begins a motion. Which state
follows which stands in `session_states`, every time-out in `timing`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from deltaviz.link import messages as m
from deltaviz.link import problems
from deltaviz.link.flight import Flight
from deltaviz.link.impression import Impression
from deltaviz.link.listening import Listening
from deltaviz.link.objections import objection
from deltaviz.link.rules import since
from deltaviz.link.session_states import PHASES, Motion, News, Phase
from deltaviz.link.timing import (
    ANSWER_WITHIN,
    GREETING_WITHIN,
    HELLO_REPEAT,
    KEEP_PERIOD,
    SILENT_AFTER,
    STALE,
    STRANGE_AFTER,
)
from deltaviz.link.under_way import UnderWay
from deltaviz.motion.knot import CartesianKnot, Knot

# Refusals of a segment after which all is as before: it was early, late or there already.
PASSED_OVER = frozenset({m.Refusal.STATE, m.Refusal.EPOCH, m.Refusal.INDEX, m.Refusal.QUEUE_FULL})


class Session:
    """One conversation with one board.

    `robot_of` names the robot that has a configuration of this hash, if there is one.
    """

    def __init__(
        self,
        *,
        configuration: m.Configure,
        digest: int,
        microsteps_per_rad: Sequence[float],
        now: float,
        robot_of: Callable[[int], str | None] = lambda _: None,
    ) -> None:
        self.phase = Phase.GREETING
        self.problem: str | None = None  # why it failed, and what to do
        self.board: m.HelloReply | None = None
        self.impression = Impression()  # of what is connected; the caller keeps it new
        self.telemetry: m.Telemetry | None = None
        self.refused: m.Refused | None = None  # what halted the motion under way
        self._configuration = configuration
        self._digest = digest
        self._scale = tuple(microsteps_per_rad)
        self._robot_of = robot_of
        self._listening = Listening(now)
        self._heard = now
        self._epoch = 0
        self._under_way = UnderWay()
        self._ticks = 0  # board time since the first telemetry, unwrapped
        self._pending: dict[str, int] = {}  # what has to be answered: in `_ticks`, until when
        self._settled = True  # telemetry has come since the last answer
        self.awaits_reset = False  # e-stopped or at fault, it takes no configuration until then
        self._unexplained: m.Refused | None = None  # of Configure, until telemetry tells why
        self._hello_next = now + HELLO_REPEAT
        self._kept = float("-inf")
        self._out: list[m.HostMessage] = [m.Hello(m.PROTOCOL_VERSION)]

    # What is known.

    @property
    def ready(self) -> bool:
        return self.phase is Phase.READY

    @property
    def homed(self) -> bool:
        telemetry = self.telemetry
        if telemetry is None or self.awaits_reset:  # then the counts may be another robot's
            return False
        return m.TelemetryFlags.HOMED in telemetry.flags

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
        return self._under_way.flight

    @property
    def stopped(self) -> m.Stopped | None:
        """The newest one of this motion."""
        return self._under_way.stopped

    @property
    def never_began(self) -> bool:
        """A motion was lost on its way to the board, for so long that it must not begin."""
        board, telemetry = self.board, self.telemetry
        if board is None or telemetry is None:
            return False
        return self._under_way.never_began(telemetry, board.tick_hz)

    @property
    def lossy(self) -> bool:
        """Whether much of this motion, or of the last one when it ended, was lost on its way."""
        return self._under_way.lossy

    @property
    def underruns(self) -> int:
        return self._under_way.underruns

    @property
    def board_time(self) -> float | None:
        """Seconds of board time since the first telemetry, as last reported."""
        return None if self.board is None else self._ticks / self.board.tick_hz

    def age(self, now: float) -> float | None:
        """Seconds since the last telemetry."""
        return None if self.telemetry is None else max(0.0, now - self._heard)

    @property
    def stopping(self) -> bool:
        """A stop was sent and the board has not answered that it rests."""
        return self._under_way.state is Motion.STOPPING

    @property
    def estopping(self) -> bool:
        """An e-stop was sent and the board has not reported it."""
        return self._under_way.state is Motion.ESTOPPING

    @property
    def settled(self) -> bool:
        """Whether the telemetry shows what came of every command that is answered at once."""
        return self._settled and not self._pending and not self.estopping

    @property
    def homing(self) -> bool:
        """Homing was asked for and has neither ended nor failed."""
        return self._under_way.state is Motion.HOMING

    @property
    def standing(self) -> bool:
        """At rest, with everything run that was sent."""
        if self.telemetry is None or self.moving or self.stopping:
            return False
        return self.flight is None or self.flight.all_taken(self.telemetry)

    def ahead(self, now: float) -> float:
        """Seconds of motion that the board still has."""
        if self.flight is None or self.telemetry is None:
            return 0.0
        return self.flight.ahead(self.telemetry, elapsed=max(0.0, now - self._heard))

    def wants_knot(self, now: float, *, horizon: float) -> bool:
        """One more knot is due: less than `horizon` (s) is queued, a place is free, news is new.

        No more than that is ever under way, so that a stop has little to wait behind.
        """
        flight = self.flight
        if flight is None or self.telemetry is None or now - self._heard >= STALE:
            return False
        if flight.free(self.telemetry) <= 0 or flight.unacknowledged >= horizon:
            return False
        return self.ahead(now) < horizon

    # What is to be done.

    def begin(self) -> None:
        """Open a new epoch at the board's counts. Only at rest, HALTED, when a person asks."""
        telemetry = self.telemetry
        if self.board is None or telemetry is None or telemetry.state is not m.BoardState.HALTED:
            raise RuntimeError("an epoch is opened only while the board is halted")
        epoch = (self._epoch + 1) & 0xFFFF
        flight = Flight(
            epoch=epoch,
            telemetry=telemetry,
            tick_hz=self.board.tick_hz,
            microsteps_per_rad=self._scale,
        )
        self._under_way.begin(flight)
        self._epoch = epoch
        self.refused = None
        self._out.append(flight.arm())

    def segment(self, knot: Knot | CartesianKnot, now: float) -> None:
        """Send one knot of the open epoch."""
        if self.flight is None or self.telemetry is None:
            raise RuntimeError("no epoch is open")
        self._out.append(self.flight.segment(knot, self.telemetry))
        self._kept = now

    def keep(self, now: float) -> None:
        """Extend the board's lease, if that is due. Called by the control tick only."""
        if self.telemetry is None or now - self._kept < KEEP_PERIOD:
            return
        self._kept = now
        self._out.append(m.Keep(self.telemetry.now))

    def stop(self, now: float) -> None:
        """Brake and halt; repeated until the board says that it rests. In every state."""
        self._under_way.stop(now, self.telemetry)
        for overruled in ("enable", "reset"):  # they may never be answered
            self._pending.pop(overruled, None)
        self._out.append(m.Stop())

    def estop(self, now: float) -> None:
        """Drivers off; repeated until the board says that they are. In every state."""
        self._under_way.estop(now)
        self._pending.clear()
        self._out.append(m.EStop())

    def enable(self, now: float, *, on: bool) -> None:
        if not on:
            self._under_way.disable()
        self._command(m.Enable(on))

    def home(self, now: float) -> None:
        """Begin homing, which needs a live lease as any motion does. Not while stopping."""
        self._under_way.home(self.telemetry)
        if self.telemetry is not None:
            self._out.append(m.Keep(self.telemetry.now))
            self._kept = now
        self._out.append(m.Home())

    def reset(self, now: float) -> None:
        self._command(m.Reset())

    def tick(self, now: float) -> None:
        """Repeat what has to be repeated, and notice what was never answered."""
        if self.phase is Phase.GREETING and now >= self._hello_next:
            self._out.append(m.Hello(m.PROTOCOL_VERSION))
            self._hello_next = now + HELLO_REPEAT
        self._out += self._under_way.due(now)
        if self.flight is not None and self.telemetry is not None:
            self._out += self.flight.unseen.repeats(self.telemetry)
        self._listening.goes_on(now)
        self._notice_silence()

    def _notice_silence(self) -> None:
        """Nothing comes, or nothing that a board would say."""
        waited = self._listening.since_opening
        silent = self._listening.in_vain >= SILENT_AFTER
        if self.phase is Phase.GREETING and waited >= STRANGE_AFTER:
            strange = problems.strange(self.impression)
            if strange is not None:
                self._fail(News.STRANGE, strange)
            elif waited >= GREETING_WITHIN:
                self._fail(News.SILENT, problems.no_answer(self.impression))
        elif self.phase is Phase.CONFIGURING and silent:
            self._fail(News.UNANSWERED, problems.unanswered("configure"))
        elif self.phase is Phase.CONFIGURED and silent:
            self._fail(News.UNANSWERED, problems.not_reporting())
        elif self.phase is Phase.READY and silent:
            self._fail(News.SILENT, problems.silent())

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
                self._configured(message.configuration, now)
            case m.Telemetry():
                self._reported(message, now)
            case m.Stopped():
                self._under_way.has_stopped(message)
            case m.Done():
                self._done(message.command)
            case m.Refused():
                self._was_refused(message)

    def _greeted(self, reply: m.HelloReply, now: float) -> None:
        self._listening.heard(now)
        if reply.version != m.PROTOCOL_VERSION:
            self._fail(News.UNFIT, problems.other_version(reply.version))
            return
        if reply.tick_hz == 0:  # no time of its can be told
            self._fail(News.UNFIT, objection(self._configuration, tick_hz=0))
            return
        self.board = reply
        self._epoch = reply.last_epoch
        if reply.joints not in (0, len(self._scale)):  # 0: not configured yet
            self._fail(News.UNFIT, problems.other_joints(reply.joints, len(self._scale)))
        else:
            self._learn(News.FITS)
            self._command(self._configuration)

    def _answered(self, command: str) -> None:
        if self._pending.pop(command, None) is not None:
            self._settled = False

    def _configured(self, digest: int, now: float) -> None:
        self._answered("configure")
        if digest != self._digest:
            self._fail(News.DIFFERS, problems.other_configuration())
        elif self._learn(News.TAKEN):
            self._listening.heard(now)

    def _done(self, command: str) -> None:
        self._answered(command)
        if command == "home" and self._under_way.is_homed():
            self._settled = False

    def _reported(self, telemetry: m.Telemetry, now: float) -> None:
        if self.telemetry is not None:
            self._ticks += max(0, since(telemetry.now, self.telemetry.now))
        self.telemetry = telemetry
        self._heard = now
        self._listening.heard(now)
        self._settled = True
        if m.TelemetryFlags.CONFIGURED not in telemetry.flags:
            self._fail(News.RESTARTED, problems.restarted())
        else:
            self._learn(News.REPORTED)
        overdue = [command for command, due in self._pending.items() if self._ticks >= due]
        if overdue:
            self._fail(News.UNANSWERED, problems.unanswered(overdue[0]))
        if self._unexplained is not None:
            self._configuration_refused(self._unexplained)
        elif self.awaits_reset and not self._is_locked():
            self.awaits_reset = False
            self._command(self._configuration)
        if self.board is not None:
            self._under_way.reported(telemetry, tick_hz=self.board.tick_hz)

    def _was_refused(self, refused: m.Refused) -> None:
        self._answered(refused.command)
        if refused.command == "configure":
            self._configuration_refused(refused)
        elif refused.of_segment and refused.reason in PASSED_OVER:
            if self.flight is not None:
                self.flight.unseen.passed_over(refused.index)
        elif not refused.of_segment or self.flight is not None:
            self.refused = refused
            self._under_way.was_refused(refused.command)

    def _configuration_refused(self, refused: m.Refused) -> None:
        if self.board is None:
            return
        if refused.reason is m.Refusal.STATE and self.phase is Phase.CONFIGURING:
            self._unexplained = refused if self.telemetry is None else None
            self.awaits_reset = self._is_locked()
            if self._unexplained is not None or self.awaits_reset:
                return
        if refused.reason is m.Refusal.CONFIGURATION:
            problem = objection(self._configuration, tick_hz=self.board.tick_hz)
        else:
            problem = problems.set_up_for_another(self._robot_of(self.board.configuration))
        self._fail(News.REFUSED, problem)

    def _is_locked(self) -> bool:
        """By an e-stop or a fault."""
        telemetry = self.telemetry
        return telemetry is not None and telemetry.state in (m.BoardState.ESTOP, m.BoardState.FAULT)

    def _command(self, message: m.HostMessage) -> None:
        """To be answered in the board's own time, however slowly that passes."""
        tick_hz = 0 if self.board is None else self.board.tick_hz
        due = self._ticks + round(ANSWER_WITHIN * tick_hz)
        self._pending[type(message).__name__.lower()] = due
        self._out.append(message)

    def _learn(self, news: News) -> bool:
        """Whether `news` leads anywhere in this phase; if so, it has."""
        target = PHASES.get((self.phase, news))
        self.phase = target or self.phase
        return target is not None

    def _fail(self, news: News, problem: str) -> None:
        if self._learn(news):
            self._pending.clear()
            self.problem = problem
