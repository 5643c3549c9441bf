"""Is there a board at this port? Asked gently, and in bounded time.

First it is listened to: a board that nobody has greeted is silent, so whatever else speaks is left
alone. Then one Hello is sent, of bytes that mean nothing to those who might stand there instead.
"""

from __future__ import annotations

import random
import select
import threading
import time
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from functools import cache
from queue import Empty, SimpleQueue

from deltaviz.link.impression import Impression, Kind, Listener
from deltaviz.link.messages import PROTOCOL_VERSION, BoardMessage, Hello, HelloReply
from deltaviz.link.serial_link import BAUD, SerialAddress, open_stream
from deltaviz.link.transport import LinkError
from deltaviz.link.wire.codec import encode
from deltaviz.link.wire.errors import Malformed
from deltaviz.link.wire.frames import FrameReader, write_frame
from deltaviz.link.wire.stream import ByteStream
from deltaviz.link.wire.versions import decode_from_any_board

LISTEN = 0.15  # s: a board that is still in a session sends its telemetry every 5 ms
ANSWER = 0.6  # s
OPENING = 3.0  # s for all ports together, beyond that
# To a terminal, a machine tool or a radio these do something without a line's end: break, end of
# line, flow control, escape, and the single-byte commands of machine controllers.
_DOES_SOMETHING = frozenset(b"\x03\x0a\x0d\x11\x13\x18\x1b!?~") | frozenset(range(0x84, 0xA2))


@dataclass(frozen=True, slots=True)
class Finding:
    """One of the first two is None; both are when nothing was heard or only what is no board."""

    board: HelloReply | None = None
    problem: str | None = None  # why it could not be asked
    impression: Impression = field(default_factory=Impression)


def probe(address: SerialAddress) -> Finding:
    """Takes LISTEN + ANSWER seconds, and what the system takes to open the port."""
    try:
        stream, release = open_stream(address)
    except LinkError as error:
        return Finding(problem=str(error))
    try:
        return _ask(stream)
    finally:
        stream.close()
        release()


def probe_all(devices: Iterable[str], *, baud: int = BAUD) -> dict[str, Finding]:
    """All at once. A port that does not let itself be opened is given up."""
    found: SimpleQueue[tuple[str, Finding]] = SimpleQueue()

    def look(device: str) -> None:
        found.put((device, probe(SerialAddress(device, baud))))

    waiting = list(devices)
    for device in waiting:  # as daemons: one that hangs in its driver keeps nobody
        threading.Thread(target=look, args=(device,), daemon=True).start()
    findings: dict[str, Finding] = {}
    deadline = time.monotonic() + LISTEN + ANSWER + OPENING
    while len(findings) < len(waiting):
        try:
            device, finding = found.get(timeout=max(0.0, deadline - time.monotonic()))
        except Empty:
            break
        findings[device] = finding
    hangs = Finding(problem="It hangs when it is opened; pull its cable and plug it in again.")
    return {device: findings.get(device, hangs) for device in waiting}


def gentle_hello() -> bytes:
    return random.choice(_gentle_hellos())


@cache
def _gentle_hellos() -> Sequence[bytes]:
    """With the sequence its checksum changes: of 255 some 100 are harmless all through."""
    type_, payload = encode(Hello(PROTOCOL_VERSION))
    frames = [write_frame(type_, sequence, payload) for sequence in range(1, 256)]
    return [frame for frame in frames if not _DOES_SOMETHING.intersection(frame)]


def _ask(stream: ByteStream) -> Finding:
    listener, reader = Listener(), FrameReader()
    _hear(stream, listener, reader, LISTEN)
    if listener.impression.kind not in (Kind.NOTHING, Kind.BOARD):
        return Finding(impression=listener.impression)
    stream.write(gentle_hello())
    reply = _hear(stream, listener, reader, ANSWER)
    return Finding(board=reply, impression=listener.impression)


def _hear(
    stream: ByteStream, listener: Listener, reader: FrameReader, seconds: float
) -> HelloReply | None:
    """The first HelloReply that comes in this time."""
    end = time.monotonic() + seconds
    while stream.ended is None and (left := end - time.monotonic()) > 0:
        select.select([stream.fileno()], [], [], left)
        data = stream.read()
        listener.hear(data)
        for message in _messages(reader, data):
            if isinstance(message, HelloReply):
                return message
    return None


def _messages(reader: FrameReader, data: bytes) -> list[BoardMessage]:
    messages: list[BoardMessage] = []
    for frame in reader.feed(data):
        try:
            messages.append(decode_from_any_board(frame))
        except Malformed:
            continue
    return messages
