"""The cable between a host, which is any program, and the emulated board: it can be pulled, all
that passes on it is noted, and the board's time is granted here.

As long as it `flows`, the board's time waits for a host that is behind, so that a busy computer
makes nothing late. Where a host is to be late, its test says by how much of the board's time.
"""

from __future__ import annotations

import contextlib
import select
import socket
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum, auto
from typing import TypeVar

from deltaviz.link.emulator.pace import MOST_MS, Pace
from deltaviz.link.messages import BoardState
from deltaviz.link.rules import since
from tests.emulator.overheard import Ear, Greeting, Keep, Said, Segment, Telemetry
from tests.emulator.priority import coming_first

PATIENCE = 60.0  # s of ours in which the board's time stands still
WITHIN = 20.0  # s of the board's time
GRANT = 5  # ms
BEHIND = 20  # ms of the board's time that a host may be behind while the robot moves
_LOOK = 0.002  # s
_LOST = 0.05  # s without a word of the board, after which a grant is given up for lost
S = TypeVar("S")


class Flow(Enum):
    WAITS = auto()  # for a host that is behind, or is not there yet
    RUNS = auto()  # as fast as it gets, whatever becomes of the host
    HELD = auto()


@dataclass(frozen=True, slots=True)
class Passed:
    """`at`: the newest tick that the board had told when this passed."""

    said: Said
    at: int


