"""A process that computes: orders come on stdin, pictures go to stdout.

The newest order of each key counts. One that comes while its predecessor is computed ends that at
once, unless a library is at work: one that is broken off while it loads stays broken. At the end of
stdin the process is gone. It is nice to others: a robot may be driven on the same processor.
"""

from __future__ import annotations

import _thread
import inspect
import os
import signal
import sys
import threading
import time
from types import FrameType
from typing import BinaryIO

from deltaviz.scene.workspace.orders import Key, Order, Reply, read, write
from deltaviz.scene.workspace.pictures import Failed, Picture

NICE = 10
PATIENCE = 0.005  # s, until it is tried again to break off a library's work


class _Superseded(BaseException):
    """Raised in the midst of a computation."""


class Process:
    def __init__(self, orders: BinaryIO, replies: BinaryIO) -> None:
        self._in, self._out = orders, replies
        self._wanted: dict[Key, Order] = {}
        self._some = threading.Condition()
        self._computing: Order | None = None  # set by the main thread alone

    def run(self) -> None:
        """Never returns; the end of the orders ends the process."""
        signal.signal(signal.SIGINT, self._interrupt)
        for work in (self._read, self._break_off):
            threading.Thread(target=work, daemon=True).start()
        while True:
            with self._some:
                while not self._wanted:
                    self._some.wait()
                order = self._wanted.pop(next(iter(self._wanted)))
            self._obey(order)

    def _read(self) -> None:
        try:
            while True:
                order = read(self._in)
                assert isinstance(order, Order)
                with self._some:
                    self._wanted[order.key] = order
                    self._some.notify_all()
        finally:
            os._exit(0)

    def _break_off(self) -> None:
        while True:
            with self._some:
                self._some.wait_for(self._is_superseded)
            _thread.interrupt_main()
            time.sleep(PATIENCE)

    def _is_superseded(self) -> bool:
        order = self._computing
        return order is not None and order.key in self._wanted

    def _interrupt(self, number: int, frame: FrameType | None) -> None:
        order = self._computing
        if order is not None and order.key in self._wanted and _may_be_broken_off(order, frame):
            raise _Superseded

    def _obey(self, order: Order) -> None:
        if order.task is None:
            return
        try:
            pictures = order.task.pictures()
            while (picture := self._next(order, pictures)) is not None:
                write(self._out, Reply(order.key, order.number, picture))
        except _Superseded:
            return
        except Exception as error:
            text = f"The workspace could not be computed: {error}"
            write(self._out, Reply(order.key, order.number, Failed(text)))

    def _next(self, order: Order, pictures: object) -> Picture | None:
        """Only here may a computation be broken off: a reply is written whole."""
        try:
            self._computing = order
            if self._is_superseded():
                raise _Superseded
            return next(pictures, None)  # type: ignore[call-overload]
        finally:
            self._computing = None


def _may_be_broken_off(order: Order, frame: FrameType | None) -> bool:
    """Whether all that is called within `_next` are functions of ours. A module that is being
    imported and a function that is being compiled leave half of themselves behind."""
    ours = {_package(type(thing).__module__) for thing in (order, order.task)}
    within = False
    while frame is not None and frame.f_code is not Process._next.__code__:
        is_function = frame.f_code.co_flags & inspect.CO_NEWLOCALS
        if not is_function or _package(frame.f_globals["__name__"]) not in ours:
            return False
        frame, within = frame.f_back, True
    return within and frame is not None


def _package(module: str) -> str:
    return module.partition(".")[0]


def main() -> None:
    os.nice(NICE)
    replies = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())  # whatever prints does not garble them
    Process(sys.stdin.buffer, replies).run()


if __name__ == "__main__":
    main()
