"""What motion a session holds, and the stop that is repeated until the board has answered it."""

from __future__ import annotations

from deltaviz.link import messages as m
from deltaviz.link.flight import Flight
from deltaviz.link.rules import since
from deltaviz.link.session_states import MOTIONS, Motion, Turn
from deltaviz.link.timing import HOME_NOT_BEGUN, NEVER_ARMED, STOP_REPEAT

_REPEATED: dict[Motion, m.HostMessage] = {
    Motion.STOPPING: m.Stop(),
    Motion.ESTOPPING: m.EStop(),
}


class UnderWay:
    """`state` follows MOTIONS; `flight` is there while it is EPOCH."""

    def __init__(self) -> None:
        self.state = Motion.NONE
        self.flight: Flight | None = None
        self.stopped: m.Stopped | None = None  # the newest
        self.underruns = 0
        self.lossy = False  # much of the newest motion had to be sent again, when it was last known
        self._underrun_epoch: int | None = None
        self._repeat_at = float("inf")
        self._stopping_epoch: int | None = None
        self._stop_tick = 0
        self._seen_homing = False
        self._home_tick = 0

    # What the host is asked for.

    def begin(self, flight: Flight) -> None:
        self._ask(Turn.BEGIN)
        self.flight = flight
        self.lossy = False
        self.stopped = None

    def home(self, telemetry: m.Telemetry | None) -> None:
        self._ask(Turn.HOME)
        self._seen_homing = False
        self._home_tick = 0 if telemetry is None else telemetry.now
        self.stopped = None

    def disable(self) -> None:
        self._ask(Turn.DISABLE)

    def stop(self, now: float, telemetry: m.Telemetry | None) -> None:
        if self.state is not Motion.STOPPING:
            self._stopping_epoch = None if self.flight is None else self.flight.epoch
            self._stop_tick = 0 if telemetry is None else telemetry.now
        self._ask(Turn.STOP)
        self.stopped = None
        if self.state is Motion.STOPPING:
            self._repeat_at = now + STOP_REPEAT

    def estop(self, now: float) -> None:
        self._ask(Turn.ESTOP)
        self._repeat_at = now + STOP_REPEAT

    def due(self, now: float) -> list[m.HostMessage]:
        """The stop, when it is to be repeated."""
        message = _REPEATED.get(self.state)
        if message is None or now < self._repeat_at:
            return []
        self._repeat_at = now + STOP_REPEAT
        return [message]

    # What the board says.

    def reported(self, telemetry: m.Telemetry, *, tick_hz: int) -> None:
        if self.flight is not None:
            self.flight.acknowledge(telemetry)
            self.lossy = self.flight.unseen.lossy(telemetry)
        if self.state is Motion.STOPPING and self._was_never_armed(telemetry, tick_hz):
            self._stopping_epoch = None
        if telemetry.state is m.BoardState.ESTOP:
            self._happens(Turn.ESTOPPED)
        elif telemetry.state is m.BoardState.FAULT:
            self._happens(Turn.FAULTED)
        elif telemetry.state is m.BoardState.HOMING:
            self._seen_homing = True
        elif self._seen_homing and telemetry.state is not m.BoardState.BRAKING:
            self._happens(Turn.ENDED)

    def has_stopped(self, stopped: m.Stopped) -> None:
        """Late answers to a stop before the present epoch say nothing about this one."""
        if self.state is Motion.STOPPING:
            if self._stopping_epoch not in (None, stopped.epoch):
                return
        elif self.flight is not None and stopped.epoch != self.flight.epoch:
            return
        self._happens(Turn.STOPPED)
        self.stopped = stopped
        if stopped.cause is m.StopCause.UNDERRUN and stopped.epoch != self._underrun_epoch:
            self._underrun_epoch = stopped.epoch  # the answer to our own stop tells it again
            self.underruns += 1

    def is_homed(self) -> bool:
        """Homing is done; whether it was under way."""
        return self._happens(Turn.HOMED)

    def was_refused(self, command: str) -> None:
        if command == "arm":  # no epoch was opened, so none will be stopped
            self._stopping_epoch = None
        if command in ("arm", "home"):
            self._happens(Turn.REFUSED)

    def never_began(self, telemetry: m.Telemetry, tick_hz: int) -> bool:
        """What was asked for has been on its way to the board for so long that it must not begin
        any more: nobody would expect it."""
        if self.flight is not None:
            return self.flight.never_began(telemetry)
        waited = since(telemetry.now, self._home_tick)
        lost = self.state is Motion.HOMING and not self._seen_homing
        return lost and waited >= HOME_NOT_BEGUN * tick_hz

    def _was_never_armed(self, telemetry: m.Telemetry, tick_hz: int) -> bool:
        """The stop overruled an Arm that was lost on its way: no answer will bear its epoch."""
        waited = since(telemetry.now, self._stop_tick)
        return telemetry.epoch != self._stopping_epoch and waited >= NEVER_ARMED * tick_hz

    def _happens(self, turn: Turn) -> bool:
        """Whether `turn` means anything to the motion under way; if so, it has happened."""
        target = MOTIONS.get((self.state, turn))
        if target is None:
            return False
        self.state = target
        if target is not Motion.EPOCH:
            self.flight = None
        return True

    def _ask(self, turn: Turn) -> None:
        if not self._happens(turn):
            raise RuntimeError(f"{turn} is not possible while {self.state}")
