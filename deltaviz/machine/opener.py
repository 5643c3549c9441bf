"""Opens links beside the control loop: a serial server that does not answer takes seconds."""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import Future
from typing import Protocol

from deltaviz.link.transport import LinkError, Transport

Open = Callable[[], Transport]


class Opener(Protocol):
    def __call__(self, open_: Open) -> Future[Transport]:
        """The future has the open transport, or the LinkError."""
        ...


class ThreadOpener:
    """One after the other, so that a port that was given up is free for the next try."""

    def __init__(self) -> None:
        self._turn = threading.Lock()

    def __call__(self, open_: Open) -> Future[Transport]:
        future: Future[Transport] = Future()
        # A daemon: what hangs in there does not keep the process from ending.
        threading.Thread(target=self._run, args=(open_, future), name="opener", daemon=True).start()
        return future

    def _run(self, open_: Open, future: Future[Transport]) -> None:
        with self._turn:
            if future.set_running_or_notify_cancel():
                open_now(open_, future)


def open_now(open_: Open, future: Future[Transport]) -> None:
    try:
        future.set_result(open_())
    except LinkError as error:
        future.set_exception(error)
    except Exception as error:  # a driver's, or pyserial's own: told, and the machine goes on
        detail = f"The link cannot be opened ({type(error).__name__}: {error})."
        future.set_exception(LinkError(detail))


def abandon(future: Future[Transport]) -> None:
    """Nobody waits for it any more: what is opened is closed again."""

    def close(done: Future[Transport]) -> None:
        if not done.cancelled() and done.exception() is None:
            done.result().close()

    if not future.cancel():
        future.add_done_callback(close)
