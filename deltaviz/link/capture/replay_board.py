"""A capture's bytes to a board, given to the simulated one: does it answer the same?"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence

from deltaviz.link import messages as m
from deltaviz.link.board import SimulatedBoard
from deltaviz.link.board.port import BoardPort
from deltaviz.link.capture.board_clock import BoardClock
from deltaviz.link.capture.records import Kind, Record
from deltaviz.link.capture.spoken import Event, ReplayError, Spoken, of_kind, spoken
from deltaviz.link.rules import since
from deltaviz.link.traffic import Direction, Said, Sender


def replay_board(records: Sequence[Record]) -> Iterator[Event]:
    """One connection, from before the board was configured. Its clock follows the telemetry of
    the capture, which itself is not compared: a capture of a real board, whose bytes were under
    way, may come out a count or two off after a stop in mid-motion. Raises ReplayError.
    """
    said = list(spoken(records))
    replies, telemetry = of_kind(m.HelloReply, said), of_kind(m.Telemetry, said)
    if not replies or not telemetry:
        raise ReplayError("no board answered in this part of the capture.")
    if replies[0].message.configuration:
        raise ReplayError("the board was configured before it, so where its arms were is unknown.")
    clock = BoardClock(said, tick_hz=replies[0].message.tick_hz)
    port = BoardPort(_board(replies[0].message, telemetry, now=clock.power_up(records[0].at)))
    then = deque(item for item in said if _is_answer(item))
    direction = Direction(Sender.BOARD)
    sent = Direction(Sender.HOST)
    for record in records:
        tick = clock.tick(record.at)
        if record.kind is Kind.SENT:
            for item in sent.feed(record.data, record.at):
                if isinstance(item, Said):
                    tick = clock.heard(item.message, record.at)
        port.board.advance(max(0, since(tick, port.board.now)))
        if record.kind is Kind.SENT:
            port.feed(record.data)
        for frame in port.take():
            for item in direction.feed(frame, record.at):
                if isinstance(item, Said) and _is_answer(item):
                    yield _compared(then.popleft() if then else None, item)
    for item in then:
        yield Event(item.at, f"nothing, where there was {item.message}", differs=True)


def _board(
    reply: m.HelloReply, telemetry: list[Spoken[m.Telemetry]], *, now: int
) -> SimulatedBoard:
    flags = [item.message.flags for item in telemetry]
    configured = [flag for flag in flags if m.TelemetryFlags.CONFIGURED in flag]
    return SimulatedBoard(
        tick_hz=reply.tick_hz,
        start_homed=bool(configured) and m.TelemetryFlags.HOMED in configured[0],
        boot=reply.boot,
        now=now,
        last_epoch=reply.last_epoch,
    )


def _is_answer(item: Said) -> bool:
    return item.sender is Sender.BOARD and not isinstance(item.message, m.Telemetry)


def _compared(then: Said | None, now: Said) -> Event:
    text = f"{type(now.message).__name__} {_essence(now.message)}"
    if then is None:
        return Event(now.at, f"{text}, where there was nothing", differs=True)
    if _essence(then.message) != _essence(now.message):
        return Event(now.at, f"{text}, where there was {then.message}", differs=True)
    return Event(now.at, text)


def _essence(message: object) -> object:
    """What must be the same: a board's names, and the very tick, are its own."""
    match message:
        case m.HelloReply():
            return message.version, message.boot, message.last_epoch, message.homed
        case m.Stopped():
            return message.epoch, message.cause.name, message.counts
        case _:
            return message
