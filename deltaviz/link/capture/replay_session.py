"""A capture given to the host's session: what it makes of it, and whether it says the same."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from deltaviz.link import messages as m
from deltaviz.link.capture.records import Kind, Record
from deltaviz.link.capture.spoken import Event, ReplayError, of_kind, spoken
from deltaviz.link.configuration import configuration_hash
from deltaviz.link.flight import (
    POSITION_UNIT,
    TIP_POSITION_UNIT,
    TIP_VELOCITY_UNIT,
    VELOCITY_UNIT,
)
from deltaviz.link.session import Session
from deltaviz.link.wire.codec import decode_host
from deltaviz.link.wire.commands import COMMANDS
from deltaviz.link.wire.delivery import Delivery
from deltaviz.link.wire.errors import Malformed
from deltaviz.link.wire.frames import decode_frame
from deltaviz.motion.knot import CartesianKnot, Knot


def replay_session(records: Sequence[Record]) -> Iterator[Event]:
    """One connection: the board's words as they came, and behind each message of the host's that
    the session does not send by itself, the wish that somebody had. Raises ReplayError.
    """
    yield from _Replay(records).run()


class _Replay:
    def __init__(self, records: Sequence[Record]) -> None:
        said = list(spoken(records))
        hellos, configures = of_kind(m.Hello, said), of_kind(m.Configure, said)
        if not hellos or not configures:
            raise ReplayError("no board was configured in this part of the capture.")
        configure = configures[0].message
        self._records = records
        self._scale = configure.microsteps_per_rad
        self._delivery = Delivery((hellos[0].sequence - 2) % 255 + 1)  # the next one is the hello
        self._session = Session(
            configuration=configure,
            digest=configuration_hash(configure),
            microsteps_per_rad=self._scale,
            now=records[0].at,
        )
        self._made: list[bytes] = []  # what it has sent, and is still to be found in the capture
        self._found: set[bytes] = set()  # commands: what is the same again is a repetition
        self._partial = b""
        self._shown = self._state

    def run(self) -> Iterator[Event]:
        for record in self._records:
            if record.kind is Kind.RECEIVED:
                self._hear(record.data, record.at)
            self._session.tick(record.at)
            self._send(record.at)
            if record.kind is Kind.SENT:
                for frame in self._frames(record.data):
                    yield from self._compare(frame, record.at)
            yield from self._changes(record.at)
        for frame in self._made:
            message = _message(frame)
            if not isinstance(message, m.Stop | m.EStop | m.Hello):  # the last may be repetitions
                yield Event(self._records[-1].at, f"sends {message}, too", differs=True)

    def _hear(self, data: bytes, at: float) -> None:
        heard, frames = self._delivery.receive(data, at)
        self._made += frames
        for message in heard:
            self._session.receive(message, at)

    def _send(self, at: float) -> None:
        for message in self._session.take():
            if not isinstance(message, m.Keep):
                self._made += self._delivery.send(message, at)

    def _frames(self, data: bytes) -> list[bytes]:
        *ended, self._partial = (self._partial + data).split(b"\0")
        return [encoded + b"\0" for encoded in ended if encoded]

    def _compare(self, frame: bytes, at: float) -> Iterator[Event]:
        message = _message(frame)
        if frame in self._made:
            self._find(frame, message)
        elif isinstance(message, m.Keep):
            telemetry = self._session.telemetry
            if telemetry is None or telemetry.now != message.seen:
                yield Event(at, f"has not seen what {message} says", differs=True)
        elif frame not in self._found and not self._is_repetition(message):
            yield from self._wish_for(message, frame, at)

    def _is_repetition(self, message: m.HostMessage | None) -> bool:
        """What is repeated at times of its own, as the control loop comes round."""
        session = self._session
        return (
            (isinstance(message, m.Stop) and session.stopping)
            or (isinstance(message, m.EStop) and session.estopping)
            or isinstance(message, m.Hello)
        )

    def _wish_for(self, message: m.HostMessage | None, frame: bytes, at: float) -> Iterator[Event]:
        try:
            self._wish(message, at)
        except RuntimeError as error:
            yield Event(at, f"cannot send {message}: {error}", differs=True)
            return
        self._send(at)
        if frame in self._made:
            self._find(frame, message)
        elif not isinstance(message, COMMANDS):  # one of these may wait for its turn
            yield Event(at, f"does not send {message}", differs=True)

    def _find(self, frame: bytes, message: m.HostMessage | None) -> None:
        self._made.remove(frame)
        if isinstance(message, COMMANDS):
            self._found.add(frame)

    def _wish(self, message: m.HostMessage | None, at: float) -> None:
        session = self._session
        match message:
            case m.Stop():
                session.stop(at)
            case m.EStop():
                session.estop(at)
            case m.Enable(on):
                session.enable(at, on=on)
            case m.Home():
                session.home(at)
            case m.Reset():
                session.reset(at)
            case m.Arm():
                session.begin()
            case m.Segment() | m.CartesianSegment():
                session.segment(self._knot(message), at)
            case _:
                pass

    def _knot(self, segment: m.Segment | m.CartesianSegment) -> Knot | CartesianKnot:
        if self._session.board is None:
            raise RuntimeError("no board has answered")
        duration = segment.duration / self._session.board.tick_hz
        if isinstance(segment, m.CartesianSegment):
            (x, y, z), (vx, vy, vz) = segment.p, segment.v
            p, v = TIP_POSITION_UNIT, TIP_VELOCITY_UNIT
            return CartesianKnot(duration, (x / p, y / p, z / p), (vx / v, vy / v, vz / v))
        return Knot(
            duration,
            tuple(p / POSITION_UNIT / s for p, s in zip(segment.p, self._scale, strict=True)),
            tuple(v / VELOCITY_UNIT / s for v, s in zip(segment.v, self._scale, strict=True)),
        )

    @property
    def _state(self) -> tuple[str, str, str, str]:
        session, telemetry, stopped = self._session, self._session.telemetry, self._session.stopped
        return (
            f"session {session.phase}" + (f": {session.problem}" if session.problem else ""),
            "" if telemetry is None else f"board {telemetry.state.name}",
            "homed" if session.homed else "not homed",
            "" if stopped is None else f"stopped by {stopped.cause.name} at {stopped.counts}",
        )

    def _changes(self, at: float) -> Iterator[Event]:
        before, self._shown = self._shown, self._state
        for was, is_ in zip(before, self._shown, strict=True):
            if is_ and is_ != was:
                yield Event(at, is_)


def _message(frame: bytes) -> m.HostMessage | None:
    """What a frame, with its zero byte, says; None: nothing that a host says."""
    read = decode_frame(frame[:-1])
    try:
        return None if read is None else decode_host(read.type, read.payload)
    except Malformed:
        return None