class Wire:
    """Carries bytes from its making on, in a thread of its own."""

    def __init__(self, board: socket.socket, pace: Pace) -> None:
        self.passed: list[Passed] = []
        self._newest: Telemetry | None = None  # that the board has told
        self.ticks_per_ms = 0
        self._board: socket.socket | None = board
        self._pace = pace
        self._host: socket.socket | None = None
        self._plugged = True
        self._listener = socket.create_server(("127.0.0.1", 0), backlog=8)
        self.url = f"socket://127.0.0.1:{self._listener.getsockname()[1]}"
        self._deaf = False
        self._from_host, self._from_board = Ear(), Ear()
        self._flow = Flow.WAITS
        self._owed = 0.0  # ms that were granted and not yet seen to pass
        self._granted = self._heard = time.monotonic()
        self._seen = 0
        self._news = threading.Condition(threading.RLock())
        self._ending = False
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    # What a test does with it.

    @property
    def telemetry(self) -> Telemetry:
        """The newest."""
        assert self._newest is not None, "the board has told nothing yet"
        return self._newest

    @property
    def now(self) -> int:
        """The newest tick that the board has told."""
        return self.telemetry.now

    @property
    def seen(self) -> int:
        """The newest telemetry that the host has said it had."""
        return self._seen

    def all(self, kind: type[S], *, after: int = 0) -> list[S]:
        """What was said of one kind, behind the first `after` messages."""
        return [each.said for each in self.passed[after:] if isinstance(each.said, kind)]

    def newest(self, kind: type[S]) -> S:
        return next(each.said for each in reversed(self.passed) if isinstance(each.said, kind))

    def until(self, condition: Callable[[], object], what: str, *, within: float = WITHIN) -> None:
        """For at most `within` seconds of the board's time, and as long as that passes."""
        with self._news:
            began, moved, last = self._newest, time.monotonic(), self._newest
            while not condition():
                if self._newest is not last:
                    last, moved = self._newest, time.monotonic()
                    began = began or last
                told = f"{what} did not come: {last}"
                assert time.monotonic() - moved < PATIENCE, told
                if last is not None and began is not None:
                    assert since(last.now, began.now) <= within * 1000 * self.ticks_per_ms, told
                self._news.wait(0.05)

    def until_state(self, state: BoardState) -> None:
        self.until(lambda: self.telemetry.state is state, state.name)

    def let_pass(self, seconds: float) -> None:
        """Board time."""
        start = self.now
        ticks = seconds * 1000 * self.ticks_per_ms
        self.until(lambda: since(self.now, start) >= ticks, "time", within=seconds + 1)

    def flow(self, how: Flow) -> None:
        with self._news:
            self._flow = how

    def hold(self) -> None:
        """The board's time comes to stand."""
        self.flow(Flow.HELD)
        with self._news:
            while self._owed > 0 and time.monotonic() - self._heard < _LOST:
                self._news.wait(_LOOK)
            self._owed = 0.0

    def give(self, ms: int) -> None:
        """So much more time while it is held, or up to 5 ms more, as it is told every 5 ms; returns
        when it has passed.
        """
        end = self.now + ms * self.ticks_per_ms
        with self._news:
            while since(end, self.now) > 0:
                told = self._newest
                self._pace.grant(min(GRANT, -(-since(end, self.now) // self.ticks_per_ms)))
                granted = time.monotonic()
                while self._newest is told and time.monotonic() - granted < _LOST:
                    self._news.wait(_LOOK)

    def pull(self) -> None:
        """The plug, at the host's end: its connection is closed, and nobody is let in."""
        with self._news:
            self._plugged = False
            self._drop_host()

    def plug(self) -> None:
        with self._news:
            self._plugged = True

    def deafen(self) -> None:
        """Broken inside: nothing passes any more, and neither end is told."""
        with self._news:
            self._deaf = True

    def mend(self) -> None:
        with self._news:
            self._deaf = False

    def change_board(self, board: socket.socket, pace: Pace) -> None:
        """Another board at this end, or the same one switched off and on; the host's end stays."""
        with self._news:
            self._board, self._pace = board, pace
            self._from_board, self._newest = Ear(), None
            self._owed = 0.0

    def close(self) -> None:
        self._ending = True
        self._thread.join()
        self._drop_host()
        self._listener.close()

    # The thread.

    def _run(self) -> None:
        with coming_first():
            while not self._ending:
                self._turn()

    def _turn(self) -> None:
        ends = [end for end in (self._listener, self._host, self._board) if end is not None]
        try:
            ready, _, _ = select.select(ends, [], [], _LOOK)
        except (OSError, ValueError):  # one was closed meanwhile
            return
        with self._news:
            for end in ready:
                if end is self._listener:
                    self._let_in()
                elif end is self._host:
                    self._carry_to_board(_read(end))
                elif end is self._board:
                    self._carry_to_host(_read(end))
            self._grant()
            self._news.notify_all()

    def _let_in(self) -> None:
        host, _ = self._listener.accept()
        if not self._plugged or self._host is not None:
            host.close()
            return
        host.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._host, self._from_host = host, Ear()

    def _drop_host(self) -> None:
        if self._host is not None:
            self._host.close()
            self._host = None

    def _carry_to_board(self, data: bytes) -> None:
        if not data:
            self._drop_host()
        elif not self._deaf and self._board is not None:
            with contextlib.suppress(OSError):
                self._board.sendall(data)
            for said in self._from_host.feed(data):
                self._note(said)
                if isinstance(said, Keep | Segment):
                    self._seen = said.seen

    def _carry_to_host(self, data: bytes) -> None:
        if not data:
            self._board = None
            return
        if self._host is not None and not self._deaf:
            with contextlib.suppress(OSError):
                self._host.sendall(data)
        for said in self._from_board.feed(data):
            if isinstance(said, Greeting):
                self.ticks_per_ms = said.tick_hz // 1000
            if isinstance(said, Telemetry):
                self._told(said)
            self._note(said)

    def _told(self, telemetry: Telemetry) -> None:
        if self._newest is not None:
            passed = since(telemetry.now, self._newest.now) / self.ticks_per_ms
            self._owed = max(0.0, self._owed - passed)
        self._newest, self._heard = telemetry, time.monotonic()

    def _note(self, said: Said) -> None:
        self.passed.append(Passed(said, 0 if self._newest is None else self._newest.now))

    def _grant(self) -> None:
        now = time.monotonic()
        if self._flow is Flow.HELD or now - self._granted < GRANT / 1000:
            return
        if self._owed > GRANT and now - self._heard < _LOST:
            return
        if self._flow is Flow.WAITS and (self._host is None or self._is_behind()):
            return
        self._pace.grant(GRANT)
        self._granted = now
        self._owed = min(self._owed + GRANT, MOST_MS)

    def _is_behind(self) -> bool:
        told = self._newest
        return (
            told is not None
            and told.moving
            and since(told.now, self._seen) > BEHIND * self.ticks_per_ms
        )


def _read(end: socket.socket) -> bytes:
    try:
        return end.recv(1 << 16)
    except OSError:
        return b""
